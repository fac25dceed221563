// The rays of a batch that a pass is for: those with its query.

#import batch::free_ray::{FreeRay, ANY_HIT}

// The query, by the numbers of batch::free_ray. Id 2 of the ids that metaball-core sets.
@id(2) override query: u32 = 1u;

// One ray a pixel, row by row from the top left.
@group(0) @binding(1) var<storage, read> free_rays: array<FreeRay>;

fn is_queried(pixel: u32) -> bool {
    return free_rays[pixel].query == query;
}

fn is_any_hit() -> bool {
    return query == ANY_HIT;
}
