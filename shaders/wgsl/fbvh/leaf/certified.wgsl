// The first root in a leaf by exact ranges: no ray's answer is ever wrong, for any kernel that falls
// with distance. For trees of classified boxes. Twin: crates/fbvh/src/trace/certified.rs, which derives
// what is used here.
//
// What is searched for is where the excess (fbvh::excess) rises to 0; below, "above" and "below" are said
// of the excess.

#import core::hit::{HIT, INSIDE, UNDECIDED}
#import core::nearby_origin::UNIT
#import core::ray::Ray
#import core::scene::scene
#import fbvh::bounds::bounds_on
#import fbvh::budget::can_walk
#import fbvh::excess::{stays_below, SIGN, SOLID_ANSWERS}
#import fbvh::leaf_outcome::{AT_FACE, BRACKETED, FOUND, MISSED, UNCERTAIN, UNMET, WAITING}
#import fbvh::near_balls::{ball_of, begin_walk, gather, near_in, walk_length, words, WORDS}
#import fbvh::polynomial_test::{polynomial_test, MOST_TESTS}
#import fbvh::projection::{project, rim_share}
#import fbvh::relative_ray::{relative_ray, t_at, RelativeRay}
#import fbvh::structure::{leaves, Leaf}
#import fbvh::test_result
#import kernel::{greatest_bend, kernel, kernel_slope}
#import ray::any_hit_suffices
#import work::{count_balls, count_iterations, count_leaf_test}

// Leaves do not overlap.
fn first_hit_ends() -> bool {
    return true;
}

fn seeks_exit() -> bool {
    return !SOLID_ANSWERS;
}

// Stages of a search: in front of the leaf, in it, or between the ends of a bracket.
const ENTER: u32 = 0u;
const NARROW: u32 = 1u;
const SOLVE: u32 = 2u;

// All t are relative to the leaf's nearby origin.
struct Search {
    stage: u32,
    // The excess reaches 0 nowhere before.
    low: f32,
    // The interval to be bounded next is from `probe` to `high`; from `low` to `probe` the excess rises.
    probe: f32,
    // Once there is a bracket, the excess is above 0 here.
    high: f32,
    // Where the root in a bracket is looked for next.
    guess: f32,
    // Polynomial tests so far.
    tests: u32,
    // 1 once it is certain whether the ray starts beyond the root.
    start_tested: u32,
}

var<private> search: Search;
// The hit last found.
var<private> found_t: f32;
var<private> found_status: u32;

fn reset() {
    search.stage = ENTER;
}

fn hit_t() -> f32 {
    return found_t;
}

fn hit_status() -> u32 {
    return found_status;
}

// An interval of this part of the smallest radius in it is short: a root in it is known well enough.
const SHORT: f32 = 0x1p-20f;

// The excess at t, its slope, and what the slope's slope is nowhere more than: best values, no bounds.
fn excess_and_slopes(relative: RelativeRay, direction: vec3<f32>, t: f32) -> vec3<f32> {
    begin_walk();
    var sum = vec2(-scene.threshold, 0.0);
    var bend = 0.0;
    var word = 0u;
    loop {
        var bits = near_in(word);
        loop {
            if bits != 0u {
                let seen = project(relative, direction, ball_of(word, bits));
                let along = t - seen.middle;
                let v = 1.0 - rim_share(seen, along);
                let share = seen.weight * seen.inverse_square;
                sum += vec2(seen.weight * kernel(v), -2.0 * along * share * kernel_slope(v));
                bend += share;
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
    return vec3(SIGN * sum, bend * greatest_bend());
}

// Where the cubic with these values and slopes at the ends of an interval reaches 0, as a part of it.
fn cubic_root(start: vec2<f32>, end: vec2<f32>, width: f32) -> f32 {
    let rise = end.x - start.x;
    let first = width * start.y;
    let second = 3.0 * rise - width * (2.0 * start.y + end.y);
    let third = width * (start.y + end.y) - 2.0 * rise;
    var x = clamp(-start.x / max(rise, 1e-37), 0.0, 1.0);
    for (var step = 0u; step < 3u; step++) {
        let value = start.x + x * (first + x * (second + x * third));
        let slope = first + x * (2.0 * second + x * 3.0 * third);
        x = clamp(x - value / select(slope, 1e37, slope <= 0.0), 0.0, 1.0);
    }
    return x;
}

fn search_leaf(ray: Ray, inverse: vec3<f32>, index: u32) -> u32 {
    let leaf = leaves[index];
    let first = leaf.first;
    let end = leaves[index + 1u].first;
    let relative = relative_ray(ray, inverse, leaf.min, leaf.max);

    if !can_walk(end - first + WORDS + 1u) {
        return WAITING;
    }
    if search.stage == ENTER {
        if relative.enter > relative.leave {
            return UNMET;
        }
        count_leaf_test();
        // A leaf without a list is solid. Its faces lie inside the surface: a ray that is in it for no
        // longer than rounding can make up is decided by the leaves around.
        if first == end {
            let is_certain =
                relative.starts_within || relative.leave - relative.enter > 4.0 * relative.slack;
            if !SOLID_ANSWERS || !is_certain {
                return MISSED;
            }
            return found_at(
                max(t_at(relative, relative.enter), 0.0),
                select(HIT, INSIDE, relative.starts),
            );
        }
    }
    let most = gather(relative, ray.direction, first, end);
    if search.stage == ENTER {
        count_balls(end - first);
        if stays_below(most) {
            return MISSED;
        }
        search = Search(NARROW, relative.enter, relative.enter, relative.leave, 0.0, 0u, 0u);
    }

    loop {
        if search.stage == NARROW && search.tests < MOST_TESTS {
            if !can_walk(walk_length()) {
                return WAITING;
            }
            let result = polynomial_test(relative, ray.direction, search.low, search.high);
            let helps = result.outcome != test_result::UNCERTAIN
                || result.low > search.low || result.high < search.high;
            search.tests = select(MOST_TESTS, search.tests + 1u, helps);
            if result.outcome == test_result::BELOW && search.high >= relative.leave {
                return MISSED;
            }
            if result.outcome == test_result::ABOVE {
                return found_at(max(t_at(relative, result.high), 0.0), HIT);
            }
            if result.outcome == test_result::ONCE {
                search.stage = SOLVE;
                search.guess = result.guess;
            } else {
                let is_below = result.outcome == test_result::BELOW;
                search.low = select(result.low, search.high, is_below);
                search.probe = search.low;
                search.high = select(result.high, relative.leave, is_below);
            }
        }
        if search.stage != NARROW || search.tests >= MOST_TESTS {
            break;
        }
    }

    // A test that helped has found the excess below 0 where it begins. Without one, the ray's start may be
    // beyond the root: that is tested once.
    var tests_start =
        relative.starts && search.low == relative.enter && search.start_tested == 0u;
    loop {
        if search.stage == NARROW {
            if !can_walk(walk_length()) {
                return WAITING;
            }
            let probe = search.probe;
            let width = search.high - probe;
            let end_of_bounds = select(search.high, probe, tests_start);
            let bounds = bounds_on(relative, ray.direction, probe, end_of_bounds);
            if tests_start {
                if bounds.end_least >= 0.0 {
                    return found_at(0.0, INSIDE);
                }
                if bounds.most >= 0.0 {
                    return found_at(0.0, UNDECIDED);
                }
                search.start_tested = 1u;
                tests_start = false;
                continue;
            }
            let rises = bounds.least_slope > 0.0;
            // What rises is greatest at its end.
            let is_below = bounds.most < 0.0 || (rises && bounds.end_most < 0.0);
            let is_short = width <= SHORT * bounds.radius;
            if any_hit_suffices() && bounds.end_least > 0.0 {
                return found_at(max(t_at(relative, search.high), 0.0), HIT);
            }
            if bounds.end_least > 0.0 && (rises || is_short) {
                search.stage = SOLVE;
                search.guess = probe + width * cubic_root(bounds.start, bounds.end, width);
            } else if is_below || rises {
                // All below 0; or rising so close to 0 that what comes next must decide.
                if search.high >= relative.leave {
                    return far_end(relative, ray, is_below);
                }
                search.low = select(search.low, search.high, is_below);
                search.probe = search.high;
                search.high = min(search.high + 2.0 * width, relative.leave);
            } else {
                let middle = probe + 0.5 * width;
                // No float is left between the ends, or none that would decide anything.
                if middle <= probe || middle >= search.high || is_short {
                    return found_at(max(t_at(relative, probe), 0.0), UNDECIDED);
                }
                search.high = middle;
            }
        }
        if search.stage != NARROW {
            break;
        }
    }

    return BRACKETED;
}

// The outcome of a search without a root up to where the ray leaves the leaf or ends.
//
// On the search for an entry, an excess that rises so close to 0 at a face is decided by what lies behind:
// another leaf, which begins there, or none; then the field is below T at the face, and since it rose to
// there, before it, too.
fn far_end(relative: RelativeRay, ray: Ray, is_below: bool) -> u32 {
    let t_leave = t_at(relative, relative.leave) * (1.0 + 8.0 * UNIT);
    if is_below {
        return MISSED;
    }
    if relative.ends || t_leave >= ray.t_max {
        return UNCERTAIN;
    }
    if !seeks_exit() {
        return MISSED;
    }
    found_t = t_leave;
    return AT_FACE;
}

fn bracket_exit(ray: Ray, inverse: vec3<f32>, index: u32) -> bool {
    let leaf = leaves[index];
    let relative = relative_ray(ray, inverse, leaf.min, leaf.max);
    let enter = relative.enter;
    search = Search(SOLVE, enter, enter, relative.leave, relative.leave, 0u, 0u);
    let end = leaves[index + 1u].first;
    if !can_walk(end - leaf.first + WORDS + 1u) {
        return false;
    }
    gather(relative, ray.direction, leaf.first, end);
    return true;
}

fn is_bracketed() -> bool {
    return search.stage == SOLVE;
}

fn close_in(ray: Ray, inverse: vec3<f32>, index: u32) -> u32 {
    let leaf = leaves[index];
    let relative = relative_ray(ray, inverse, leaf.min, leaf.max);
    // One root between the ends, or too short a way between them to matter: Newton's steps, kept
    // between the ends (Press et al., rtsafe). Where the slope is f', a step leaves at most
    // step^2 bend / 2 f': once that is less than the ray's own points are known to, none follows.
    var t = search.guess;
    let known = UNIT * max(abs(relative.enter), abs(relative.leave));
    for (var step = 0u; step < 48u; step++) {
        if !can_walk(walk_length()) {
            return WAITING;
        }
        count_iterations(1u);
        let value = excess_and_slopes(relative, ray.direction, t);
        if value.x >= 0.0 {
            search.high = t;
        } else {
            search.low = t;
        }
        // Where the excess does not rise, as before the rim of a support, no step leads anywhere.
        let is_flat = value.y <= 0.0;
        let way = select(-value.x / select(value.y, 1.0, is_flat), 1e37, is_flat);
        var next = t + way;
        var is_last = way * (way * value.z) <= known * value.y;
        if next <= search.low || next >= search.high {
            next = 0.5 * (search.low + search.high);
            is_last = false;
        }
        is_last = is_last || abs(next - t) <= 4.0 * UNIT * max(abs(t), abs(next));
        t = next;
        search.guess = t;
        if is_last || next <= search.low || next >= search.high {
            break;
        }
    }
    return found_at(max(t_at(relative, t), 0.0), HIT);
}

fn found_at(t: f32, status: u32) -> u32 {
    search.stage = ENTER;
    found_t = t;
    found_status = status;
    return FOUND;
}

// The search ends at the root itself.
fn residual() -> f32 {
    return 0.0;
}

// The margins of crates/fbvh/src/trace/certified/ranges.rs for an interval as long as the leaf's diagonal, from an
// origin near the leaf that t stretches by 2^-10 of a float. Of the 24 diagonals, 17 are the search's own
// margin, and 2 are where the last of Newton's steps may end.
fn depth_error(leaf: Leaf, ray: Ray, t: f32, offset: vec3<f32>, radius: f32) -> f32 {
    let diagonal = length(leaf.max - leaf.min);
    return UNIT * (26.0 + (24.0 * diagonal + 0x1p-8f * t) / radius);
}
