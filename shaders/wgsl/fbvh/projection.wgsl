// A ball relative to a ray in a leaf: where along the ray its centre is, how deep in its support the ray
// runs, and how far rounding can move that.

#import core::nearby_origin::{relative_to, UNIT}
#import fbvh::relative_ray::RelativeRay
#import kernel::{kernel_slope, steepest_slope}
#import strength::strength
#import support::support_of

struct Projection {
    // The relative t nearest to the centre, and the square of the ray's distance from the centre there.
    middle: f32,
    off_square: f32,
    radius: f32,
    inverse_radius: f32,
    inverse_square: f32,
    // The ball's strength.
    weight: f32,
    // How far rounding can misplace the centre's projection, and move the ray past it: the offset
    // itself, three products and their sum, a direction that is unit to rounding only.
    misplaced: f32,
}

fn project(ray: RelativeRay, direction: vec3<f32>, ball: u32) -> Projection {
    let support = support_of(ball);
    let offset = relative_to(ray.origin, support.center);
    let middle = dot(offset, direction);
    let off_axis = offset - middle * direction;
    let inverse_radius = 1.0 / support.radius;
    return Projection(
        middle, dot(off_axis, off_axis),
        support.radius, inverse_radius, inverse_radius * inverse_radius, strength(ball),
        6.0 * UNIT * length(offset) + 1.05 * ray.origin.misplaced,
    );
}

// s = r^2/R^2 this far from the projection, along the ray.
fn rim_share(seen: Projection, along: f32) -> f32 {
    return (seen.off_square + along * along) * seen.inverse_square;
}

// v = 1 - s on an interval of the ray.
struct Depths {
    start: f32,
    end: f32,
    // Certainly nowhere less, and nowhere more.
    least: f32,
    most: f32,
    // How far rounding can move the value at the end.
    end_margin: f32,
}

fn depths_on(seen: Projection, low: f32, high: f32) -> Depths {
    let s_start = rim_share(seen, low - seen.middle);
    let s_end = rim_share(seen, high - seen.middle);
    let margin = depth_margin(seen, min(max(s_start, s_end), 1.0));
    return Depths(
        1.0 - s_start, 1.0 - s_end,
        min(1.0 - s_start, 1.0 - s_end) - margin, greatest_depth(seen, low, high),
        depth_margin(seen, min(s_end, 1.0)),
    );
}

// v on an interval is certainly nowhere more than this.
fn greatest_depth(seen: Projection, low: f32, high: f32) -> f32 {
    let s = rim_share(seen, clamp(seen.middle, low, high) - seen.middle);
    return 1.0 - s + depth_margin(seen, min(s, 1.0));
}

// How far rounding can move v = 1 - s where s is at most so much, from 0 to 1. A distance r that is
// `misplaced` moves s by (2 r + misplaced) misplaced / R^2; its squares, their sum and the quotient err
// by 9 units of s, the difference by one of v.
fn depth_margin(seen: Projection, s: f32) -> f32 {
    let part = seen.misplaced * seen.inverse_radius;
    return UNIT * (1.0 + 9.0 * s) + part * (2.0 * sqrt(s) + part);
}

// On an interval with these depths the kernel's derivative times `way`, which may be misplaced, is nowhere
// less than this, for a sum that errs by such a part of its terms: each factor is bounded. What a ball falls
// within the misplaced part of its way is the square of that, and within the margin of v. Twin:
// least_product of crates/fbvh/src/trace/certified/ranges.rs.
fn least_product(seen: Projection, v: Depths, way: f32, sum_error: f32) -> f32 {
    let gentlest = min(kernel_slope(v.least), kernel_slope(v.most)) * (1.0 - sum_error);
    let steepest = steepest_slope(v.least, v.most) * (1.0 + sum_error);
    return select(steepest * (way - seen.misplaced), gentlest * max(way - seen.misplaced, 0.0), way >= 0.0);
}
