// Rays between two dispatches: one that has spent its budget is stored, and the next dispatch resumes it. A
// frame whose pool was too small, or that ends with rays suspended, reports itself unfinished.

#import core::status::{report_finished, report_needed, report_unfinished}
#import fbvh::leaf::Search
#import fbvh::structure::EMPTY

// Twin: Suspended of crates/fbvh/src/gpu/suspended.rs.
struct Suspended {
    pixel: u32,
    // The node or leaf to resume at; EMPTY once the ray is finished.
    reference: u32,
    // The search of that leaf.
    search: Search,
    // The best hit so far.
    best_t: f32,
    best_leaf: u32,
    best_status: u32,
}

// Twin of its head: PoolHead of crates/fbvh/src/gpu/suspended.rs.
struct Pool {
    // Workgroups of the next dispatch, 64 rays each.
    groups: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    waiting: atomic<u32>,
    slots: array<Suspended>,
}

@group(2) @binding(3) var<storage, read_write> pool: Pool;

// In the first dispatch. Where the pool is full the frame stays unfinished, and reports how large the
// pool would have to be.
fn suspend_first(state: Suspended) {
    report_unfinished();
    let slot = atomicAdd(&pool.waiting, 1u);
    report_needed(0u, slot + 1u);
    if slot < arrayLength(&pool.slots) {
        pool.slots[slot] = state;
        atomicMax(&pool.groups, slot / 64u + 1u);
    }
}

// How many rays of the frame were suspended, stored or not.
fn waiting() -> u32 {
    return atomicLoad(&pool.waiting);
}

fn suspend_again(slot: u32, state: Suspended) {
    pool.slots[slot] = state;
}

fn finish(slot: u32) {
    pool.slots[slot].reference = EMPTY;
    report_finished();
}
