// Iterations that one invocation must not exceed.
//
// Software Vulkan silently ends the loops of the eight invocations that it runs side by side after 65,535
// iterations in all, and a driver has its watchdog. A dense leaf needs more, the more so where the eight
// diverge and each waits for the others. So every loop counts, and before the budget would be exceeded the
// ray is suspended (fbvh::suspended).

// Iterations after which a ray is suspended. LONGEST_LIST of crates/fbvh/src/gpu/tree_buffers.rs is 6,600: a
// walk along such a list, by words and bits, takes 6,808. So eight rays, each with such a walk after the
// return to its leaf and a last pass over its stack, take 57,100, and 63,700 with the walk for normals, in
// which they do not diverge.
@id(16) override budget: u32 = 6800u;

// What the return to where a ray was suspended may take: two iterations a level, and more.
const RETURN: u32 = 256u;

var<private> spent: u32;

fn can_continue() -> bool {
    return spent < budget;
}

// Whether a walk of so many iterations may begin. Right after the return it may, so that each dispatch
// brings every ray further.
fn can_walk(iterations: u32) -> bool {
    return spent + iterations <= budget || spent <= RETURN;
}
