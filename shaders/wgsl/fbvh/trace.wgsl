// Traces rays through a tree: the modified BVH or the Fitted BVH of Gourmel et al. 2010, or the certified
// tree. `trace` starts every ray, `resume` goes on with those that had to wait. Where rays come from, and
// what they ask, is chosen by ray/primary.wgsl or ray/free.wgsl.

#import color::{blend_add, blend_start, blend_write}
#import fbvh::leaf
#import fbvh::structure
#import fbvh::suspend
#import core::field::{contribution, depth_below_rim, gradient, offset_at}
#import core::hit
#import kernel::kernel_slope
#import ray::{any_will_do, goes_on, pixel_of, ray_of, Ray, NOBODY}
#import strength::strength
#import support::support_of
#import work::{come_back_to, count_node, go_down, leave_for_later, write_work}

// The tree's root: a node, a leaf, or EMPTY.
@id(21) override root: u32 = 0xffffffffu;

// Depth is bounded when a tree is built: MAX_DEPTH of crates/fbvh/src/node.rs.
const MAX_DEPTH: u32 = 64u;

// Subtrees still to be visited; and where the ray enters them, unless the first hit ends it: until then
// nothing is nearer.
var<private> stack: array<u32, MAX_DEPTH>;
var<private> enters: array<f32, MAX_DEPTH>;
var<private> depth: u32;

// The nearest hit so far. Where there is none, `best_status` is MISS, or UNDECIDED if a leaf had
// doubts, and `best_t` the ray's end; but on the way out, once a leaf is LEAVING, where that is: what the ray
// enters behind it cannot be what lets it stay.
var<private> best_t: f32;
var<private> best_leaf: u32;
var<private> best_status: u32;

fn push(place: u32, enter: f32) {
    stack[depth] = place;
    leave_for_later(depth);
    if !leaf::first_hit_ends() {
        enters[depth] = enter;
    }
    depth++;
}

// The next subtree that could hold a nearer hit, or EMPTY.
fn pop() -> u32 {
    while depth > 0u {
        depth--;
        suspend::spent++;
        if leaf::first_hit_ends() || enters[depth] < best_t {
            come_back_to(depth);
            return stack[depth];
        }
    }
    return structure::EMPTY;
}

fn children_of(node: structure::Node, ray: Ray, inverse: vec3<f32>) -> structure::Children {
    let parted = leaf::first_hit_ends();
    return structure::children_along(node, ray, inverse, parted);
}

// Walks from the root to a place where the ray waited, and pushes what was left to visit after it.
fn descend(place: u32, ray: Ray, inverse: vec3<f32>) {
    var current = root;
    while current != place {
        suspend::spent++;
        go_down();
        let node = structure::nodes[current];
        let children = children_of(node, ray, inverse);
        current = select(node.right, node.left, structure::is_below_left(node, place));
        if current == children.near && children.far != structure::EMPTY {
            push(children.far, children.far_enter);
        }
    }
}

// Where the ray passes through a leaf; asked on the way out alone.
fn passage(index: u32, ray: Ray, inverse: vec3<f32>) -> structure::Stretch {
    let box = structure::leaves[index];
    return structure::through_box(box.min, box.max, ray, inverse);
}

// Visits places from `start` on until the ray is done. Returns the place to wait at, EMPTY when the
// ray is finished.
fn traverse(start: u32, ray: Ray, inverse: vec3<f32>) -> u32 {
    var place = start;
    loop {
        // To the next leaf: rays side by side come to theirs before any of them searches it.
        loop {
            if (place & structure::LEAF) == 0u {
                if !suspend::can_go_on() {
                    return place;
                }
                suspend::spent++;
                count_node();
                go_down();
                let node = structure::nodes[place];
                let children = children_of(node, ray, inverse);
                if children.far != structure::EMPTY && children.far_enter < best_t {
                    push(children.far, children.far_enter);
                }
                place = children.near;
                if place == structure::EMPTY || children.near_enter >= best_t {
                    place = pop();
                }
            }
            if (place & structure::LEAF) != 0u {
                break;
            }
        }
        if place == structure::EMPTY || !suspend::can_go_on() {
            break;
        }
        suspend::spent++;
        let index = place & ~structure::LEAF;
        if leaf::seeks_way_out() && passage(index, ray, inverse).enter >= best_t {
            place = pop();
            continue;
        }
        let outcome = leaf::search_leaf(ray, inverse, index);
        if outcome == leaf::WAITING {
            return place;
        }
        // On the way out, a leaf that goes on behind the end of another tells what that left open.
        if leaf::seeks_way_out() && outcome != leaf::UNMET && passage(index, ray, inverse).leave > best_t {
            best_t = ray.t_max;
        }
        if outcome == leaf::LEAVING {
            best_t = leaf::search.high;
            best_leaf = index;
        }
        if outcome == leaf::BRACKETED {
            best_leaf = index;
            return structure::EMPTY;
        }
        // Where any hit will do, it may have been seen at the very end of the ray.
        if outcome == leaf::FOUND && (leaf::search.high < best_t || any_will_do()) {
            best_t = min(leaf::search.high, best_t);
            best_leaf = index;
            best_status = leaf::status_found();
            if leaf::first_hit_ends() || any_will_do() {
                return structure::EMPTY;
            }
        }
        if outcome == leaf::DOUBTED {
            best_status = hit::UNDECIDED;
        }
        leaf::search.stage = leaf::ENTER;
        place = pop();
        if place == structure::EMPTY {
            break;
        }
    }
    return place;
}

// Follows the ray from `start` to its answer. Returns the place to wait at, EMPTY when it is finished.
fn follow(start: u32, ray: Ray, inverse: vec3<f32>) -> u32 {
    let place = traverse(start, ray, inverse);
    if place != structure::EMPTY {
        return place;
    }
    if is_leaving(ray) && !leaf::take_up_way_out(ray, inverse, best_leaf) {
        return structure::LEAF | best_leaf;
    }
    if !leaf::is_bracketed() {
        return structure::EMPTY;
    }
    if leaf::close_in(ray, inverse, best_leaf) == leaf::WAITING {
        return structure::LEAF | best_leaf;
    }
    if leaf::search.high < best_t {
        best_t = leaf::search.high;
        best_status = leaf::status_found();
    }
    return structure::EMPTY;
}

// Whether the ray has left the solid at the end of a leaf: none begins there.
fn is_leaving(ray: Ray) -> bool {
    return leaf::seeks_way_out() && !leaf::is_bracketed() && best_status == hit::MISS && best_t < ray.t_max;
}

// Whether a point is in the box of a leaf, faces included. Where it is in none, the field is below T.
fn is_in_leaf(point: vec3<f32>) -> bool {
    var place = root;
    while place != structure::EMPTY {
        suspend::spent++;
        if (place & structure::LEAF) != 0u {
            let box = structure::leaves[place & ~structure::LEAF];
            if is_between(point, box.min, box.max) {
                depth = 0u;
                return true;
            }
            place = structure::EMPTY;
        } else {
            let node = structure::nodes[place];
            let is_left = is_between(point, node.left_min, node.left_max);
            let is_right = is_between(point, node.right_min, node.right_max);
            if is_left && is_right {
                stack[depth] = node.right;
                depth++;
            }
            place = select(select(structure::EMPTY, node.right, is_right), node.left, is_left);
        }
        if place == structure::EMPTY && depth > 0u {
            depth--;
            place = stack[depth];
        }
    }
    return false;
}

fn is_between(point: vec3<f32>, low: vec3<f32>, high: vec3<f32>) -> bool {
    return all(low <= point) && all(point <= high);
}

// Writes the hit, with its normal and colour from the list of the leaf that found it.
fn write(pixel: u32, ray: Ray) {
    if best_status == hit::MISS {
        hit::write_miss(pixel);
        return;
    }
    if best_status == hit::UNDECIDED && best_t == ray.t_max {
        hit::write_hit(pixel, 0.0, -ray.direction, hit::UNDECIDED);
        return;
    }
    if any_will_do() {
        hit::write_hit(pixel, best_t, -ray.direction, best_status);
        return;
    }
    var slope = vec3(0.0);
    // How far the field at the hit can be from T, and the least radius around.
    var doubt = leaf::residual();
    var smallest = 1e38;
    blend_start();
    let found = structure::leaves[best_leaf];
    let end = structure::leaves[best_leaf + 1u].first;
    var entry = found.first;
    loop {
        let ball = structure::lists[entry];
        let support = support_of(ball);
        let offset = offset_at(ray.origin - support.center, ray.direction, best_t);
        let v = depth_below_rim(offset, support.radius);
        slope += gradient(ball, v, offset, support.radius);
        blend_add(ball, contribution(ball, v));
        if goes_on() && v > 0.0 {
            let moved = leaf::depth_error(found, ray, best_t, offset, support.radius);
            doubt += strength(ball) * kernel_slope(v) * moved;
            smallest = min(smallest, support.radius);
        }
        entry++;
        if entry >= end {
            break;
        }
    }
    blend_write(pixel);
    // Where the field is flat, as at a lone centre, the surface faces the ray.
    let steepness = length(slope);
    let normal = select(-ray.direction, -slope / steepness, steepness > 0.0);
    if !goes_on() {
        hit::write_hit(pixel, best_t, normal, best_status);
        return;
    }
    let clearance = clearance(ray, doubt, steepness, smallest);
    hit::write_hit_with_clearance(pixel, best_t, normal, best_status, clearance);
}

// What a start beside the hit must keep from it, along the normal: see "Secondary rays" in
// crates/fbvh/src/gpu/mod.rs.
fn clearance(ray: Ray, doubt: f32, steepness: f32, smallest: f32) -> f32 {
    let flattest = max(steepness, doubt / (smallest * 0x1p-10f));
    return 4.0 * doubt / max(flattest, 1e-37) + rounding_at(ray, best_t);
}

// Four times what rounding may do to the point of a ray at t.
fn rounding_at(ray: Ray, t: f32) -> f32 {
    let end = ray.origin + t * ray.direction;
    return 4.0 * 0x1p-23f * (length(ray.origin) + 2.0 * t + length(end));
}

@compute @workgroup_size(8, 8)
fn trace(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let pixel = pixel_of(group, index);
    if pixel == NOBODY {
        return;
    }
    let ray = ray_of(pixel);
    let inverse = structure::inverse(ray.direction);
    // What starts in no leaf starts outside: it has found the way out.
    if leaf::seeks_way_out() && !is_in_leaf(ray.origin) {
        write_work(pixel);
        hit::write_hit_with_clearance(pixel, 0.0, ray.direction, hit::INSIDE, rounding_at(ray, 0.0));
        return;
    }
    best_t = ray.t_max;
    best_status = hit::MISS;

    let place = follow(root, ray, inverse);
    write_work(pixel);
    if place == structure::EMPTY {
        write(pixel, ray);
    } else {
        suspend::suspend_first(waiting_at(place, pixel));
    }
}

@compute @workgroup_size(64)
fn resume(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= min(suspend::waiting(), arrayLength(&suspend::pool.slots)) {
        return;
    }
    let state = suspend::pool.slots[id.x];
    if state.place == structure::EMPTY {
        return;
    }
    let ray = ray_of(state.pixel);
    let inverse = structure::inverse(ray.direction);
    best_t = state.best_t;
    best_leaf = state.best_leaf;
    best_status = state.best_status;
    leaf::search = leaf::Search(
        state.stage, state.next, state.low, state.low_value, state.high, state.high_value,
        state.iterations,
    );

    descend(state.place, ray, inverse);
    let place = follow(state.place, ray, inverse);
    write_work(state.pixel);
    if place == structure::EMPTY {
        write(state.pixel, ray);
        suspend::finish(id.x);
    } else {
        suspend::suspend_again(id.x, waiting_at(place, state.pixel));
    }
}

fn waiting_at(place: u32, pixel: u32) -> suspend::Suspended {
    return suspend::Suspended(
        pixel, place,
        leaf::search.stage, leaf::search.next, leaf::search.low, leaf::search.low_value,
        leaf::search.high, leaf::search.high_value, leaf::search.iterations,
        best_t, best_leaf, best_status,
    );
}
