// Work that one invocation must not exceed. Software Vulkan ends an invocation's loops, silently,
// after 65,535 iterations in all; so loops are counted, and past the budget a ray waits for the next
// dispatch.
#define_import_path metaball::illes_fraglist::budget

// Iterations after which a ray waits. At most 20,000 follow: one piece's root, a walk along a list of
// LONGEST_LIST nodes for the normal, and before them, with the first dispatch, one pass of order.wgsl.
@id(48) override budget: u32 = 32768u;

// Nodes of a list that an invocation can walk along three times besides its budget.
const LONGEST_LIST: u32 = 8192u;

var<private> spent: u32;

fn spend(iterations: u32) {
    spent += iterations;
}

fn can_go_on() -> bool {
    return spent < budget;
}
