// Rectangles on the picture that cover spheres, for passes that rasterise balls: four vertices of a
// strip, one instance a ball.
#define_import_path metaball::cover

#import metaball::view::view

// Parts of a pixel that a rectangle is widened by on each side: rasterisers round corners to 1/256.
const PIXEL_MARGIN: f32 = 0.05;

// Clip position of a corner of the smallest upright rectangle that covers a sphere, with a margin for
// rounding. Correct wherever the eye is; without area where no primary ray can meet the sphere.
fn covering_corner(center: vec3<f32>, radius: f32, vertex: u32) -> vec4<f32> {
    let offset = center - view.eye;
    let ahead = dot(offset, view.forward);
    let half = view.half_pixel * vec2(f32(view.width), f32(view.height));
    // Coordinates along the axes are wrong by a few 2^-23 of the distance, the tangents by as much.
    let widened = 1.001 * radius + 4e-6 * length(offset);
    let across = tangents(vec2(dot(offset, view.right), ahead), widened, half.x);
    let upwards = tangents(vec2(dot(offset, view.up), ahead), widened, half.y);
    let x = select(across.x, across.y, (vertex & 1u) != 0u);
    let y = select(upwards.x, upwards.y, (vertex & 2u) != 0u);
    return vec4(vec2(x, y) / half, 0.5, 1.0);
}

// The part of [-half, half] at unit distance that a circle covers, seen from the origin along the
// second axis; equal ends where it covers nothing.
fn tangents(center: vec2<f32>, radius: f32, half: f32) -> vec2<f32> {
    if center.y <= -radius {
        return vec2(half);
    }
    // A circle this near can span more than a right angle, where the sines below turn around.
    let distance = length(center);
    if distance <= 1.5 * radius {
        return vec2(-half, half);
    }
    // The direction to the centre, turned by the angle whose sine is radius / distance. A tangent
    // that points behind the eye bounds nothing on its own side, and leaves nothing on the other.
    let along = sqrt((distance - radius) * (distance + radius));
    let low = vec2(center.x * along - center.y * radius, center.y * along + center.x * radius);
    let high = vec2(center.x * along + center.y * radius, center.y * along - center.x * radius);
    let low_end = select(select(-half, half, low.x > 0.0), low.x / low.y, low.y > 0.0);
    let high_end = select(select(-half, half, high.x > 0.0), high.x / high.y, high.y > 0.0);
    let margin = 2.0 * PIXEL_MARGIN * view.half_pixel;
    return clamp(vec2(low_end - margin, high_end + margin), vec2(-half), vec2(half));
}
