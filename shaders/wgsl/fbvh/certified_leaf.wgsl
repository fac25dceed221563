// The first root in a leaf by exact ranges: no ray's answer is ever wrong, for any kernel that falls
// with distance. Stands in for leaf.wgsl in trees of classified boxes. Twin:
// crates/fbvh/src/certified.rs, which derives what is used here.
#define_import_path metaball::fbvh::leaf

#import metaball::fbvh::local::{at, local_frame, Frame}
#import metaball::fbvh::structure::{leaves, lists, Stretch}
#import metaball::fbvh::suspend::{can_go_on, spent}
#import metaball::hit::{HIT, INSIDE, UNDECIDED}
#import metaball::kernel::{kernel, kernel_slope, steepest_slope}
#import metaball::scene::{scene, supports}
#import metaball::strength::strength
#import metaball::view::Ray
#import metaball::work::{count_balls, count_evaluations, count_iterations, count_leaf_test}

// Leaves do not overlap: once one holds a hit, no later one holds a nearer.
fn first_hit_ends() -> bool {
    return true;
}

// What a search has come to.
const MISSED: u32 = 0u;
const FOUND: u32 = 1u;
const WAITING: u32 = 2u;
// Nothing, but the field came so close to T at the leaf's far side that only a hit beyond can tell.
const DOUBTED: u32 = 3u;

// Stages of a search: on the way through the leaf, or between the ends of a bracket.
const ENTER: u32 = 0u;
const NARROW: u32 = 1u;
const SOLVE: u32 = 2u;

// The search as it stands, in the leaf's local t: nothing before `low` reaches T, the interval looked
// at is from `low_value` to `high`. A hit leaves its global t in `high`.
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

// Two to the power of -23: WGSL may round to either neighbour.
const UNIT: f32 = 0x1p-23f;
// An interval of this part of the smallest radius in it is short: a root in it is known well enough.
const SHORT: f32 = 0x1p-20f;

// What is certain of the field on an interval, and what it is at the interval's end.
struct Bounds {
    // Nowhere more than this.
    most: f32,
    // The slope is nowhere less, 1/scene unit.
    least_slope: f32,
    // At the end: certainly at least this.
    end_least: f32,
    // Least radius among the balls that reach the interval.
    radius: f32,
}

// One walk along the leaf's list.
fn bounds_on(frame: Frame, direction: vec3<f32>, first: u32, end: u32, low: f32, high: f32) -> Bounds {
    count_evaluations(end - first);
    spent += end - first;
    var most = 0.0;
    var least_slope = 0.0;
    var end_least = 0.0;
    var radius = 1e38;
    for (var entry = first; entry < end; entry++) {
        let ball = lists[entry];
        let support = supports[ball];
        let offset = (support.center - frame.center) - frame.origin;
        let middle = dot(offset, direction);
        let off_axis = offset - middle * direction;
        let inverse_radius = 1.0 / support.radius;
        let inverse_square = inverse_radius * inverse_radius;
        let off_square = dot(off_axis, off_axis);
        // How far rounding can move v = 1 - r^2/R^2.
        let margin = frame.margin + frame.margin_length * inverse_radius;

        let near = clamp(middle, low, high) - middle;
        let v_most = 1.0 - (off_square + near * near) * inverse_square + margin;
        if v_most <= 0.0 {
            continue;
        }
        let to_end = high - middle;
        let to_start = low - middle;
        let v_end = 1.0 - (off_square + to_end * to_end) * inverse_square;
        let v_start = 1.0 - (off_square + to_start * to_start) * inverse_square;
        let q = strength(ball);
        most += q * kernel(v_most);
        end_least += q * kernel(v_end - margin);
        // The derivative by t is 2 q kernel'(v) (middle - t)/R^2: of one sign on either side of the
        // projection, and bounded there by the product of what bounds its factors.
        var slope = 0.0;
        if middle >= high {
            let gentlest = min(kernel_slope(v_start - margin), kernel_slope(v_end - margin));
            slope = gentlest * max(middle - high, 0.0) * (1.0 - 16.0 * UNIT);
        } else {
            slope = -steepest_slope(v_most) * (high - middle) * (1.0 + 16.0 * UNIT);
        }
        least_slope += 2.0 * q * inverse_square * slope;
        radius = min(radius, support.radius);
    }
    // The sum of n terms of one sign, each of a few products, errs by less than this part of it.
    let summing = f32(end - first + 24u) * UNIT;
    return Bounds(most * (1.0 + summing), least_slope, end_least * (1.0 - summing), radius);
}

// The field less T at a local t, and its slope: best values, no bounds.
fn field_and_slope(frame: Frame, direction: vec3<f32>, first: u32, end: u32, t: f32) -> vec2<f32> {
    count_evaluations(end - first);
    spent += end - first;
    var sum = vec2(-scene.threshold, 0.0);
    for (var entry = first; entry < end; entry++) {
        let ball = lists[entry];
        let support = supports[ball];
        let offset = (support.center - frame.center) - frame.origin;
        let middle = dot(offset, direction);
        let off_axis = offset - middle * direction;
        let along = t - middle;
        let square = support.radius * support.radius;
        let v = 1.0 - (dot(off_axis, off_axis) + along * along) / square;
        sum += strength(ball) * vec2(kernel(v), -2.0 * along / square * kernel_slope(v));
    }
    return sum;
}

// Goes on with the search of a leaf. FOUND leaves the hit's distance in `search.high`.
fn search_leaf(ray: Ray, inverse: vec3<f32>, index: u32) -> u32 {
    let leaf = leaves[index];
    let first = leaf.first;
    let end = leaves[index + 1u].first;
    let frame = local_frame(ray, inverse, leaf.min, leaf.max);

    if search.stage == ENTER {
        if frame.enter > frame.leave {
            return MISSED;
        }
        if !can_go_on() {
            return WAITING;
        }
        count_leaf_test();
        count_balls(end - first);
        // A leaf without a list is solid.
        if first == end {
            return found_at(max(at(frame, frame.enter), 0.0), select(HIT, INSIDE, frame.starts));
        }
        if frame.starts {
            let start = bounds_on(frame, ray.direction, first, end, frame.enter, frame.enter);
            if start.end_least >= scene.threshold {
                return found_at(0.0, INSIDE);
            }
            if start.most >= scene.threshold {
                return found_at(0.0, UNDECIDED);
            }
        }
        search = Search(NARROW, 0u, frame.enter, frame.enter, frame.leave, 0.0, 0u);
    }

    while search.stage == NARROW {
        if !can_go_on() {
            return WAITING;
        }
        // The interval from `probe` on is looked at; before it the field is below T up to `low`, and
        // rises from there.
        let probe = search.low_value;
        let width = search.high - probe;
        let bounds = bounds_on(frame, ray.direction, first, end, probe, search.high);
        let rises = bounds.least_slope > 0.0;
        var is_below = bounds.most < scene.threshold;
        if !is_below && rises && bounds.end_least <= scene.threshold {
            // What rises is greatest at its end.
            let last = bounds_on(frame, ray.direction, first, end, search.high, search.high);
            is_below = last.most < scene.threshold;
        }
        let is_short = width <= SHORT * bounds.radius;
        if bounds.end_least > scene.threshold && (rises || is_short) {
            search.stage = SOLVE;
        } else if is_below || rises {
            // All below T; or rising so close to T that the next interval must tell.
            if search.high >= frame.leave {
                return select(DOUBTED, MISSED, is_below);
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

    // One root between the ends, or too short a way between them to matter: Newton's steps, kept
    // between the ends (Press et al., rtsafe).
    var t = 0.5 * (search.low + search.high);
    for (var step = 0u; step < 48u; step++) {
        if !can_go_on() {
            return WAITING;
        }
        count_iterations(1u);
        let value = field_and_slope(frame, ray.direction, first, end, t);
        if value.x >= 0.0 {
            search.high = t;
        } else {
            search.low = t;
        }
        var next = t - value.x / select(value.y, 1.0, value.y == 0.0);
        if next <= search.low || next >= search.high {
            next = 0.5 * (search.low + search.high);
        }
        let is_last = abs(next - t) <= 4.0 * UNIT * max(abs(t), abs(next));
        t = next;
        if is_last || next <= search.low || next >= search.high {
            break;
        }
    }
    return found_at(max(at(frame, t), 0.0), HIT);
}

fn found_at(t: f32, status: u32) -> u32 {
    search.high = t;
    found = status;
    return FOUND;
}
