// The excess T - F, for the search for an exit of a ray that starts in the solid. Every bound is on the
// other side than for an entry: a ball adds least at the interval's farther end from its projection.

#import core::scene::scene
#import fbvh::bounds::Bounds
#import fbvh::near_balls::{ball_of, begin_walk, near_in, sum_error, words}
#import fbvh::projection::{depths_on, least_product, project}
#import fbvh::relative_ray::RelativeRay
#import kernel::{kernel, kernel_slope}

const SIGN: f32 = -1.0;

// Never known: that takes a lower bound of the field.
fn stays_below(most: f32) -> bool {
    return false;
}

const SOLID_ANSWERS: bool = false;

fn bounds_on(ray: RelativeRay, direction: vec3<f32>, low: f32, high: f32) -> Bounds {
    begin_walk();
    let error = sum_error();
    var least = 0.0;
    var least_slope = 0.0;
    var end_most = 0.0;
    var end_least = 0.0;
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
                least += q * kernel(v.least);
                end_most += q * kernel(v.end + v.end_margin);
                end_least += q * kernel(v.end - v.end_margin);
                // Its slope is 2 q kernel'(v) (t - middle)/R^2: least at the interval's start.
                let to_start = low - seen.middle;
                let to_end = high - seen.middle;
                let steep = 2.0 * q * seen.inverse_square;
                least_slope += steep * least_product(seen, v, to_start, error);
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
    let threshold = scene.threshold;
    return Bounds(
        threshold - least * (1.0 - error), least_slope,
        threshold - end_most * (1.0 + error), threshold - end_least * (1.0 - error),
        vec2(threshold, 0.0) - start, vec2(threshold, 0.0) - stop, radius,
    );
}
