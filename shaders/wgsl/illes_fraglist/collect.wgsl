// Core depth and lists of all pixels, each from the entries of its tile: what cores.wgsl and gather.wgsl
// do by rasterising.

#import metaball::illes_fraglist::balls::{ball_of_rank, core_entry, is_gathered, segment_of}
#import metaball::illes_fraglist::balls::support_of_rank
#import metaball::illes_fraglist::lists
#import metaball::illes_fraglist::tiles
#import metaball::status::{report_needed, report_unfinished}
#import metaball::view::{in_picture, pixel_at, rays, NO_LIMIT}

// What cast.wgsl reads as `lists::core_distance`.
@group(3) @binding(6) var core_distance: texture_storage_2d<r32float, write>;

// Entries of a tile at most: two walks along them stay below the 65,535 iterations of software Vulkan.
const MOST_ENTRIES: u32 = 30000u;

@compute @workgroup_size(8, 8)
fn collect(@builtin(global_invocation_id) id: vec3<u32>) {
    if !in_picture(id.xy) {
        return;
    }
    let pixel = pixel_at(id.xy);
    let ray = rays[pixel];
    let side = tiles::tile_side();
    let tile = id.y / side * tiles::tiles_across(side) + id.x / side;
    var start = 0u;
    if tile > 0u {
        start = atomicLoad(&tiles::marks[tile - 1u]);
    }
    let end = min(atomicLoad(&tiles::marks[tile]), arrayLength(&tiles::entries));
    if end > start + MOST_ENTRIES {
        report_unfinished();
        report_needed(3u, end - start);
        return;
    }

    var core = NO_LIMIT;
    for (var entry = start; entry < end; entry++) {
        core = min(core, core_entry(ball_of_rank[tiles::entries[entry]], ray.direction));
    }
    textureStore(core_distance, id.xy, vec4(core));

    // The last entries tend to be the farthest, and lists are built from the back.
    let limit = min(core, ray.t_max);
    for (var entry = end; entry > start; entry--) {
        let rank = tiles::entries[entry - 1u];
        let support = support_of_rank(rank);
        if is_gathered(segment_of(support.center, support.radius, ray.direction), limit) {
            lists::prepend(pixel, rank);
        }
    }
}
