// How a frame reports that it is incomplete.

// Twin of `FrameStatus` in metaball-core; zeros when the frame begins.
struct Status {
    // Rays or pixels without a final answer; 0: the frame is complete.
    unfinished: atomic<u32>,
    // Largest capacity that was needed; the method defines the slots.
    needed: array<atomic<u32>, 4>,
}

@group(0) @binding(3) var<storage, read_write> status: Status;

// One more ray or pixel has no final answer.
fn report_unfinished() {
    atomicAdd(&status.unfinished, 1u);
}

// A ray or pixel reported as unfinished has its answer after all, by a later pass of the frame.
fn report_finished() {
    atomicSub(&status.unfinished, 1u);
}

// A pool, list or pass limit would have had to be at least this large.
fn report_needed(slot: u32, amount: u32) {
    atomicMax(&status.needed[slot], amount);
}
