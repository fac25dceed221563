// Lists the rays of a batch that ask a question, so that rays side by side all have something to ask: the
// pass before those that answer.

#import batch::free_ray::FreeRay
#import batch::list::ACROSS
#import core::view::{in_blocks, in_picture, pixel_at}

// The question. Id 2 of the ids that metaball-core sets.
@id(2) override question: u32 = 1u;

@group(0) @binding(1) var<storage, read> free_rays: array<FreeRay>;

// `Listed` while many write to it.
struct Listing {
    groups_x: atomic<u32>,
    groups_y: atomic<u32>,
    groups_z: atomic<u32>,
    count: atomic<u32>,
    pixels: array<u32>,
}

@group(0) @binding(2) var<storage, read_write> listing: Listing;

// How many of the workgroup's rays ask, and where they stand in the list.
var<workgroup> asking: atomic<u32>;
var<workgroup> first: u32;

@compute @workgroup_size(8, 8)
fn list_rays(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let at = 8u * group.xy + in_blocks(index);
    let pixel = pixel_at(at);
    var asks = false;
    var place = 0u;
    if in_picture(at) {
        asks = free_rays[pixel].query == question;
    }
    if asks {
        place = atomicAdd(&asking, 1u);
    }
    workgroupBarrier();
    if index == 0u {
        let count = atomicLoad(&asking);
        first = atomicAdd(&listing.count, count);
        let groups = (first + count + 63u) / 64u;
        atomicMax(&listing.groups_x, min(groups, ACROSS));
        atomicMax(&listing.groups_y, (groups + ACROSS - 1u) / ACROSS);
        atomicMax(&listing.groups_z, 1u);
    }
    workgroupBarrier();
    if asks {
        listing.pixels[first + place] = pixel;
    }
}
