// Lists the rays of a batch that have a query, so that of the passes along the list every invocation has one:
// the pass before those that answer.

#import batch::queried::is_queried
#import core::ray_list::{groups_along, Listing}
#import core::view::{in_blocks, in_picture, pixel_at}

@group(0) @binding(2) var<storage, read_write> listing: Listing;

// How many of the workgroup's rays are listed, and the index of the first.
var<workgroup> count: atomic<u32>;
var<workgroup> first: u32;

@compute @workgroup_size(8, 8)
fn list_rays(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let position = 8u * group.xy + in_blocks(index);
    let pixel = pixel_at(position);
    var is_listed = false;
    var offset = 0u;
    if in_picture(position) {
        is_listed = is_queried(pixel);
    }
    if is_listed {
        offset = atomicAdd(&count, 1u);
    }
    workgroupBarrier();
    if index == 0u {
        let listed = atomicLoad(&count);
        first = atomicAdd(&listing.count, listed);
        let groups = groups_along(first + listed);
        atomicMax(&listing.groups_x, groups.x);
        atomicMax(&listing.groups_y, groups.y);
        atomicMax(&listing.groups_z, groups.z);
    }
    workgroupBarrier();
    if is_listed {
        listing.pixels[first + offset] = pixel;
    }
}
