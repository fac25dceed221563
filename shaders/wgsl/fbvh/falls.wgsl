// What a certified search for the exit of a ray that starts in the solid knows of an interval: exact
// ranges of the excess T - F. Twin of rises.wgsl, with every bound on the other side: a ball adds least
// at the interval's farther end from its projection.
#define_import_path metaball::fbvh::excess

#import metaball::fbvh::local::{depth_margin, misplacement, Frame, UNIT}
#import metaball::fbvh::structure::lists
#import metaball::fbvh::suspend::spent
#import metaball::kernel::{kernel, kernel_slope, steepest_slope}
#import metaball::scene::scene
#import metaball::strength::strength
#import metaball::support::support_of
#import metaball::work::count_evaluations

// The excess is this times F - T.
const SIGN: f32 = -1.0;

// Whether a box that the field is above T in throughout answers the search.
const SOLID_ENDS: bool = false;

// What is certain of the excess on an interval, and at the interval's end.
struct Bounds {
    // Nowhere more than this.
    most: f32,
    // The slope is nowhere less, 1/scene unit.
    least_slope: f32,
    // At the end: certainly at least and at most this.
    end_least: f32,
    end_most: f32,
    // Excess and slope at either end: best values, no bounds.
    start: vec2<f32>,
    end: vec2<f32>,
    // Least radius among the balls that reach the interval.
    radius: f32,
}

// One walk along the leaf's list.
fn bounds_on(frame: Frame, direction: vec3<f32>, first: u32, end: u32, low: f32, high: f32) -> Bounds {
    count_evaluations(end - first);
    spent += end - first + 1u;
    var least = 0.0;
    var most_slope = 0.0;
    var end_most = 0.0;
    var end_least = 0.0;
    var start = vec2(0.0);
    var stop = vec2(0.0);
    var radius = 1e38;
    for (var entry = first; entry < end; entry++) {
        let ball = lists[entry];
        let support = support_of(ball);
        let offset = (support.center - frame.center) - frame.origin;
        let middle = dot(offset, direction);
        let off_axis = offset - middle * direction;
        let inverse_radius = 1.0 / support.radius;
        let inverse_square = inverse_radius * inverse_radius;
        let off_square = dot(off_axis, off_axis);
        let to_end = high - middle;
        let to_start = low - middle;
        let s_end = (off_square + to_end * to_end) * inverse_square;
        let s_start = (off_square + to_start * to_start) * inverse_square;
        let misplaced = misplacement(frame, offset);
        let margin = depth_margin(min(max(s_start, s_end), 1.0), misplaced, inverse_radius);
        let end_margin = depth_margin(min(s_end, 1.0), misplaced, inverse_radius);

        let near = clamp(middle, low, high) - middle;
        let v_most = 1.0 - (off_square + near * near) * inverse_square + margin;
        if v_most <= 0.0 {
            continue;
        }
        let v_end = 1.0 - s_end;
        let v_start = 1.0 - s_start;
        let v_least = min(v_start, v_end) - margin;
        let q = strength(ball);
        least += q * kernel(v_least);
        end_most += q * kernel(v_end + end_margin);
        end_least += q * kernel(v_end - end_margin);
        // The derivative by t is 2 q kernel'(v) (middle - t)/R^2: of one sign on either side of the
        // projection, and bounded there by the product of what bounds its factors.
        var slope = 0.0;
        if middle <= low {
            let gentlest = min(kernel_slope(v_least), kernel_slope(v_most));
            slope = -gentlest * max(to_start - misplaced, 0.0) * (1.0 - 16.0 * UNIT);
        } else {
            slope = steepest_slope(v_least, v_most) * (misplaced - to_start) * (1.0 + 16.0 * UNIT);
        }
        let steep = 2.0 * q * inverse_square;
        most_slope += steep * slope;
        start += vec2(q * kernel(v_start), -steep * to_start * kernel_slope(v_start));
        stop += vec2(q * kernel(v_end), -steep * to_end * kernel_slope(v_end));
        radius = min(radius, support.radius);
    }
    // The sum of n terms of one sign, each of a few products, errs by less than this part of it.
    let summing = f32(end - first + 16u) * UNIT;
    let threshold = scene.threshold;
    return Bounds(
        threshold - least * (1.0 - summing), -most_slope,
        threshold - end_most * (1.0 + summing), threshold - end_least * (1.0 - summing),
        vec2(threshold, 0.0) - start, vec2(threshold, 0.0) - stop, radius,
    );
}
