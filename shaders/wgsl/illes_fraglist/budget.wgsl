// Iterations that one invocation must not exceed. Software Vulkan runs eight invocations side by side and
// silently ends their loops after 65,535 iterations in all: as many as the longest of them takes where they
// do not diverge, and up to the sum where they do. So loops are counted, and past the budget a ray waits for
// the next dispatch.

// Walks along lists take four nodes an iteration, since iterations are what is scarce. All rays walk
// together once to see their order or to restore their arrays, and once for the normal: 3,072 iterations with
// lists of LIST_CAPACITY nodes. To restore them, an invocation may fill the arrays, 4,656 iterations. Beyond
// its budget it may continue for one pass of illes_fraglist::order, two walks, or for one walk along an
// interval and the root of one piece, some 1,500; with a running sum for a root and all separators at one
// point, 136. So it takes 7,706 at most, and eight that diverge throughout 64,720.
const LIST_CAPACITY: u32 = 6144u;

// Iterations after which a ray waits, from where its arrays were restored.
@id(48) override budget: u32 = 1350u;

var<private> spent: u32;

fn spend(iterations: u32) {
    spent += iterations;
}

// What was spent to return to where the ray waited is not counted, so that each dispatch brings it further.
fn begin() {
    spent = 0u;
}

fn can_continue() -> bool {
    return spent < budget;
}
