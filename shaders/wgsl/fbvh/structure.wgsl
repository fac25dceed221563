// The trees of the crate `fbvh` as the device sees them: children's boxes in the parent, leaves with
// lists of balls. Twins: Node and Leaf of crates/fbvh/src/node.rs.

#import core::ray::Ray

struct Node {
    left_min: vec3<f32>,
    // References to children: the index of a node, or LEAF with the index of a leaf.
    left: u32,
    left_max: vec3<f32>,
    right: u32,
    right_min: vec3<f32>,
    // Split axis, 0 to 2.
    axis: u32,
    right_max: vec3<f32>,
    // The leftmost leaf below `right`.
    first_right_leaf: u32,
}

struct Leaf {
    min: vec3<f32>,
    // First entry of `lists`; the next leaf's is one past the last.
    first: u32,
    max: vec3<f32>,
    // How many entries are the leaf's own balls; the split balls follow.
    own: u32,
}

const LEAF: u32 = 0x80000000u;
// The reference to nothing.
const EMPTY: u32 = 0xffffffffu;

@group(2) @binding(0) var<storage, read> nodes: array<Node>;
@group(2) @binding(1) var<storage, read> leaves: array<Leaf>;
@group(2) @binding(2) var<storage, read> lists: array<u32>;

// An interval of a ray; empty where it leaves before it enters.
struct Interval {
    enter: f32,
    leave: f32,
}

fn is_empty(interval: Interval) -> bool {
    return interval.enter > interval.leave;
}

// One over a direction, with directions along an axis kept finite: a coordinate below 1e-18 moves no
// point by a float over any length that fits.
fn inverse(direction: vec3<f32>) -> vec3<f32> {
    let tiny = select(vec3(-1e-18), vec3(1e-18), direction >= vec3(0.0));
    return 1.0 / select(direction, tiny, abs(direction) < vec3(1e-18));
}

// The part of the ray in a box. The far end is widened by twice the three roundings of its computation
// (Ize 2013), so that no box is missed at its faces.
fn through_box(low: vec3<f32>, high: vec3<f32>, ray: Ray, inverse: vec3<f32>) -> Interval {
    let to_low = (low - ray.origin) * inverse;
    let to_high = (high - ray.origin) * inverse;
    let near = min(to_low, to_high);
    let far = max(to_low, to_high) * 1.0000008;
    return Interval(
        max(max(near.x, near.y), max(near.z, 0.0)),
        min(min(far.x, far.y), min(far.z, ray.t_max)),
    );
}

// The two children of a node in the order in which the ray visits them. `far` is EMPTY where the ray
// meets at most one, `near` where it meets none. The order depends on the ray and the boxes alone,
// so that a traversal that is resumed finds it as it was.
struct Children {
    near: u32,
    far: u32,
    near_enter: f32,
    far_enter: f32,
}

// Boxes on either side of a plane are visited by the side from which the ray comes, which no rounding
// can mistake; boxes that overlap, in the order in which the ray enters them.
fn children_along(node: Node, ray: Ray, inverse: vec3<f32>, parted: bool) -> Children {
    let left = through_box(node.left_min, node.left_max, ray, inverse);
    let right = through_box(node.right_min, node.right_max, ray, inverse);
    let left_ref = select(node.left, EMPTY, is_empty(left));
    let right_ref = select(node.right, EMPTY, is_empty(right));
    let right_before = select(right.enter < left.enter, ray.direction[node.axis] < 0.0, parted);
    if left_ref == EMPTY || (right_ref != EMPTY && right_before) {
        return Children(right_ref, left_ref, right.enter, left.enter);
    }
    return Children(left_ref, right_ref, left.enter, right.enter);
}

// Whether a node or leaf lies below the left child. Nodes are in depth-first order, leaves in the
// same order from left to right.
fn is_below_left(node: Node, reference: u32) -> bool {
    if (reference & LEAF) != 0u {
        return (reference & ~LEAF) < node.first_right_leaf;
    }
    return (node.right & LEAF) != 0u || reference < node.right;
}
