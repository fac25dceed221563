// The excess F - T, for the search for an entry into the solid. Derived in
// crates/fbvh/src/trace/certified/ranges.rs.

#import core::scene::scene
#import fbvh::bounds::Bounds
#import fbvh::near_balls::{ball_of, begin_walk, near_in, sum_error, words}
#import fbvh::projection::{depths_on, least_product, project}
#import fbvh::relative_ray::RelativeRay
#import kernel::{kernel, kernel_slope}

const SIGN: f32 = 1.0;

fn stays_below(most: f32) -> bool {
    return most < scene.threshold;
}

const SOLID_ANSWERS: bool = true;

fn bounds_on(ray: RelativeRay, direction: vec3<f32>, low: f32, high: f32) -> Bounds {
    begin_walk();
    let error = sum_error();
    var most = 0.0;
    var least_slope = 0.0;
    var end_least = 0.0;
    var end_most = 0.0;
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
                most += q * kernel(v.most);
                end_least += q * kernel(v.end - v.end_margin);
                end_most += q * kernel(v.end + v.end_margin);
                // Its slope is 2 q kernel'(v) (middle - t)/R^2: least at the interval's end.
                let to_start = low - seen.middle;
                let to_end = high - seen.middle;
                let steep = 2.0 * q * seen.inverse_square;
                least_slope += steep * least_product(seen, v, -to_end, error);
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
        most * (1.0 + error) - threshold, least_slope,
        end_least * (1.0 - error) - threshold, end_most * (1.0 + error) - threshold,
        start - vec2(threshold, 0.0), stop - vec2(threshold, 0.0), radius,
    );
}
