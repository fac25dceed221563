// What a certified search for the field's first rise to T knows of an interval of a ray: exact ranges
// of the excess F - T. Derived in crates/fbvh/src/trace/certified.rs.

#import fbvh::bounds::Bounds
#import fbvh::relative_ray::Frame
#import fbvh::near_balls::{ball_of, begin_walk, near_in, summing, words}
#import fbvh::projection::{depths_on, least_product, project}
#import kernel::{kernel, kernel_slope}
#import core::scene::scene

// The excess is this times F - T.
const SIGN: f32 = 1.0;

// Whether the excess stays below 0 where the field is nowhere more than this.
fn stays_below(most: f32) -> bool {
    return most < scene.threshold;
}

// Whether a box that the field is above T in throughout answers the search.
const SOLID_ENDS: bool = true;

// One walk along the leaf's list.
fn bounds_on(frame: Frame, direction: vec3<f32>, low: f32, high: f32) -> Bounds {
    begin_walk();
    // How far the sums may err, of their terms.
    let doubt = summing();
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
            let seen = project(frame, direction, ball_of(word, bits));
            let v = depths_on(seen, low, high);
            if bits != 0u && v.most > 0.0 {
                let q = seen.weight;
                most += q * kernel(v.most);
                end_least += q * kernel(v.end - v.end_margin);
                end_most += q * kernel(v.end + v.end_margin);
                // The derivative by t is 2 q kernel'(v) (middle - t)/R^2: least at the interval's end.
                let to_start = low - seen.middle;
                let to_end = high - seen.middle;
                let steep = 2.0 * q * seen.inverse_square;
                least_slope += steep * least_product(seen, v, -to_end, doubt);
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
        most * (1.0 + doubt) - threshold, least_slope,
        end_least * (1.0 - doubt) - threshold, end_most * (1.0 + doubt) - threshold,
        start - vec2(threshold, 0.0), stop - vec2(threshold, 0.0), radius,
    );
}
