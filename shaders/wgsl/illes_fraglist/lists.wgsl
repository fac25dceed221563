// Each pixel's list of the balls that its ray meets: linked nodes in one pool (section 5, gathering).

#import core::status::{report_needed, report_unfinished}

// A node of a list. Twin: Node of crates/illes-fraglist/src/lists.rs.
struct Node {
    rank: u32,
    // Reference to the next node.
    next: u32,
}

// Twin of its head: PoolHead of crates/illes-fraglist/src/lists.rs; zeros when the frame begins.
struct Pool {
    // Nodes requested, also beyond the capacity.
    requested: atomic<u32>,
    // Pixels whose ray reached a core before a root, so that the core counts as the hit.
    core_hits: atomic<u32>,
    nodes: array<Node>,
}

// References to nodes count from 1, so that a cleared buffer is a picture of empty lists.
const END: u32 = 0u;

// Reference to the first node of each pixel's list.
@group(3) @binding(0) var<storage, read_write> heads: array<atomic<u32>>;
@group(3) @binding(1) var<storage, read_write> pool: Pool;
// Distance along each pixel's ray to the nearest core; NO_LIMIT where there is none.
@group(3) @binding(2) var core_distance: texture_2d<f32>;

// Puts a rank before a pixel's list. Where the pool is full the frame is unfinished, and reports how large
// the pool would have to be.
fn prepend(pixel: u32, rank: u32) {
    let index = atomicAdd(&pool.requested, 1u);
    if index >= arrayLength(&pool.nodes) {
        report_unfinished();
        report_needed(0u, index + 1u);
        return;
    }
    let next = atomicExchange(&heads[pixel], index + 1u);
    pool.nodes[index] = Node(rank, next);
}

fn head_of(pixel: u32) -> u32 {
    return atomicLoad(&heads[pixel]);
}

fn node_at(node: u32) -> Node {
    return pool.nodes[node - 1u];
}

fn rank_at(node: u32) -> u32 {
    return pool.nodes[node - 1u].rank;
}

fn after(node: u32) -> u32 {
    return pool.nodes[node - 1u].next;
}

// The next node; END after END.
fn after_or_end(node: u32) -> u32 {
    if node == END {
        return END;
    }
    return after(node);
}

fn link(pixel: u32, node: u32, next: u32) {
    if node == END {
        atomicStore(&heads[pixel], next);
    } else {
        pool.nodes[node - 1u].next = next;
    }
}

fn core_distance_at(position: vec2<u32>) -> f32 {
    return textureLoad(core_distance, position, 0).x;
}
