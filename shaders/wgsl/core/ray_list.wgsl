// A list of rays, each by its pixel, and the indirect dispatch along it.

// Begins with the workgroups of that dispatch, 64 rays each. Twin of `ListHead` in metaball-core.
struct Listed {
    groups_x: u32,
    groups_y: u32,
    groups_z: u32,
    count: u32,
    pixels: array<u32>,
}

// The same while many write to it; its head is zeros before they do.
struct Listing {
    groups_x: atomic<u32>,
    groups_y: atomic<u32>,
    groups_z: atomic<u32>,
    count: atomic<u32>,
    pixels: array<u32>,
}

// Most workgroups in a row of the dispatch.
const ACROSS: u32 = 32768u;

// The workgroups that so many rays take, by rows: the least that `groups_x`, `groups_y` and `groups_z` must be.
fn groups_along(count: u32) -> vec3<u32> {
    let groups = (count + 63u) / 64u;
    return vec3(min(groups, ACROSS), (groups + ACROSS - 1u) / ACROSS, 1u);
}

// The list's index for an invocation of such a dispatch.
fn index_in_list(group: vec3<u32>, index: u32) -> u32 {
    return 64u * (ACROSS * group.y + group.x) + index;
}
