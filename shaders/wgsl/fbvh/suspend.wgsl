// Work that one invocation must not exceed, and where a ray waits for the next dispatch.
//
// Software Vulkan ends an invocation's loops, silently, after 65,535 iterations in all, and a real
// driver has its watchdog. A dense leaf asks for more. So every loop counts; past `budget` the ray
// writes down where it stands and the next dispatch takes it up there. A ray that finds no place
// to wait, or is still waiting after the last dispatch, leaves the frame unfinished, which it says.
#define_import_path metaball::fbvh::suspend

#import metaball::fbvh::structure::EMPTY
#import metaball::status::{report_finished, report_needed, report_unfinished}

// Iterations after which a ray waits. A walk along a leaf's list may still follow, and another for
// the normal: LONGEST_LIST of crates/fbvh/src/gpu/device_tree.rs bounds them.
@id(16) override budget: u32 = 32768u;

// A ray between two dispatches. Twin: Suspended of crates/fbvh/src/gpu/layout.rs.
struct Suspended {
    pixel: u32,
    // The node or leaf to go on with; EMPTY once the ray is finished.
    place: u32,
    // The search of that leaf, see leaf.wgsl.
    stage: u32,
    next: u32,
    low: f32,
    low_value: f32,
    high: f32,
    high_value: f32,
    iterations: u32,
    // The best hit so far.
    best_t: f32,
    best_leaf: u32,
    best_status: u32,
}

struct Pool {
    // Workgroups of the next dispatch, 64 rays each.
    groups: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    waiting: atomic<u32>,
    slots: array<Suspended>,
}

@group(2) @binding(3) var<storage, read_write> pool: Pool;

var<private> spent: u32;

fn can_go_on() -> bool {
    return spent < budget;
}

// A ray of the first dispatch waits. Where the pool is full the frame is unfinished for good, and
// says how large the pool would have to be.
fn suspend_first(state: Suspended) {
    report_unfinished();
    let slot = atomicAdd(&pool.waiting, 1u);
    report_needed(0u, slot + 1u);
    if slot < arrayLength(&pool.slots) {
        pool.slots[slot] = state;
        atomicMax(&pool.groups, slot / 64u + 1u);
    }
}

// How many rays of the frame had to wait, with or without a place.
fn waiting() -> u32 {
    return atomicLoad(&pool.waiting);
}

fn suspend_again(slot: u32, state: Suspended) {
    pool.slots[slot] = state;
}

fn finish(slot: u32) {
    pool.slots[slot].place = EMPTY;
    report_finished();
}
