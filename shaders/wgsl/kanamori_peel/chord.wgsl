// A ray through a sphere.

struct Chord {
    // t of the centre's projection onto the ray.
    middle: f32,
    // Q^2: half the chord, squared. Not positive where the ray misses or only touches.
    half_squared: f32,
}

// From the vector that joins ray and centre, not from a difference of squared distances, which
// cancels far from the eye.
fn chord_of(to_center: vec3<f32>, radius: f32, direction: vec3<f32>) -> Chord {
    let middle = dot(to_center, direction);
    let across = to_center - middle * direction;
    return Chord(middle, radius * radius - dot(across, across));
}
