// Where a ball's support lies on the picture, and the rectangle that is drawn for it.
#define_import_path metaball::kanamori_peel::rectangle

#import metaball::view::view

// Twin of `Placed` in kanamori-peel.
struct Placed {
    // Corners in clip space, -1 to 1; equal where nothing is to be seen.
    low: vec2<f32>,
    high: vec2<f32>,
    // 1 where the support holds the eye.
    around: u32,
}

// Radii are taken this much larger, and rectangles by this share of a pixel: rounding of positions
// and the rasteriser's grid of 1/256 pixel never cost a pixel.
const RADIUS_SLACK: f32 = 1.00001;
const PIXEL_SLACK: f32 = 0.05;

fn place_sphere(to_center: vec3<f32>, radius: f32) -> Placed {
    let reach = radius * RADIUS_SLACK;
    let ahead = dot(to_center, view.forward);
    let half = view.half_pixel * vec2(f32(view.width), f32(view.height));
    let across = slopes(dot(to_center, view.right), ahead, reach, half.x);
    let upwards = slopes(dot(to_center, view.up), ahead, reach, half.y);
    let around = select(0u, 1u, dot(to_center, to_center) < radius * radius);
    if across.x >= across.y || upwards.x >= upwards.y {
        return Placed(vec2(0.0), vec2(0.0), around);
    }
    let low = vec2(across.x, upwards.x) / half;
    let high = vec2(across.y, upwards.y) / half;
    return Placed(low, high, around);
}

// The part of [-half, half] at unit distance that a disc can cover, seen from the origin along the
// second axis. Empty ranges have ends that are equal or in reverse.
//
// The tangents are the direction to the centre turned by the angle whose sine is radius/distance.
// Appendix B divides by z^2 - R^2 in their place, and holds for z > R only.
fn slopes(aside: f32, ahead: f32, radius: f32, half: f32) -> vec2<f32> {
    let distance = length(vec2(aside, ahead));
    if distance <= radius {
        return vec2(-half, half);
    }
    if ahead <= -radius {
        return vec2(0.0);
    }
    let tangent = sqrt((distance - radius) * (distance + radius));
    // A tangent that points backwards does not bound what is ahead.
    let low_ahead = ahead * tangent + aside * radius;
    let high_ahead = ahead * tangent - aside * radius;
    let slack = 2.0 * PIXEL_SLACK * view.half_pixel;
    var range = vec2(-half, half);
    if ahead > radius || aside > 0.0 {
        range.x = quotient(aside * tangent - ahead * radius, low_ahead, half) - slack;
    }
    if ahead > radius || aside < 0.0 {
        range.y = quotient(aside * tangent + ahead * radius, high_ahead, half) + slack;
    }
    return clamp(range, vec2(-half), vec2(half));
}

// A slope, or `beyond` with its sign where it is larger.
fn quotient(aside: f32, ahead: f32, beyond: f32) -> f32 {
    let limit = 2.0 * beyond;
    if abs(aside) >= limit * ahead {
        return select(-limit, limit, aside > 0.0);
    }
    return aside / ahead;
}

// A corner of the strip of two triangles that is the rectangle, counted from 0.
fn corner_of(placed: Placed, vertex: u32) -> vec4<f32> {
    let is_high = vec2((vertex & 1u) != 0u, (vertex >> 1u) != 0u);
    return vec4(select(placed.low, placed.high, is_high), 0.5, 1.0);
}
