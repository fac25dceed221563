// Work that one invocation must not exceed. Software Vulkan ends an invocation's loops, silently,
// after 65,535 iterations in all; so loops are counted, and past the budget a ray waits for the next
// dispatch.
#define_import_path metaball::illes_fraglist::budget

// Walks along lists take four nodes an iteration, since iterations are what is scarce. Besides its
// budget an invocation may walk along a list of LONGEST_LIST nodes, at a quarter of an iteration each:
// with the first dispatch once to count and twice in a last pass of order.wgsl; later once to recall
// where it was, once along a stretch, and once for the normal. Either is at most 36,864 iterations, and
// one piece's root at most 4,000 more.
const LONGEST_LIST: u32 = 49152u;

// Iterations after which a ray waits.
@id(48) override budget: u32 = 16384u;

var<private> spent: u32;

fn spend(iterations: u32) {
    spent += iterations;
}

fn can_go_on() -> bool {
    return spent < budget;
}

// Whether the budget lasts for so many more.
fn has_room_for(iterations: u32) -> bool {
    return spent + iterations < budget;
}
