// Finds the first hit of each ray without peeling: by intervals of the ray on which every ball's least
// and greatest share of the field is known in closed form. An interval with a field below T throughout
// is passed; one that certainly rises through T holds one root; any other is halved. No point at which
// a ball begins or ends matters, so none can be missed, and there is no list to overflow.
//
// Distances are relative to a nearby origin on the ray. A ray whose work exceeds the budget waits for the
// next dispatch.

#import color::{blend_add, blend_start, blend_write}
#import core::field::{contribution, gradient, outward_normal}
#import core::hit
#import core::nearby_origin::{grid_width, nearby_origin, on_grid, relative_to, NearbyOrigin, UNIT}
#import core::scene::scene
#import core::status::{report_finished, report_needed, report_unfinished}
#import core::tiles::tile_at
#import core::view::{in_picture, pixel_at, rays, view, PrimaryRay}
#import kanamori_robust::lists
#import kanamori_robust::lists::entries
#import kernel::{kernel, kernel_roundings, kernel_slope, steepest_slope}
#import strength::strength
#import support::support_of
#import work::{count_balls, count_evaluations, count_iterations, count_leaf_test, write_work}

// Iterations after which a ray waits. Before it checks again two walks along a window may follow, four balls
// an iteration: 8,096 in all. Software Vulkan runs eight invocations side by side and silently ends their
// loops after 65,535 iterations in all, the sum of theirs where they diverge.
@id(44) override budget: u32 = 4000u;

// Balls that one interval can reach: INTERVAL_CAPACITY of crates/kanamori-peel/src/robust.rs.
const INTERVAL_CAPACITY: u32 = 8192u;
// Behind the last ball of a walk.
const END: u32 = 0xffffffffu;
// An interval of this part of the smallest radius in it is short: a root in it is known well enough.
const SHORT: f32 = 0x1p-20f;

// Stages of a search; a cleared state begins.
const BEGIN: u32 = 0u;
const NARROW: u32 = 1u;
const SOLVE: u32 = 2u;
const DONE: u32 = 3u;

// A search between two dispatches. Nothing before `low` reaches T; from there to `probe` the field rises;
// the interval to be bounded next is from `probe` to `high`. All three are t less `base`. Twin: State of
// crates/kanamori-peel/src/robust/buffers.rs.
struct State {
    stage: u32,
    // The first entry of the tile's list that does not end before `probe`.
    first: u32,
    base: f32,
    low: f32,
    probe: f32,
    high: f32,
}

@group(2) @binding(2) var<storage, read_write> states: array<State>;

var<private> state: State;
// At t = `base` of the ray.
var<private> origin: NearbyOrigin;
// The end of the tile's list, and what has been spent of the budget.
var<private> list_end: u32;
var<private> spent: u32;

@compute @workgroup_size(8, 8)
fn search(@builtin(global_invocation_id) id: vec3<u32>) {
    if !in_picture(id.xy) {
        return;
    }
    let pixel = pixel_at(id.xy);
    state = states[pixel];
    if state.stage == DONE {
        return;
    }
    let ray = rays[pixel];
    let list = lists::list_of(tile_at(id.xy));
    list_end = list.y;
    let begins = state.stage == BEGIN;
    if begins {
        begin(pixel, ray, list.x);
    } else {
        origin = origin_at(ray, state.base);
    }
    while state.stage != DONE && spent < budget {
        if state.stage == NARROW {
            narrow(pixel, ray);
        } else {
            solve(pixel, ray);
        }
    }
    write_work(pixel);
    states[pixel] = state;
    if begins && state.stage != DONE {
        report_unfinished();
    } else if !begins && state.stage == DONE {
        report_finished();
    }
}

fn begin(pixel: u32, ray: PrimaryRay, first: u32) {
    state.first = first;
    if first == list_end {
        miss(pixel);
        return;
    }
    let ball = entries[first].ball;
    let near = max(entries[first].near, 0.0);
    state.stage = NARROW;
    state.base = near;
    state.high = support_of(ball).radius;
    rebase(ray);
    if near == 0.0 {
        let start = bounds_on(ray.direction, 0.0, 0.0);
        if start.end_least >= scene.threshold {
            surface(pixel, ray, 0.0, hit::INSIDE);
        } else if start.most >= scene.threshold {
            undecided(pixel, ray);
        }
    }
}

fn origin_at(ray: PrimaryRay, base: f32) -> NearbyOrigin {
    let point = view.eye + base * ray.direction;
    let grid = grid_width(view.eye, point);
    return nearby_origin(view.eye, ray.direction, base, on_grid(point, grid), grid);
}

// Moves the base to `probe`, rounded to twenty bits so that differences of bases are exact. Distances
// are widened by what their own rounding may need.
fn rebase(ray: PrimaryRay) {
    let there = state.base + state.probe;
    let next = bitcast<f32>(bitcast<u32>(there) & 0xfffffff0u);
    let moved = next - state.base;
    let slack = 2.0 * UNIT * abs(moved);
    state.low -= moved + slack;
    state.probe -= moved + slack;
    state.high -= moved - slack;
    state.base = next;
    origin = origin_at(ray, next);
}

// Bounds the field on one interval, and moves on or halves it.
fn narrow(pixel: u32, ray: PrimaryRay) {
    skip_passed();
    if spent >= budget {
        return;
    }
    if state.first == list_end {
        miss(pixel);
        return;
    }
    // Where no ball reaches, the search continues at the next.
    let gap = (entries[state.first].near - state.base) * (1.0 - 2.0 * UNIT);
    if gap > state.probe {
        state.low = gap;
        state.probe = gap;
        state.high = gap + support_of(entries[state.first].ball).radius;
    }
    if state.probe > state.high - state.probe {
        rebase(ray);
    }
    let end = ray.t_max - state.base;
    if state.probe >= end {
        miss(pixel);
        return;
    }
    state.high = min(state.high, end);

    count_leaf_test();
    let width = state.high - state.probe;
    let bounds = bounds_on(ray.direction, state.probe, state.high);
    let rises = bounds.least_slope > 0.0;
    var is_below = bounds.most < scene.threshold;
    if !is_below && rises && bounds.end_least <= scene.threshold {
        // What rises is greatest at its end.
        is_below = bounds_on(ray.direction, state.high, state.high).most < scene.threshold;
    }
    let is_short = width <= SHORT * bounds.radius;
    if bounds.end_least > scene.threshold && (rises || is_short) {
        state.stage = SOLVE;
    } else if is_below || rises {
        // All below T; or rising so close to T that the next interval must decide.
        if state.high >= end && !is_below {
            undecided(pixel, ray);
        }
        state.low = select(state.low, state.high, is_below);
        state.probe = state.high;
        state.high += 2.0 * width;
    } else {
        let middle = state.probe + 0.5 * width;
        // No float is left between the ends, or none that would decide anything.
        if middle <= state.probe || middle >= state.high || is_short {
            undecided(pixel, ray);
        }
        state.high = middle;
    }
    if bounds.is_incomplete {
        // Never finished: the frame stays incomplete, and its method reports why.
        report_unfinished();
        report_needed(2u, INTERVAL_CAPACITY + 1u);
        state.stage = DONE;
    }
}

// Balls at the front of the list that end before `probe`.
fn skip_passed() {
    while state.first < list_end && spent < budget {
        let entry = entries[state.first];
        let width = 2.0 * support_of(entry.ball).radius;
        let far = entry.near - state.base + width + 64.0 * UNIT * (abs(entry.near) + width);
        if far >= state.probe {
            return;
        }
        state.first++;
        spent++;
    }
}

// One root between `low` and `high`, or too short a way between them to matter: Newton's steps, kept
// between the ends (Press et al., rtsafe).
fn solve(pixel: u32, ray: PrimaryRay) {
    var t = 0.5 * (state.low + state.high);
    for (var step = 0u; step < 48u; step++) {
        if spent >= budget {
            return;
        }
        count_iterations(1u);
        let value = field_and_slope(ray.direction, t);
        if value.x >= 0.0 {
            state.high = t;
        } else {
            state.low = t;
        }
        var next = t - value.x / select(value.y, 1.0, value.y == 0.0);
        if next <= state.low || next >= state.high {
            next = 0.5 * (state.low + state.high);
        }
        let is_last = abs(next - t) <= 4.0 * UNIT * max(abs(t), abs(next));
        t = next;
        if is_last || next <= state.low || next >= state.high {
            break;
        }
    }
    surface(pixel, ray, t, hit::HIT);
}

// What is certain of the field on an interval, and what it is at the interval's end.
struct Bounds {
    // Nowhere more than this.
    most: f32,
    // The slope is nowhere less, 1/scene unit: what rising balls add to it, less what falling ones take.
    least_slope: f32,
    gains: f32,
    losses: f32,
    // At the end: certainly at least this.
    end_least: f32,
    // Least radius among the balls that reach the interval.
    radius: f32,
    // Balls that were visited.
    balls: u32,
    // Whether more than the window holds may reach the interval.
    is_incomplete: bool,
}

// One walk along the balls that may reach the interval.
//
// A ball's share is greatest at the interval's nearest point to its projection and least at an end; the
// slope 2 q kernel'(v) (middle - t) / R^2 is least at the interval's end.
//
// Rounding moves v = 1 - r^2/R^2 by at most u (13 + 12 rho), u = 2^-23, where rho is the centre's distance
// from the nearby origin over R: the offset, its part along the ray and what is left across the ray err by
// 2.42 u of its length together, an error along the ray counting to second order only; the way along the ray
// errs by 3 u of it, and by what the direction lacks to unit length; sums, products, a division to 2.5 units
// and the last difference make 13 u. A ball that reaches an interval within L of the origin has
// rho <= 1 + L/R: 26 u and 12 u L/R suffice. What misplaces the origin moves r by as much, and v by twice
// that over R.
fn bounds_on(direction: vec3<f32>, low: f32, high: f32) -> Bounds {
    var bounds = Bounds(0.0, 0.0, 0.0, 0.0, 0.0, 1e38, 0u, false);
    let end = window_end();
    var index = state.first;
    loop {
        index = bound_ball(index, end, direction, low, high, &bounds);
        index = bound_ball(index, end, direction, low, high, &bounds);
        index = bound_ball(index, end, direction, low, high, &bounds);
        index = bound_ball(index, end, direction, low, high, &bounds);
        if index >= end {
            break;
        }
    }
    let balls = bounds.balls;
    count_balls(balls);
    count_evaluations(balls);
    spent += balls / 4u + 1u;
    // The sum of n terms of one sign, each a kernel or its slope in a few products, errs by less than this
    // part of it.
    let summing = f32(balls + 24u + kernel_roundings()) * UNIT;
    bounds.most *= 1.0 + summing;
    bounds.least_slope = bounds.gains * (1.0 - summing) - bounds.losses * (1.0 + summing);
    bounds.end_least *= 1.0 - summing;
    bounds.is_incomplete = balls == INTERVAL_CAPACITY && end < list_end;
    return bounds;
}

// The index behind the last ball that may be visited.
fn window_end() -> u32 {
    return min(list_end, state.first + INTERVAL_CAPACITY);
}

// Whether no ball from an index on reaches a distance less the base, rounding included.
fn begins_behind(index: u32, high: f32) -> bool {
    return entries[index].near - state.base > high + 2.0 * UNIT * abs(high);
}

// Adds a ball to bounds. Returns the next index; END behind the last ball that may reach the interval.
fn bound_ball(
    index: u32,
    end: u32,
    direction: vec3<f32>,
    low: f32,
    high: f32,
    bounds: ptr<function, Bounds>,
) -> u32 {
    if index >= end || begins_behind(index, high) {
        return END;
    }
    (*bounds).balls++;
    let ball = entries[index].ball;
    let support = support_of(ball);
    let offset = relative_to(origin, support.center);
    let middle = dot(offset, direction);
    let off_axis = offset - middle * direction;
    let inverse_radius = 1.0 / support.radius;
    let inverse_square = inverse_radius * inverse_radius;
    let off_square = dot(off_axis, off_axis);
    let margin_length = 12.0 * UNIT * max(abs(low), abs(high)) + 2.1 * origin.misplaced;
    let margin = 26.0 * UNIT + margin_length * inverse_radius;

    let near = clamp(middle, low, high) - middle;
    let v_most = 1.0 - (off_square + near * near) * inverse_square + margin;
    if v_most <= 0.0 {
        return index + 1u;
    }
    let to_end = high - middle;
    let to_start = low - middle;
    let v_end = 1.0 - (off_square + to_end * to_end) * inverse_square;
    let v_start = 1.0 - (off_square + to_start * to_start) * inverse_square;
    let q = strength(ball);
    (*bounds).most += q * kernel(v_most);
    (*bounds).end_least += q * kernel(v_end - margin);
    let v_least = min(v_start, v_end) - margin;
    let steep = 2.0 * q * inverse_square;
    let least_way = middle - high - margin * support.radius;
    if least_way > 0.0 {
        (*bounds).gains += steep * min(kernel_slope(v_least), kernel_slope(v_most)) * least_way;
    } else {
        (*bounds).losses -= steep * steepest_slope(v_least, v_most) * least_way;
    }
    (*bounds).radius = min((*bounds).radius, support.radius);
    return index + 1u;
}

// The field less T and its slope: best values, no bounds.
fn field_and_slope(direction: vec3<f32>, t: f32) -> vec2<f32> {
    var sum = vec2(-scene.threshold, 0.0);
    let end = window_end();
    var index = state.first;
    var walked = 1u;
    loop {
        index = add_field(index, end, direction, t, &sum);
        index = add_field(index, end, direction, t, &sum);
        index = add_field(index, end, direction, t, &sum);
        index = add_field(index, end, direction, t, &sum);
        walked++;
        if index >= end {
            break;
        }
    }
    count_evaluations(4u * (walked - 1u));
    spent += walked;
    return sum;
}

// Adds a ball to field and slope. Returns the next index; END behind the last ball that may reach t.
fn add_field(
    index: u32,
    end: u32,
    direction: vec3<f32>,
    t: f32,
    sum: ptr<function, vec2<f32>>,
) -> u32 {
    if index >= end || begins_behind(index, state.high) {
        return END;
    }
    let ball = entries[index].ball;
    let support = support_of(ball);
    let offset = relative_to(origin, support.center);
    let middle = dot(offset, direction);
    let off_axis = offset - middle * direction;
    let along = t - middle;
    let square = support.radius * support.radius;
    let v = 1.0 - (dot(off_axis, off_axis) + along * along) / square;
    *sum += strength(ball) * vec2(kernel(v), -2.0 * along / square * kernel_slope(v));
    return index + 1u;
}

fn miss(pixel: u32) {
    hit::write_miss(pixel);
    state.stage = DONE;
}

fn undecided(pixel: u32, ray: PrimaryRay) {
    let t = clamp(state.base + state.probe, 0.0, ray.t_max);
    hit::write_hit(pixel, t, -ray.direction, hit::UNDECIDED);
    state.stage = DONE;
}

// Writes a hit at a t less the base, with its normal and colour.
fn surface(pixel: u32, ray: PrimaryRay, t: f32, status: u32) {
    var slope = vec3(0.0);
    blend_start();
    let end = window_end();
    var index = state.first;
    loop {
        index = add_slope(index, end, ray.direction, t, &slope);
        index = add_slope(index, end, ray.direction, t, &slope);
        index = add_slope(index, end, ray.direction, t, &slope);
        index = add_slope(index, end, ray.direction, t, &slope);
        if index >= end {
            break;
        }
    }
    blend_write(pixel);
    let normal = outward_normal(slope, ray.direction);
    hit::write_hit(pixel, clamp(state.base + t, 0.0, ray.t_max), normal, status);
    state.stage = DONE;
}

// Adds what a ball gives to slope and colour at a t less the base. Returns the next index; END behind the
// last ball that may reach t.
fn add_slope(
    index: u32,
    end: u32,
    direction: vec3<f32>,
    t: f32,
    slope: ptr<function, vec3<f32>>,
) -> u32 {
    if index >= end || begins_behind(index, t + 2.0 * UNIT * abs(t)) {
        return END;
    }
    let ball = entries[index].ball;
    let support = support_of(ball);
    let to_center = relative_to(origin, support.center);
    let middle = dot(to_center, direction);
    let along = t - middle;
    let off_axis = to_center - middle * direction;
    let square = support.radius * support.radius;
    let v = 1.0 - (dot(off_axis, off_axis) + along * along) / square;
    *slope += gradient(ball, v, along * direction - off_axis, support.radius);
    blend_add(ball, contribution(ball, v));
    return index + 1u;
}
