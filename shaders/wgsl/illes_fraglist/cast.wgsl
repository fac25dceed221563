// Casts each ray along its list (section 6): separators go into a short ordered array, and up to the
// nearest point that a ball still in the list can reach, the safe zone, they are passed one by one,
// with the piece of the field between two of them searched for its first root.

#import color::{blend_add, blend_start, blend_write}
#import core::field::{contribution, depth_below_rim, gradient, offset_at, outward_normal}
#import core::hit
#import core::status::{report_finished, report_needed, report_unfinished}
#import core::view::{in_picture, pixel_at, rays, view}
#import illes_fraglist::balls::{ball_of_rank, effective_distance, segment_of, support_of_rank}
#import illes_fraglist::budget
#import illes_fraglist::lists
#import illes_fraglist::order
#import illes_fraglist::overlap
#import illes_fraglist::piece
#import illes_fraglist::records
#import work::{count_layers, write_work}

// The state of a pixel between two dispatches; zeros when the frame begins. Twin: Progress of
// crates/illes-fraglist/src/canvas.rs. The local arrays are not kept: they follow from the list up to `node`
// and the position.
struct Progress {
    stage: u32,
    // Node of the list to resume at; of an overfull pixel the width of the next interval, as bits.
    node: u32,
    // Distance along the ray up to which there is no root.
    position: f32,
    // FALLBACK or 0.
    fallback: u32,
}

// Stages of a pixel.
const FRESH: u32 = 0u;
const UNORDERED: u32 = 1u;
const WAITING: u32 = 2u;
// Searched without the array.
const OVERFULL: u32 = 3u;
const DONE: u32 = 4u;

@group(3) @binding(3) var<storage, read_write> progress: array<Progress>;

// Outcomes of following the ray.
const PASSED: u32 = 0u;
const FOUND: u32 = 1u;
const SPENT: u32 = 2u;
const NO_CAPACITY: u32 = 3u;

var<private> direction: vec3<f32>;
// Where the search ends: the core or the opaque thing, whichever is nearer.
var<private> limit: f32;
// Separators up to here are passed and there is no root; the root, once it is found.
var<private> position: f32;
var<private> fallback: u32;

@compute @workgroup_size(8, 8)
fn cast_rays(@builtin(global_invocation_id) id: vec3<u32>) {
    if !in_picture(id.xy) {
        return;
    }
    let pixel = pixel_at(id.xy);
    let before = progress[pixel];
    if before.stage == DONE {
        return;
    }
    var now = before;
    if now.stage == FRESH && order::is_too_long(pixel) {
        report_unfinished();
        report_needed(1u, budget::LIST_CAPACITY + 1u);
        progress[pixel].stage = DONE;
        return;
    }
    if now.stage == FRESH || now.stage == UNORDERED {
        now.stage = UNORDERED;
        if order::restore_order(pixel) {
            now = Progress(WAITING, lists::head_of(pixel), 0.0, 0u);
        }
    }
    if now.stage != UNORDERED {
        let ray = rays[pixel];
        direction = ray.direction;
        let core = lists::core_distance_at(id.xy);
        limit = min(core, ray.t_max);
        position = now.position;
        fallback = now.fallback;
        var node = now.node;
        var outcome = NO_CAPACITY;
        if now.stage == WAITING {
            restore_arrays(lists::head_of(pixel), node);
            budget::begin();
            outcome = follow(&node);
            now = Progress(WAITING, node, position, fallback);
        }
        if outcome == NO_CAPACITY {
            var width = select(0.0, bitcast<f32>(now.node), now.stage == OVERFULL);
            outcome = search_without_array(lists::head_of(pixel), &width);
            now = Progress(OVERFULL, bitcast<u32>(width), position, fallback);
        }
        if outcome != SPENT {
            now.stage = DONE;
            if outcome == FOUND {
                write(pixel, position);
            } else if core < ray.t_max {
                // The core lies inside the surface, so a ray that reaches it has hit; the cubic of
                // some kernels lies below the kernel and has no root there.
                atomicAdd(&lists::pool.core_hits, 1u);
                write(pixel, core);
            } else {
                write_miss(pixel);
            }
        }
    }
    write_work(pixel);
    progress[pixel] = now;
    if before.stage == FRESH && now.stage != DONE {
        report_unfinished();
    } else if before.stage != FRESH && now.stage == DONE {
        report_finished();
    }
}

// Puts the balls before a node of the list back into the arrays, as far as the ray is not past them.
fn restore_arrays(head: u32, end: u32) {
    var node = head;
    while node != end {
        node = restore_ball(node, end);
        node = restore_ball(node, end);
        node = restore_ball(node, end);
        node = restore_ball(node, end);
        budget::spend(1u);
    }
}

fn restore_ball(node: u32, end: u32) -> u32 {
    if node == end {
        return end;
    }
    admit(lists::rank_at(node));
    return lists::after(node);
}

// Follows the ray to its first root or its end.
fn follow(node: ptr<function, u32>) -> u32 {
    // At the limit all is passed, also what exceeded the array's capacity.
    while *node != lists::END && position < limit {
        if !budget::can_continue() {
            return SPENT;
        }
        let rank = lists::rank_at(*node);
        var outcome = pass_up_to(effective_distance(support_of_rank(rank)));
        if outcome == PASSED {
            outcome = free_capacity();
        }
        if outcome != PASSED {
            return outcome;
        }
        admit(rank);
        count_layers(1u);
        budget::spend(1u);
        *node = lists::after(*node);
    }
    // Beyond the last separator there is no ball, and none is recorded beyond the limit.
    return pass_up_to(limit);
}

// Takes in a ball: separators behind the position are passed on the spot, the others recorded.
// Section 4: an eye inside supports starts with the sum of their segments.
fn admit(rank: u32) {
    let support = support_of_rank(rank);
    let segment = segment_of(support.center, support.radius, direction);
    let start = segment.middle - segment.half;
    let end = segment.middle + segment.half;
    if segment.half == 0.0 || end <= position {
        return;
    }
    var first = records::ENTER;
    if start <= position {
        piece::pass_separator(rank, records::ENTER, direction);
        first = records::MIDDLE;
    }
    if segment.middle <= position {
        piece::pass_separator(rank, records::MIDDLE, direction);
        first = records::LEAVE;
    }
    records::insert(rank, min(vec3(start, segment.middle, end), vec3(limit)), first);
}

// Passes all separators up to a distance.
fn pass_up_to(safe: f32) -> u32 {
    while records::count > 0u && records::nearest() <= safe {
        if !budget::can_continue() {
            return SPENT;
        }
        if pass_nearest() {
            return FOUND;
        }
    }
    return PASSED;
}

// Section 6: where too many supports overlap for the array, separators are passed although a ball yet
// to come may begin before them.
fn free_capacity() -> u32 {
    while !records::has_capacity() {
        if overlap::can_search() {
            return NO_CAPACITY;
        }
        if !budget::can_continue() {
            return SPENT;
        }
        fallback = hit::FALLBACK;
        if pass_nearest() {
            return FOUND;
        }
    }
    return PASSED;
}

// Searches the rest of the ray without the array.
fn search_without_array(head: u32, width: ptr<function, f32>) -> u32 {
    var reached = position;
    let root = overlap::search_without_array(head, direction, limit, &reached, width);
    let is_found = root >= 0.0;
    position = select(reached, root, is_found);
    if is_found {
        return FOUND;
    }
    return select(SPENT, PASSED, position >= limit);
}

// Searches the piece before the nearest separator, and passes it when there is no root.
fn pass_nearest() -> bool {
    let record = records::take();
    if record.at > position && search(record.at) {
        return true;
    }
    piece::pass_separator(records::rank_of(record), records::kind_of(record), direction);
    budget::spend(1u);
    return false;
}

// Searches from the position to a point, and moves it to the root or the point.
fn search(end: f32) -> bool {
    let root = piece::first_root(position, end);
    let is_found = root >= 0.0;
    position = select(end, root, is_found);
    return is_found;
}

// Writes the hit at t, with normal and colour from the exact kernels.
fn write(pixel: u32, t: f32) {
    var slope = vec3(0.0);
    blend_start();
    var node = lists::head_of(pixel);
    while node != lists::END {
        node = add_ball(node, t, &slope);
        node = add_ball(node, t, &slope);
        node = add_ball(node, t, &slope);
        node = add_ball(node, t, &slope);
    }
    blend_write(pixel);
    let normal = outward_normal(slope, direction);
    hit::write_hit(pixel, t, normal, select(hit::INSIDE, hit::HIT, t > 0.0) + fallback);
}

// Adds what a ball of the list gives to slope and colour at t. Returns the next node; END behind the
// last ball that reaches t.
fn add_ball(node: u32, t: f32, slope: ptr<function, vec3<f32>>) -> u32 {
    if node == lists::END {
        return lists::END;
    }
    let rank = lists::rank_at(node);
    let support = support_of_rank(rank);
    if effective_distance(support) > t {
        return lists::END;
    }
    let ball = ball_of_rank[rank];
    let offset = offset_at(view.eye - support.center, direction, t);
    let v = depth_below_rim(offset, support.radius);
    *slope += gradient(ball, v, offset, support.radius);
    blend_add(ball, contribution(ball, v));
    return lists::after(node);
}

fn write_miss(pixel: u32) {
    hit::write_miss(pixel);
    hit::hits[pixel].status += fallback;
}
