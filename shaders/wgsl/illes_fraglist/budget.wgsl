// Work that one invocation must not exceed. Software Vulkan runs eight invocations side by side and ends
// their loops, silently, after 65,535 iterations in all: as many as the longest of them takes where they go
// the same way, and up to the sum where they do not. So loops are counted, and past the budget a ray
// waits for the next dispatch.

// Walks along lists take four nodes an iteration, since iterations are what is scarce. All rays walk
// together once to count or to recall where they were, and once for the normal: 3,072 iterations with lists of
// LONGEST_LIST nodes. To recall, an invocation may fill the arrays, 4,656 iterations. Beyond its budget it may
// go on for one pass of order.wgsl, two walks, or for one walk along a stretch and the root of one piece, some
// 1,500. So it takes 7,706 at most, and eight that are out of step throughout 64,720.
const LONGEST_LIST: u32 = 6144u;

// Iterations after which a ray waits, from where it was recalled.
@id(48) override budget: u32 = 1350u;

var<private> spent: u32;

fn spend(iterations: u32) {
    spent += iterations;
}

// What was spent to come to where the ray was left is not counted: each dispatch gets on.
fn begin() {
    spent = 0u;
}

fn can_go_on() -> bool {
    return spent < budget;
}
