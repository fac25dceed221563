// Traces rays through a tree: the modified BVH or the Fitted BVH of Gourmel et al. 2010, or the certified
// tree. `trace` starts every ray, `resume` continues those that were suspended.

#import color::{blend_add, blend_start, blend_write}
#import core::field::{contribution, depth_below_rim, gradient, offset_at, outward_normal}
#import core::hit
#import core::ray::{Ray, NO_PIXEL}
#import fbvh::budget
#import fbvh::leaf
#import fbvh::leaf_outcome
#import fbvh::structure
#import fbvh::suspended
#import kernel::kernel_slope
#import ray::{any_hit_suffices, needs_clearance, pixel_of, ray_of}
#import strength::strength
#import support::support_of
#import work::{come_back_to, count_node, go_down, leave_for_later, write_work}

// The tree's root: a node, a leaf, or EMPTY.
@id(21) override root: u32 = 0xffffffffu;

// Depth is bounded when a tree is built. Twin: MAX_DEPTH of crates/fbvh/src/node.rs.
const MAX_DEPTH: u32 = 64u;

// Subtrees still to be visited; and where the ray enters them, unless the first hit ends it: until then nothing
// is nearer.
var<private> stack: array<u32, MAX_DEPTH>;
var<private> enters: array<f32, MAX_DEPTH>;
var<private> depth: u32;

// The nearest hit so far. Where there is none, `best_status` is MISS, or UNDECIDED if a leaf was UNCERTAIN,
// and `best_t` the ray's end; but on the search for an exit, once a leaf had it AT_FACE, where that is: a leaf
// that the ray enters behind it cannot be the one that begins there.
var<private> best_t: f32;
var<private> best_leaf: u32;
var<private> best_status: u32;

fn push(reference: u32, enter: f32) {
    stack[depth] = reference;
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
        budget::spent++;
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

// Walks from the root to where the ray was suspended, and pushes what was left to visit after it.
fn descend(reference: u32, ray: Ray, inverse: vec3<f32>) {
    var current = root;
    while current != reference {
        budget::spent++;
        go_down();
        let node = structure::nodes[current];
        let children = children_of(node, ray, inverse);
        current = select(node.right, node.left, structure::is_below_left(node, reference));
        if current == children.near && children.far != structure::EMPTY {
            push(children.far, children.far_enter);
        }
    }
}

// The part of the ray in a leaf.
fn interval_in(index: u32, ray: Ray, inverse: vec3<f32>) -> structure::Interval {
    let box = structure::leaves[index];
    return structure::through_box(box.min, box.max, ray, inverse);
}

// Visits nodes and leaves from `start` on until the ray is done. Returns where to resume; EMPTY when the ray
// is finished.
fn traverse(start: u32, ray: Ray, inverse: vec3<f32>) -> u32 {
    var reference = start;
    loop {
        // To the next leaf: rays side by side reach theirs before any of them searches it.
        loop {
            if (reference & structure::LEAF) == 0u {
                if !budget::can_continue() {
                    return reference;
                }
                budget::spent++;
                count_node();
                go_down();
                let node = structure::nodes[reference];
                let children = children_of(node, ray, inverse);
                if children.far != structure::EMPTY && children.far_enter < best_t {
                    push(children.far, children.far_enter);
                }
                reference = children.near;
                if reference == structure::EMPTY || children.near_enter >= best_t {
                    reference = pop();
                }
            }
            if (reference & structure::LEAF) != 0u {
                break;
            }
        }
        if reference == structure::EMPTY || !budget::can_continue() {
            break;
        }
        budget::spent++;
        let index = reference & ~structure::LEAF;
        if leaf::seeks_exit() && interval_in(index, ray, inverse).enter >= best_t {
            reference = pop();
            continue;
        }
        let outcome = leaf::search_leaf(ray, inverse, index);
        if outcome == leaf_outcome::WAITING {
            return reference;
        }
        // A leaf that continues behind the face of another decides what that left open.
        if leaf::seeks_exit() && outcome != leaf_outcome::UNMET
            && interval_in(index, ray, inverse).leave > best_t {
            best_t = ray.t_max;
        }
        if outcome == leaf_outcome::AT_FACE {
            best_t = leaf::hit_t();
            best_leaf = index;
        }
        if outcome == leaf_outcome::BRACKETED {
            best_leaf = index;
            return structure::EMPTY;
        }
        // Where any hit suffices, it may be at the very end of the ray.
        if outcome == leaf_outcome::FOUND && (leaf::hit_t() < best_t || any_hit_suffices()) {
            best_t = min(leaf::hit_t(), best_t);
            best_leaf = index;
            best_status = leaf::hit_status();
            if leaf::first_hit_ends() || any_hit_suffices() {
                return structure::EMPTY;
            }
        }
        if outcome == leaf_outcome::UNCERTAIN {
            best_status = hit::UNDECIDED;
        }
        leaf::reset();
        reference = pop();
        if reference == structure::EMPTY {
            break;
        }
    }
    return reference;
}

// Follows the ray from `start` to its answer. Returns where to resume; EMPTY when it is finished.
fn follow(start: u32, ray: Ray, inverse: vec3<f32>) -> u32 {
    let reference = traverse(start, ray, inverse);
    if reference != structure::EMPTY {
        return reference;
    }
    if exits_at_face(ray) && !leaf::bracket_exit(ray, inverse, best_leaf) {
        return structure::LEAF | best_leaf;
    }
    if !leaf::is_bracketed() {
        return structure::EMPTY;
    }
    if leaf::close_in(ray, inverse, best_leaf) == leaf_outcome::WAITING {
        return structure::LEAF | best_leaf;
    }
    if leaf::hit_t() < best_t {
        best_t = leaf::hit_t();
        best_status = leaf::hit_status();
    }
    return structure::EMPTY;
}

// Whether the ray has left the solid at the far face of a leaf: no other begins there.
fn exits_at_face(ray: Ray) -> bool {
    return leaf::seeks_exit() && !leaf::is_bracketed() && best_status == hit::MISS && best_t < ray.t_max;
}

// Whether a point is in the box of a leaf, faces included. Where it is in none, the field is below T.
fn is_in_leaf(point: vec3<f32>) -> bool {
    var reference = root;
    while reference != structure::EMPTY {
        budget::spent++;
        if (reference & structure::LEAF) != 0u {
            let box = structure::leaves[reference & ~structure::LEAF];
            if is_between(point, box.min, box.max) {
                depth = 0u;
                return true;
            }
            reference = structure::EMPTY;
        } else {
            let node = structure::nodes[reference];
            let is_left = is_between(point, node.left_min, node.left_max);
            let is_right = is_between(point, node.right_min, node.right_max);
            if is_left && is_right {
                stack[depth] = node.right;
                depth++;
            }
            reference = select(select(structure::EMPTY, node.right, is_right), node.left, is_left);
        }
        if reference == structure::EMPTY && depth > 0u {
            depth--;
            reference = stack[depth];
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
    if any_hit_suffices() {
        hit::write_hit(pixel, best_t, -ray.direction, best_status);
        return;
    }
    var slope = vec3(0.0);
    // How far the field at the hit can be from T, and the least radius around.
    var error = leaf::residual();
    var smallest = 1e38;
    blend_start();
    let found = structure::leaves[best_leaf];
    let end = structure::leaves[best_leaf + 1u].first;
    var entry = found.first;
    // A solid leaf has no list.
    if entry < end {
        loop {
            let ball = structure::lists[entry];
            let support = support_of(ball);
            let offset = offset_at(ray.origin - support.center, ray.direction, best_t);
            let v = depth_below_rim(offset, support.radius);
            slope += gradient(ball, v, offset, support.radius);
            blend_add(ball, contribution(ball, v));
            if needs_clearance() && v > 0.0 {
                let moved = leaf::depth_error(found, ray, best_t, offset, support.radius);
                error += strength(ball) * kernel_slope(v) * moved;
                smallest = min(smallest, support.radius);
            }
            entry++;
            if entry >= end {
                break;
            }
        }
    }
    blend_write(pixel);
    let normal = outward_normal(slope, ray.direction);
    if !needs_clearance() {
        hit::write_hit(pixel, best_t, normal, best_status);
        return;
    }
    let clearance = clearance(ray, error, length(slope), smallest);
    hit::write_hit_with_clearance(pixel, best_t, normal, best_status, clearance);
}

// What the start of a secondary ray must keep from the hit, along the normal: derived in
// crates/fbvh/src/trace/clearance.rs.
fn clearance(ray: Ray, error: f32, steepness: f32, smallest: f32) -> f32 {
    let flattest = max(steepness, error / (smallest * 0x1p-10f));
    return 4.0 * error / max(flattest, 1e-37) + rounding_at(ray, best_t);
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
    if pixel == NO_PIXEL {
        return;
    }
    let ray = ray_of(pixel);
    let inverse = structure::inverse(ray.direction);
    // What starts in no leaf starts outside.
    if leaf::seeks_exit() && !is_in_leaf(ray.origin) {
        write_work(pixel);
        hit::write_hit_with_clearance(pixel, 0.0, ray.direction, hit::INSIDE, rounding_at(ray, 0.0));
        return;
    }
    best_t = ray.t_max;
    best_status = hit::MISS;

    let reference = follow(root, ray, inverse);
    write_work(pixel);
    if reference == structure::EMPTY {
        write(pixel, ray);
    } else {
        suspended::suspend_first(state_at(reference, pixel));
    }
}

@compute @workgroup_size(64)
fn resume(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= min(suspended::waiting(), arrayLength(&suspended::pool.slots)) {
        return;
    }
    let state = suspended::pool.slots[id.x];
    if state.reference == structure::EMPTY {
        return;
    }
    let ray = ray_of(state.pixel);
    let inverse = structure::inverse(ray.direction);
    best_t = state.best_t;
    best_leaf = state.best_leaf;
    best_status = state.best_status;
    leaf::search = state.search;

    descend(state.reference, ray, inverse);
    let reference = follow(state.reference, ray, inverse);
    write_work(state.pixel);
    if reference == structure::EMPTY {
        write(state.pixel, ray);
        suspended::finish(id.x);
    } else {
        suspended::suspend_again(id.x, state_at(reference, state.pixel));
    }
}

fn state_at(reference: u32, pixel: u32) -> suspended::Suspended {
    return suspended::Suspended(pixel, reference, leaf::search, best_t, best_leaf, best_status);
}
