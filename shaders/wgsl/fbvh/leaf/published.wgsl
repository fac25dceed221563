// The intersection test of Gourmel et al. 2010, section 3, in one leaf: the first projection of a
// centre at which the field is above the threshold closes a bracket, and the secant method narrows
// it. Twin: crates/fbvh/src/trace/secant.rs.

#import core::field::{contribution, depth_below_rim, offset_at}
#import core::hit::{HIT, INSIDE}
#import core::ray::Ray
#import core::scene::scene
#import core::view::NO_LIMIT
#import fbvh::budget::{can_continue, can_walk, spent}
#import fbvh::leaf_outcome::{FOUND, MISSED, WAITING}
#import fbvh::structure::{is_empty, leaves, lists, through_box, Interval, Leaf}
#import ray::any_hit_suffices
#import support::support_of
#import work::{count_balls, count_evaluations, count_iterations, count_leaf_test}

// The FBVH projects all balls of a leaf, the modified BVH its own (sections 5.2 and 4).
@id(17) override fitted: bool = true;
// The reading of section 5.2: projections clamped to the interval of the ray inside the leaf's box,
// the bracket opened at its entry; or, literally, projections wherever they fall and the bracket
// opened at the ray's origin.
@id(18) override clipped: bool = true;
// The secant search ends when |field - T| is at most this part of T, or after so many steps.
@id(19) override tolerance: f32 = 1e-4;
@id(20) override max_iterations: u32 = 64u;

// Leaves of the FBVH do not overlap.
fn first_hit_ends() -> bool {
    return fitted;
}

// The paper's test starts outside.
fn seeks_exit() -> bool {
    return false;
}

// Stages of a search.
const ENTER: u32 = 0u;
const PROJECT: u32 = 1u;
const LEAVE: u32 = 2u;
const START: u32 = 3u;
const SOLVE: u32 = 4u;
// The same, after a step that moved the low or the high end.
const SOLVE_AFTER_LOW: u32 = 5u;
const SOLVE_AFTER_HIGH: u32 = 6u;

// A value not yet known, at a low end: known ones are negative.
const UNKNOWN: f32 = 1.0;

// `low` is before the surface, `high` at or behind it once its value is not negative; values are
// field - T, at times halved to weight the secant (Illinois).
struct Search {
    stage: u32,
    // Entry of the list whose ball is projected next.
    next: u32,
    low: f32,
    low_value: f32,
    high: f32,
    high_value: f32,
    iterations: u32,
}

var<private> search: Search;

fn reset() {
    search.stage = ENTER;
}

fn hit_t() -> f32 {
    return search.high;
}

// At the ray's origin the field was T or more to begin with.
fn hit_status() -> u32 {
    return select(INSIDE, HIT, search.high > 0.0);
}

fn is_bracketed() -> bool {
    return false;
}

fn close_in(ray: Ray, inverse: vec3<f32>, index: u32) -> u32 {
    return FOUND;
}

fn bracket_exit(ray: Ray, inverse: vec3<f32>, index: u32) -> bool {
    return true;
}

// What one ball adds to the field at t.
fn contribution_at(ball: u32, ray: Ray, t: f32) -> f32 {
    let support = support_of(ball);
    let offset = offset_at(ray.origin - support.center, ray.direction, t);
    return contribution(ball, depth_below_rim(offset, support.radius));
}

// Field minus threshold at t, summed over a leaf's list. Four balls an iteration.
fn field_above(ray: Ray, first: u32, end: u32, t: f32) -> f32 {
    count_evaluations(end - first);
    var sum = 0.0;
    var entry = first;
    if entry + 4u <= end {
        loop {
            sum += contribution_at(lists[entry], ray, t)
                + contribution_at(lists[entry + 1u], ray, t)
                + contribution_at(lists[entry + 2u], ray, t)
                + contribution_at(lists[entry + 3u], ray, t);
            entry += 4u;
            if entry + 4u > end {
                break;
            }
        }
    }
    if entry < end {
        loop {
            sum += contribution_at(lists[entry], ray, t);
            entry++;
            if entry >= end {
                break;
            }
        }
    }
    spent += walk_along(first, end);
    return sum - scene.threshold;
}

// Iterations of an evaluation, at most.
fn walk_along(first: u32, end: u32) -> u32 {
    return (end - first) / 4u + 4u;
}

fn search_leaf(ray: Ray, inverse: vec3<f32>, index: u32) -> u32 {
    let leaf = leaves[index];
    let end = leaves[index + 1u].first;
    let walk = walk_along(leaf.first, end);
    let in_box = through_box(leaf.min, leaf.max, ray, inverse);
    var interval = Interval(0.0, ray.t_max);
    if clipped {
        interval = in_box;
    }

    if search.stage == ENTER {
        // Only a tree of one leaf has not tested its box before.
        if is_empty(in_box) {
            return MISSED;
        }
        if !can_walk(walk) {
            return WAITING;
        }
        count_leaf_test();
        count_balls(end - leaf.first);
        search = Search(PROJECT, leaf.first, interval.enter, UNKNOWN, interval.leave, -1.0, 0u);
        // Where the box holds the ray's start, that may be inside the surface.
        if clipped || in_box.enter == 0.0 {
            search.low_value = field_above(ray, leaf.first, end, interval.enter);
            if search.low_value >= 0.0 {
                search.high = interval.enter;
                return FOUND;
            }
        }
    }

    if search.stage == PROJECT {
        let projected = select(leaf.first + leaf.own, end, fitted);
        while search.next < projected {
            if !can_continue() {
                return WAITING;
            }
            let t = dot(support_of(lists[search.next]).center - ray.origin, ray.direction);
            if t > search.low && t < search.high {
                if !can_walk(walk) {
                    return WAITING;
                }
                let value = field_above(ray, leaf.first, end, t);
                if value >= 0.0 {
                    search.high = t;
                    search.high_value = value;
                    if any_hit_suffices() {
                        return FOUND;
                    }
                }
            }
            search.next++;
            spent++;
        }
        search.stage = LEAVE;
    }

    // Projections beyond the interval are clamped to its end, all of them in one evaluation.
    if search.stage == LEAVE {
        if search.high_value < 0.0 && search.high < NO_LIMIT {
            if !can_walk(walk) {
                return WAITING;
            }
            search.high_value = field_above(ray, leaf.first, end, search.high);
        }
        if search.high_value < 0.0 {
            return MISSED;
        }
        search.stage = START;
    }

    if search.stage == START {
        if search.low_value == UNKNOWN {
            if !can_walk(walk) {
                return WAITING;
            }
            search.low_value = field_above(ray, leaf.first, end, search.low);
        }
        if search.low_value >= 0.0 {
            search.high = search.low;
            return FOUND;
        }
        if search.high_value <= tolerance * scene.threshold {
            return FOUND;
        }
        search.stage = SOLVE;
    }

    while search.iterations < max_iterations {
        let share = search.low_value / (search.low_value - search.high_value);
        var t = search.low + share * (search.high - search.low);
        if t <= search.low || t >= search.high {
            t = search.low + 0.5 * (search.high - search.low);
        }
        // No float is left between the ends.
        if t <= search.low || t >= search.high {
            break;
        }
        if !can_walk(walk) {
            return WAITING;
        }
        count_iterations(1u);
        let value = field_above(ray, leaf.first, end, t);
        search.iterations++;
        if abs(value) <= tolerance * scene.threshold {
            search.high = t;
            break;
        }
        // An end that stays a second time counts half, or it might stay for ever (Illinois).
        if value > 0.0 {
            search.high = t;
            search.high_value = value;
            search.low_value *= select(1.0, 0.5, search.stage == SOLVE_AFTER_HIGH);
            search.stage = SOLVE_AFTER_HIGH;
        } else {
            search.low = t;
            search.low_value = value;
            search.high_value *= select(1.0, 0.5, search.stage == SOLVE_AFTER_LOW);
            search.stage = SOLVE_AFTER_LOW;
        }
    }
    return FOUND;
}

fn residual() -> f32 {
    return tolerance * scene.threshold;
}

// An offset errs by the roundings of a difference, a product and a sum; three squares, two sums, a
// square, a division and a difference follow.
fn depth_error(leaf: Leaf, ray: Ray, t: f32, offset: vec3<f32>, radius: f32) -> f32 {
    return 0x1p-23f * (6.0 + 4.0 * (2.0 * t + length(offset)) / radius);
}
