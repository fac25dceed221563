// Casts each ray along its list (section 6): separators go into a short ordered array, and up to the
// nearest point that a ball still in the list can reach, the safe zone, they are passed one by one,
// with the piece of the field between two of them searched for its first root.

#import color::{blend_add, blend_start, blend_write}
#import core::field::{contribution, depth_below_rim, gradient, offset_at, outward_normal}
#import core::hit
#import core::ray_list::{index_in_list, Listed}
#import core::scene::Support
#import core::status::{report_finished, report_needed, report_unfinished}
#import core::view::{rays, view}
#import illes_fraglist::balls::{ball_of_rank, effective_distance, segment_of, support_of_rank}
#import illes_fraglist::budget
#import illes_fraglist::lists
#import illes_fraglist::order
#import illes_fraglist::overlap
#import illes_fraglist::piece
#import illes_fraglist::records
#import illes_fraglist::waiting::{progress, wait, Progress, FRESH, ORDERED, OVERFULL, UNORDERED}
#import work::{count_layers, write_work}

// What its piece keeps of each ray that waits, one a pixel.
@group(3) @binding(9) var<storage, read_write> sums: array<vec4<f32>>;
// The rays that waited for this dispatch.
@group(3) @binding(7) var<storage, read> listed: Listed;

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

@compute @workgroup_size(64)
fn cast_rays(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let at = index_in_list(group, index);
    if at >= listed.count {
        return;
    }
    let pixel = listed.pixels[at];
    let before = progress[pixel];
    var now = before;
    if now.stage == FRESH {
        let found = order::order_of(pixel);
        if found == order::TOO_LONG {
            report_unfinished();
            report_needed(1u, budget::LIST_CAPACITY + 1u);
            return;
        }
        now = at_first_node(pixel, select(UNORDERED, ORDERED, found == order::IN_ORDER));
    }
    if now.stage == UNORDERED && order::restore_order(pixel) {
        now = at_first_node(pixel, ORDERED);
    }
    var is_answered = false;
    if now.stage != UNORDERED {
        var kept = vec4(0.0);
        if before.stage == ORDERED {
            kept = sums[pixel];
        }
        is_answered = cast_ray(pixel, &now, kept);
    }
    write_work(pixel);
    if !is_answered {
        sums[pixel] = piece::kept_sum();
        wait(pixel, now);
    }
    if before.stage == FRESH && !is_answered {
        report_unfinished();
    } else if before.stage != FRESH && is_answered {
        report_finished();
    }
}

fn at_first_node(pixel: u32, stage: u32) -> Progress {
    return Progress(stage, lists::head_of(pixel), 0.0, 0u);
}

// Follows a ray from where it is, and writes its answer. Returns whether there is one.
fn cast_ray(pixel: u32, now: ptr<function, Progress>, kept: vec4<f32>) -> bool {
    let ray = rays[pixel];
    direction = ray.direction;
    let core = lists::core_distance_at(vec2(pixel % view.width, pixel / view.width));
    limit = min(core, ray.t_max);
    position = (*now).position;
    fallback = (*now).fallback;
    var outcome = NO_CAPACITY;
    var width = 0.0;
    if (*now).stage == ORDERED {
        var node = (*now).node;
        restore_arrays(lists::head_of(pixel), node);
        piece::restore_sum(kept);
        budget::begin();
        outcome = follow(&node);
        *now = Progress(ORDERED, node, position, fallback);
    } else {
        width = bitcast<f32>((*now).node);
    }
    if outcome == NO_CAPACITY {
        outcome = search_without_array(lists::head_of(pixel), &width);
        *now = Progress(OVERFULL, bitcast<u32>(width), position, fallback);
    }
    if outcome == FOUND {
        write(pixel, position);
    } else if outcome == PASSED && core < ray.t_max {
        // The core lies inside the surface, so a ray that reaches it has hit; the cubic of
        // some kernels lies below the kernel and has no root there.
        atomicAdd(&lists::pool.core_hits, 1u);
        write(pixel, core);
    } else if outcome == PASSED {
        write_miss(pixel);
    }
    return outcome != SPENT;
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
    let restored = lists::node_at(node);
    admit(restored.rank, support_of_rank(restored.rank));
    return restored.next;
}

// Follows the ray to its first root or its end.
fn follow(node: ptr<function, u32>) -> u32 {
    // At the limit all is passed, also what exceeded the array's capacity.
    while *node != lists::END && position < limit {
        if must_wait() {
            return SPENT;
        }
        let next = lists::node_at(*node);
        let support = support_of_rank(next.rank);
        var outcome = pass_up_to(effective_distance(support));
        if outcome == PASSED {
            outcome = free_capacity();
        }
        if outcome != PASSED {
            return outcome;
        }
        admit(next.rank, support);
        count_layers(1u);
        budget::spend(1u);
        *node = next.next;
    }
    // Beyond the last separator there is no ball, and none is recorded beyond the limit.
    return pass_up_to(limit);
}

// Whether the budget is spent, where the ray can wait.
fn must_wait() -> bool {
    return !budget::can_continue()
        && (records::count == 0u || piece::can_wait_before(records::nearest(), position));
}

// Takes in a ball: separators behind the position are passed on the spot, the others recorded.
// Section 4: an eye inside supports starts with the sum of their segments.
fn admit(rank: u32, support: Support) {
    let segment = segment_of(support.center, support.radius, direction);
    let start = segment.middle - segment.half;
    let end = segment.middle + segment.half;
    if segment.half == 0.0 || end <= position {
        return;
    }
    let changes = piece::changes_of(rank, segment, support.radius);
    let has_entered = start <= position;
    let has_turned = segment.middle <= position;
    if has_entered {
        piece::pass_separator(changes.enter, direction);
    }
    if has_turned {
        piece::pass_separator(changes.middle, direction);
    }
    records::make_room(3u - u32(has_entered) - u32(has_turned));
    if !has_entered {
        records::insert(min(start, limit), changes.enter);
    }
    if !has_turned {
        records::insert(min(segment.middle, limit), changes.middle);
    }
    records::insert(min(end, limit), changes.leave);
}

// Passes all separators up to a distance.
fn pass_up_to(safe: f32) -> u32 {
    while records::count > 0u && records::nearest() <= safe {
        if must_wait() {
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
        if must_wait() {
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
    let at = records::nearest();
    if at > position && search(at) {
        return true;
    }
    piece::pass_separator(records::take(), direction);
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
