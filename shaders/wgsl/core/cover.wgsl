// Rectangles on the picture that cover spheres, for passes that rasterise balls: four vertices of a
// strip, one instance a ball.

#import core::view::view

// Parts of a pixel that a rectangle is widened by on each side: rasterisers round corners to 1/256.
const PIXEL_MARGIN: f32 = 0.05;

// An upright rectangle in clip space; without area where no primary ray can meet the sphere.
struct Cover {
    low: vec2<f32>,
    high: vec2<f32>,
}

// The smallest rectangle that covers a sphere, with a margin for rounding. Correct wherever the eye is.
// `to_center` leads from the eye to the sphere's centre, world space.
fn cover_sphere(to_center: vec3<f32>, radius: f32) -> Cover {
    let ahead = dot(to_center, view.forward);
    let half = view.half_pixel * vec2(f32(view.width), f32(view.height));
    // Coordinates along the axes are wrong by a few 2^-23 of the distance, the tangents by as much.
    let widened = 1.00001 * radius + 4e-6 * length(to_center);
    let across = tangents(vec2(dot(to_center, view.right), ahead), widened, half.x);
    let upwards = tangents(vec2(dot(to_center, view.up), ahead), widened, half.y);
    if across.x >= across.y || upwards.x >= upwards.y {
        return Cover(vec2(0.0), vec2(0.0));
    }
    return Cover(vec2(across.x, upwards.x) / half, vec2(across.y, upwards.y) / half);
}

// Clip position of a corner, counted from 0.
fn corner_of_cover(cover: Cover, vertex: u32) -> vec4<f32> {
    let is_high = vec2((vertex & 1u) != 0u, (vertex & 2u) != 0u);
    return vec4(select(cover.low, cover.high, is_high), 0.5, 1.0);
}

// The same for a sphere in world space.
fn covering_corner(center: vec3<f32>, radius: f32, vertex: u32) -> vec4<f32> {
    return corner_of_cover(cover_sphere(center - view.eye, radius), vertex);
}

// The part of [-half, half] at unit distance that a circle can cover, seen from the origin along the
// second axis. Empty ranges have ends that are equal or in reverse.
//
// The tangents are the direction to the centre turned by the angle whose sine is radius / distance.
// (Kanamori et al. 2008, appendix B, divides by z^2 - R^2 instead, which holds for z > R only.)
fn tangents(center: vec2<f32>, radius: f32, half: f32) -> vec2<f32> {
    let distance = length(center);
    if distance <= radius {
        return vec2(-half, half);
    }
    if center.y <= -radius {
        return vec2(0.0);
    }
    let along = sqrt((distance - radius) * (distance + radius));
    let low = vec2(center.x * along - center.y * radius, center.y * along + center.x * radius);
    let high = vec2(center.x * along + center.y * radius, center.y * along - center.x * radius);
    let margin = 2.0 * PIXEL_MARGIN * view.half_pixel;
    // A circle level with the origin has one tangent that points backwards and bounds nothing ahead.
    var range = vec2(-half, half);
    if center.y > radius || center.x > 0.0 {
        range.x = slope(low, half) - margin;
    }
    if center.y > radius || center.x < 0.0 {
        range.y = slope(high, half) + margin;
    }
    return clamp(range, vec2(-half), vec2(half));
}

// How far a direction leads sideways for each unit ahead; a bound outside of the picture where that is outside.
fn slope(direction: vec2<f32>, half: f32) -> f32 {
    let outside = 2.0 * half;
    if abs(direction.x) >= outside * direction.y {
        return select(-outside, outside, direction.x > 0.0);
    }
    return direction.x / direction.y;
}
