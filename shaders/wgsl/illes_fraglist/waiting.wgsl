// Rays between two dispatches: those that wait for the next one are listed, and how far each is, is kept.

#import core::ray_list::{groups_along, Listing}

// How far a ray is. The local arrays are not kept: they follow from the list up to `node` and the position.
// Twin: Progress of crates/illes-fraglist/src/canvas.rs.
struct Progress {
    stage: u32,
    // Node of the list to resume at; of an overfull ray the width of the next interval, as bits.
    node: u32,
    // Distance along the ray up to which there is no root.
    position: f32,
    // FALLBACK or 0.
    fallback: u32,
}

// Stages of a ray.
const FRESH: u32 = 0u;
// Its list is partly merged.
const UNORDERED: u32 = 1u;
const ORDERED: u32 = 2u;
// Searched without the array.
const OVERFULL: u32 = 3u;

// One a pixel; of rays that do not wait it is old.
@group(3) @binding(3) var<storage, read_write> progress: array<Progress>;
@group(3) @binding(8) var<storage, read_write> waiting: Listing;

fn wait(pixel: u32, state: Progress) {
    progress[pixel] = state;
    let index = atomicAdd(&waiting.count, 1u);
    waiting.pixels[index] = pixel;
    if index % 64u == 0u {
        let groups = groups_along(index + 1u);
        atomicMax(&waiting.groups_x, groups.x);
        atomicMax(&waiting.groups_y, groups.y);
        atomicMax(&waiting.groups_z, groups.z);
    }
}
