// One ball's part of the field at a point, from the point's offset to the ball's centre, and the normal.
//
// Offsets are formed as (eye - centre) + t * direction. The first difference has the size of the
// distance between eye and ball; forming the point first would round at the size of the world.

#import kernel::{kernel, kernel_slope}
#import strength::strength

// x - p for the point x at t on the ray; `eye_offset` is eye - p.
fn offset_at(eye_offset: vec3<f32>, direction: vec3<f32>, t: f32) -> vec3<f32> {
    return eye_offset + t * direction;
}

// v = 1 - r^2/R^2 at an offset: 1 at the centre, 0 at the rim, negative outside.
fn depth_below_rim(offset: vec3<f32>, radius: f32) -> f32 {
    return 1.0 - dot(offset, offset) / (radius * radius);
}

// What the ball adds to the field.
fn contribution(ball: u32, v: f32) -> f32 {
    return strength(ball) * kernel(v);
}

// What the ball adds to the field's gradient, 1/scene unit.
fn gradient(ball: u32, v: f32, offset: vec3<f32>, radius: f32) -> vec3<f32> {
    return (strength(ball) * kernel_slope(v) * -2.0 / (radius * radius)) * offset;
}

// The unit normal out of the solid, from the field's gradient. Where the field is flat, as at a lone
// centre, the surface faces the ray.
fn outward_normal(gradient: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    let steepness = length(gradient);
    return select(-direction, -gradient / steepness, steepness > 0.0);
}
