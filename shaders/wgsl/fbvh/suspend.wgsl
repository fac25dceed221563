// Work that one invocation must not exceed, and where a ray waits for the next dispatch.
//
// Software Vulkan ends loops, silently, after 65,535 iterations in all of the eight invocations that it
// runs side by side, and a real driver has its watchdog. A dense leaf asks for more, the more so where
// the eight go different ways and each waits for the others. So every loop counts; before `budget` would
// be exceeded the ray writes down where it stands and the next dispatch takes it up there. A ray that
// finds no place to wait, or is still waiting after the last dispatch, leaves the frame unfinished, which
// it says.

#import fbvh::structure::EMPTY
#import core::status::{report_finished, report_needed, report_unfinished}

// Iterations after which a ray waits. LONGEST_LIST of crates/fbvh/src/gpu/tree_buffers.rs is 6,600: a walk
// along such a list, by words and bits, takes 6,808. So eight rays, each with such a walk after its way
// back and a last look at its stack, come to 57,100, and to 63,700 with the walk for normals, which they do
// together.
@id(16) override budget: u32 = 6800u;

// What it may take to get back to where a ray waited: two iterations a level, and more.
const WAY_BACK: u32 = 256u;

// A ray between two dispatches. Twin: Suspended of crates/fbvh/src/gpu/suspended.rs.
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

// Whether a walk of so many iterations may begin. Right after the way back it may, so that each dispatch
// gets on with every ray.
fn can_walk(iterations: u32) -> bool {
    return spent + iterations <= budget || spent <= WAY_BACK;
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
