// The test for the kernel v^2, on the search for an entry.
//
// Along the ray a ball's v = 1 - r^2/R^2 is a parabola, with the Bernstein coefficients v(a), its polar form
// at (a, b), and v(b) on an interval [a, b]. With negative coefficients raised to zero it is nowhere lower,
// so the sum of the squares is a quartic nowhere below the field; and it is the field itself where all
// balls that reach the interval cover it. Argued in crates/fbvh/src/trace/certified.rs.

#import core::nearby_origin::UNIT
#import core::scene::scene
#import fbvh::near_balls::{ball_of, begin_walk, near_in, sum_error, words}
#import fbvh::projection::{project, rim_share, Projection}
#import fbvh::relative_ray::RelativeRay
#import fbvh::test_result::{TestResult, ABOVE, BELOW, ONCE, UNCERTAIN}
#import ray::any_hit_suffices

const MOST_TESTS: u32 = 3u;

// How far rounding can move the coefficients of v on an interval at whose ends s = r^2/R^2 is at most so
// much. At the ends as depth_margin, but for values of any size. The polar form is 1 - p(a).p(b)/R^2, where p
// points from the centre to the ray: it has the same bound, since |p(a)| |p(b)| / R^2 is at most s, too. What
// holds for the coefficients holds for all values between them.
fn coefficient_margin(seen: Projection, s: f32) -> f32 {
    let part = seen.misplaced * seen.inverse_radius;
    return UNIT * (1.0 + 10.0 * s) + part * (2.0 * sqrt(s) + part);
}

// The field is below T at `low`, or that is uncertain, too.
fn polynomial_test(ray: RelativeRay, direction: vec3<f32>, low: f32, high: f32) -> TestResult {
    begin_walk();
    // Coefficients of an upper and of a lower bound of the field; the last one apart, the field at the
    // interval's end, which is either's.
    var most = vec4(0.0);
    var least = vec4(0.0);
    var last = 0.0;
    // The same of the balls that cover the interval.
    var least_last = 0.0;
    // How far rounding can move the field.
    var error = 0.0;
    // Whether all balls rise on the interval, and whether all cover it.
    var rises = true;
    var covered = true;
    var word = 0u;
    loop {
        var bits = near_in(word);
        loop {
            let seen = project(ray, direction, ball_of(word, bits));
            let to_start = low - seen.middle;
            let to_end = high - seen.middle;
            let along = vec3(to_start, to_start, to_end) * vec3(to_start, to_end, to_end);
            let s = (seen.off_square + along) * seen.inverse_square;
            let farthest = max(s.x, s.z);
            let margin = coefficient_margin(seen, farthest);
            if bits != 0u && 1.0 - rim_share(seen, clamp(seen.middle, low, high) - seen.middle) + margin > 0.0 {
                let v = max(1.0 - s, vec3(0.0));
                let q = seen.weight;
                let terms =
                    q * vec4(v.x * v.x, v.x * v.y, (2.0 * v.y * v.y + v.x * v.z) * (1.0 / 3.0), v.y * v.z);
                most += terms;
                last += q * v.z * v.z;
                error += 2.0 * q * margin * (max(v.x, max(v.y, v.z)) + margin);
                // Where both ends are in the support by so much, no coefficient has been raised.
                if 1.0 - farthest >= 2.0 * margin {
                    least += terms;
                    least_last += q * v.z * v.z;
                } else {
                    covered = false;
                }
                rises = rises && to_end < -seen.misplaced;
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
    // How far the sums may err, of themselves: their terms are products of products.
    let rounding = sum_error() + 8.0 * UNIT;
    let most_error = error * (1.0 + rounding);
    let upper = most * (1.0 + rounding) + (most_error - scene.threshold);
    let upper_last = last * (1.0 + rounding) + (most_error - scene.threshold);
    let lower = least * (1.0 - rounding) - (most_error + scene.threshold);
    let lower_last = last * (1.0 - rounding) - (most_error + scene.threshold);

    if all(upper < vec4(0.0)) && upper_last < 0.0 {
        return TestResult(BELOW, low, high, high);
    }
    let width = high - low;
    // Where any hit suffices, so does a point where the field is certainly above T: the interval's end, or
    // one before it. There all terms are positive, and the quartic's own errs by less than a sum does.
    if any_hit_suffices() {
        var above = select(0.0, 1.0, lower_last > 0.0);
        for (var x = 0.25; x < 1.0; x += 0.25) {
            let field = quartic(least, least_last, x) * (1.0 - 2.0 * rounding);
            above = select(above, x, field > most_error + scene.threshold);
        }
        if above > 0.0 {
            return TestResult(ABOVE, low, low + above * width, high);
        }
    }
    if upper.x >= 0.0 {
        return TestResult(UNCERTAIN, low, high, high);
    }
    if lower_last > 0.0 && (rises || (covered && changes_once(upper, lower))) {
        return TestResult(ONCE, low, high, low + width * root_of(upper, upper_last));
    }
    // The quartic keeps below the steepest line from its first coefficient to another.
    let slopes = (vec4(upper.yzw, upper_last) - upper.x) * vec4(1.0, 0.5, 1.0 / 3.0, 0.25);
    let steepest = max(max(slopes.x, slopes.y), max(slopes.z, slopes.w));
    let clear = min(-upper.x / max(4.0 * steepest, 1e-37), 1.0);
    // Up to where the field is certainly above T, if that is soon.
    var until = select(0.5 + 0.5 * clear, 1.0, clear > 0.25);
    for (var share = 0.5; share > 0.02; share *= 0.25) {
        let x = clear + share * (1.0 - clear);
        until = select(until, x, quartic(lower, lower_last, x) > 0.0);
    }
    // Short of the line by more than rounding.
    return TestResult(UNCERTAIN, low + 0.9375 * clear * width, min(low + until * width, high), high);
}

// Whether coefficients, the first of them below 0 and the last above, change sign once, wherever between
// these two they lie: one of them may be of either sign.
fn changes_once(upper: vec4<f32>, lower: vec4<f32>) -> bool {
    let below = upper.yzw < vec3(0.0);
    let above = lower.yzw > vec3(0.0);
    return (above.y && above.z) || (below.x && above.z) || (below.x && below.y);
}

// The quartic with these coefficients.
fn quartic(c: vec4<f32>, last: f32, x: f32) -> f32 {
    let y = 1.0 - x;
    return y * y * (y * y * c.x + 4.0 * x * y * c.y + 6.0 * x * x * c.z)
        + x * x * x * (4.0 * y * c.w + x * last);
}

// About where a quartic that is below 0 at 0 and above at 1 reaches 0: false position.
fn root_of(c: vec4<f32>, last: f32) -> f32 {
    var low = vec2(0.0, c.x);
    var high = vec2(1.0, last);
    var x = 0.0;
    for (var step = 0u; step < 5u; step++) {
        x = low.x + (high.x - low.x) * clamp(low.y / min(low.y - high.y, -1e-37), 0.0, 1.0);
        let value = quartic(c, last, x);
        // An end that stays counts half (Illinois).
        if value < 0.0 {
            low = vec2(x, value);
            high.y *= select(1.0, 0.5, step > 0u);
        } else {
            high = vec2(x, value);
            low.y *= select(1.0, 0.5, step > 0u);
        }
    }
    return x;
}
