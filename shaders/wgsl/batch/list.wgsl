// Which rays of a batch have a query, as batch::list_rays leaves them: by pixel, near ones near each other.

// Begins with the workgroups of an indirect dispatch along the list, 64 rays each. Twin of `ListHead` in
// metaball-core.
struct Listed {
    groups_x: u32,
    groups_y: u32,
    groups_z: u32,
    count: u32,
    pixels: array<u32>,
}

// Most workgroups in a row of that dispatch.
const ACROSS: u32 = 32768u;

// The list's index for an invocation of such a dispatch.
fn index_in_list(group: vec3<u32>, index: u32) -> u32 {
    return 64u * (ACROSS * group.y + group.x) + index;
}
