// The first root in a leaf by exact ranges: no ray's answer is ever wrong, for any kernel that falls
// with distance. Stands in for leaf.wgsl in trees of classified boxes. Twin:
// crates/fbvh/src/trace/certified.rs, which derives what is used here.
//
// What is searched for is where an excess rises to 0: F - T for rays that look for the solid
// (rises.wgsl), T - F for rays that look for the way out of it (falls.wgsl). Below, "above" and "below"
// are said of the excess.

#import fbvh::excess::{bounds_on, stays_below, SIGN, SOLID_ENDS}
#import fbvh::relative_ray::{at, local_frame, Frame, UNIT}
#import fbvh::polynomial_test::{look, LOOKS}
#import fbvh::near_balls::{ball_of, begin_walk, gather, near_in, walk_length, words, WORDS}
#import fbvh::test_result::{ABOVE, BELOW, ONCE, UNCLEAR}
#import fbvh::projection::{project, rim_share}
#import fbvh::structure::{leaves, Leaf}
#import fbvh::suspend::can_walk
#import core::hit::{HIT, INSIDE, UNDECIDED}
#import kernel::{greatest_bend, kernel, kernel_slope}
#import ray::{any_will_do, Ray}
#import core::scene::scene
#import work::{count_balls, count_iterations, count_leaf_test}

// Leaves do not overlap: once one holds a hit, no later one holds a nearer.
fn first_hit_ends() -> bool {
    return true;
}

// Whether rays look for the way out of the solid.
fn seeks_way_out() -> bool {
    return !SOLID_ENDS;
}

// What a search has come to.
const MISSED: u32 = 0u;
const FOUND: u32 = 1u;
const WAITING: u32 = 2u;
// Nothing, but the excess came so close to 0 at the ray's end that it may have reached it.
const DOUBTED: u32 = 3u;
// One root is between the ends of a bracket: `close_in` finds it.
const BRACKETED: u32 = 4u;
// The ray does not come through the leaf's box.
const UNMET: u32 = 5u;
// Nothing, but on the way out the excess came so close to 0 at the leaf's far face that it reaches it there,
// unless another leaf begins where this one ends: in no leaf the field is below T. `search.high` says where.
const LEAVING: u32 = 6u;

// Stages of a search: on the way through the leaf, or between the ends of a bracket.
const ENTER: u32 = 0u;
const NARROW: u32 = 1u;
const SOLVE: u32 = 2u;

// The search as it stands, in the leaf's local t: nothing before `low` reaches 0, the interval looked
// at is from `low_value` to `high`; between the ends of a bracket, `high_value` is where the root is
// next looked for. `iterations` counts looks, up to one more once the ray's start has been asked about. A hit
// leaves its global t in `high`.
struct Search {
    stage: u32,
    next: u32,
    low: f32,
    low_value: f32,
    high: f32,
    high_value: f32,
    iterations: u32,
}

var<private> search: Search;
var<private> found: u32;

// The status of a hit just found.
fn status_found() -> u32 {
    return found;
}

// An interval of this part of the smallest radius in it is short: a root in it is known well enough.
const SHORT: f32 = 0x1p-20f;

// The excess at a local t, its slope, and what the slope's slope is nowhere more than: best values, no
// bounds.
fn excess_and_slopes(frame: Frame, direction: vec3<f32>, t: f32) -> vec3<f32> {
    begin_walk();
    var sum = vec2(-scene.threshold, 0.0);
    var bend = 0.0;
    var word = 0u;
    loop {
        var bits = near_in(word);
        loop {
            if bits != 0u {
                let seen = project(frame, direction, ball_of(word, bits));
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

// Goes on with the search of a leaf. FOUND leaves the hit's distance in `search.high`.
fn search_leaf(ray: Ray, inverse: vec3<f32>, index: u32) -> u32 {
    let leaf = leaves[index];
    let first = leaf.first;
    let end = leaves[index + 1u].first;
    let frame = local_frame(ray, inverse, leaf.min, leaf.max);

    if !can_walk(end - first + WORDS + 1u) {
        return WAITING;
    }
    if search.stage == ENTER {
        if frame.enter > frame.leave {
            return UNMET;
        }
        count_leaf_test();
        // A leaf without a list is solid. Its faces lie inside the surface: a ray that comes to it and is in it
        // for no longer than rounding can make up is told by the leaves around.
        if first == end {
            let is_told = frame.starts_within || frame.leave - frame.enter > 4.0 * frame.slack;
            if !SOLID_ENDS || !is_told {
                return MISSED;
            }
            return found_at(max(at(frame, frame.enter), 0.0), select(HIT, INSIDE, frame.starts));
        }
    }
    let most = gather(frame, ray.direction, first, end);
    if search.stage == ENTER {
        count_balls(end - first);
        if stays_below(most) {
            return MISSED;
        }
        search = Search(NARROW, 0u, frame.enter, frame.enter, frame.leave, 0.0, 0u);
    }

    loop {
        if search.stage == NARROW && search.iterations < LOOKS {
            if !can_walk(walk_length()) {
                return WAITING;
            }
            let seen = look(frame, ray.direction, search.low, search.high);
            let tells = seen.outcome != UNCLEAR || seen.low > search.low || seen.high < search.high;
            search.iterations = select(LOOKS, search.iterations + 1u, tells);
            if seen.outcome == BELOW && search.high >= frame.leave {
                return MISSED;
            }
            if seen.outcome == ABOVE {
                return found_at(max(at(frame, seen.high), 0.0), HIT);
            }
            if seen.outcome == ONCE {
                search.stage = SOLVE;
                search.high_value = seen.guess;
            } else {
                search.low = select(seen.low, search.high, seen.outcome == BELOW);
                search.low_value = search.low;
                search.high = select(seen.high, frame.leave, seen.outcome == BELOW);
            }
        }
        if search.stage != NARROW || search.iterations >= LOOKS {
            break;
        }
    }

    // A look that tells anything has found the excess below 0 where it begins. Without, the ray's start may be
    // beyond the root: that is asked once.
    var is_new = frame.starts && search.low == frame.enter && search.iterations <= LOOKS;
    loop {
        if search.stage == NARROW {
            if !can_walk(walk_length()) {
                return WAITING;
            }
            // The interval from `probe` on is looked at; before it the excess is below 0 up to `low`, and
            // rises from there.
            let probe = search.low_value;
            let width = search.high - probe;
            let bounds = bounds_on(frame, ray.direction, probe, select(search.high, probe, is_new));
            if is_new {
                if bounds.end_least >= 0.0 {
                    return found_at(0.0, INSIDE);
                }
                if bounds.most >= 0.0 {
                    return found_at(0.0, UNDECIDED);
                }
                search.iterations = LOOKS + 1u;
                is_new = false;
                continue;
            }
            let rises = bounds.least_slope > 0.0;
            // What rises is greatest at its end.
            let is_below = bounds.most < 0.0 || (rises && bounds.end_most < 0.0);
            let is_short = width <= SHORT * bounds.radius;
            if any_will_do() && bounds.end_least > 0.0 {
                return found_at(max(at(frame, search.high), 0.0), HIT);
            }
            if bounds.end_least > 0.0 && (rises || is_short) {
                search.stage = SOLVE;
                search.high_value = probe + width * cubic_root(bounds.start, bounds.end, width);
            } else if is_below || rises {
                // All below 0; or rising so close to 0 that what comes next must tell.
                if search.high >= frame.leave {
                    return far_end(frame, ray, is_below);
                }
                search.low = select(search.low, search.high, is_below);
                search.low_value = search.high;
                search.high = min(search.high + 2.0 * width, frame.leave);
            } else {
                let middle = probe + 0.5 * width;
                // No float is left between the ends, or none that would tell anything.
                if middle <= probe || middle >= search.high || is_short {
                    return found_at(max(at(frame, probe), 0.0), UNDECIDED);
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

// What a search has come to that found no root up to where the ray leaves the leaf or ends.
//
// On the way in, what rises so close to 0 at a face is told by what lies behind: another leaf, which begins
// there, or none; then the field is below T at the face, and since it rose to there, before it, too.
fn far_end(frame: Frame, ray: Ray, is_below: bool) -> u32 {
    let leaves_at = at(frame, frame.leave) * (1.0 + 8.0 * UNIT);
    if is_below {
        return MISSED;
    }
    if frame.ends || leaves_at >= ray.t_max {
        return DOUBTED;
    }
    if !seeks_way_out() {
        return MISSED;
    }
    search.high = leaves_at;
    return LEAVING;
}

// Takes up a leaf again of which it has turned out that the ray leaves the solid in it, at its far face if
// nowhere before. Returns whether there was room for the walk along its list.
fn take_up_way_out(ray: Ray, inverse: vec3<f32>, index: u32) -> bool {
    let leaf = leaves[index];
    let frame = local_frame(ray, inverse, leaf.min, leaf.max);
    search = Search(SOLVE, 0u, frame.enter, frame.enter, frame.leave, frame.leave, 0u);
    let end = leaves[index + 1u].first;
    if !can_walk(end - leaf.first + WORDS + 1u) {
        return false;
    }
    gather(frame, ray.direction, leaf.first, end);
    return true;
}

// Whether a root is still to be closed in on.
fn is_bracketed() -> bool {
    return search.stage == SOLVE;
}

// Closes in on the root in a bracket. Apart from the search, so that rays side by side, which come to
// their hits in different leaves, do it at the same time.
fn close_in(ray: Ray, inverse: vec3<f32>, index: u32) -> u32 {
    let leaf = leaves[index];
    let frame = local_frame(ray, inverse, leaf.min, leaf.max);
    // One root between the ends, or too short a way between them to matter: Newton's steps, kept
    // between the ends (Press et al., rtsafe). Where the slope is f', a step leaves at most
    // step^2 bend / 2 f': once that is less than the ray's own points are known to, none follows.
    var t = search.high_value;
    let known = UNIT * max(abs(frame.enter), abs(frame.leave));
    for (var step = 0u; step < 48u; step++) {
        if !can_walk(walk_length()) {
            return WAITING;
        }
        count_iterations(1u);
        let value = excess_and_slopes(frame, ray.direction, t);
        if value.x >= 0.0 {
            search.high = t;
        } else {
            search.low = t;
        }
        // Where the excess does not rise, as before the rim of a support, no step tells anything.
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
        search.high_value = t;
        if is_last || next <= search.low || next >= search.high {
            break;
        }
    }
    return found_at(max(at(frame, t), 0.0), HIT);
}

fn found_at(t: f32, status: u32) -> u32 {
    search.stage = ENTER;
    search.high = t;
    found = status;
    return FOUND;
}

// What rounding and an early end can leave of F - T at a hit, and by how much rounding can move a ball's
// v there: `certified.rs` for a stretch as long as the leaf's diagonal, from a point beside the leaf that
// t stretches by 2^-10 of a float. Of the 24 diagonals, 17 are the search's own margin, and 2 are where
// the last of Newton's steps may end.
fn residual() -> f32 {
    return 0.0;
}

fn depth_error(leaf: Leaf, ray: Ray, t: f32, offset: vec3<f32>, radius: f32) -> f32 {
    let diagonal = length(leaf.max - leaf.min);
    return UNIT * (26.0 + (24.0 * diagonal + 0x1p-8f * t) / radius);
}
