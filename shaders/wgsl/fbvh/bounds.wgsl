// What is certain of the excess on an interval of a ray.

#import core::scene::scene
#import fbvh::excess::{depth_of_most, lower_bound, upper_bound, way_of_least_slope, SIGN}
#import fbvh::near_balls::{ball_of, begin_walk, near_in, sum_error, words}
#import fbvh::projection::{depths_on, least_product, project}
#import fbvh::relative_ray::RelativeRay
#import kernel::{kernel, kernel_slope}

struct Bounds {
    // The excess is nowhere more than this.
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

// By one walk along the balls near.
fn bounds_on(ray: RelativeRay, direction: vec3<f32>, low: f32, high: f32) -> Bounds {
    begin_walk();
    let error = sum_error();
    // The field where the excess is greatest, and its least and most at the end.
    var extreme = 0.0;
    var end_least = 0.0;
    var end_most = 0.0;
    var least_slope = 0.0;
    var start = vec2(0.0);
    var stop = vec2(0.0);
    var radius = 1e38;
    var word = 0u;
    loop {
        var bits = near_in(word);
        loop {
            let seen = project(ray, direction, ball_of(word, bits));
            let v = depths_on(seen, low, high);
            if bits != 0u && v.most > 0.0 {
                let q = seen.weight;
                extreme += q * kernel(depth_of_most(v));
                end_least += q * kernel(v.end - v.end_margin);
                end_most += q * kernel(v.end + v.end_margin);
                // Its slope is 2 q kernel'(v) (middle - t)/R^2.
                let to_start = low - seen.middle;
                let to_end = high - seen.middle;
                let steep = 2.0 * q * seen.inverse_square;
                let way = way_of_least_slope(to_start, to_end);
                least_slope += steep * least_product(seen, v, way, error);
                start += vec2(q * kernel(v.start), -steep * to_start * kernel_slope(v.start));
                stop += vec2(q * kernel(v.end), -steep * to_end * kernel_slope(v.end));
                radius = min(radius, seen.radius);
            }
            bits &= bits - 1u;
            if bits == 0u {
                break;
            }
        }
        word++;
        if word >= words() {
            break;
        }
    }
    let threshold = vec2(scene.threshold, 0.0);
    return Bounds(
        upper_bound(extreme, extreme, error), least_slope,
        lower_bound(end_least, end_most, error), upper_bound(end_least, end_most, error),
        SIGN * (start - threshold), SIGN * (stop - threshold), radius,
    );
}
