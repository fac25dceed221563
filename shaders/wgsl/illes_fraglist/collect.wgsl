// Core depth and lists of all pixels, each from the entries of its tile: what illes_fraglist::cores and
// illes_fraglist::gather do by rasterising.

#import core::status::{report_needed, report_unfinished}
#import core::tiles::tile_at
#import core::view::{in_picture, pixel_at, rays, NO_LIMIT}
#import illes_fraglist::balls::{ball_of_rank, core_entry, is_gathered, segment_of, support_of_rank}
#import illes_fraglist::lists
#import illes_fraglist::tiles

// What illes_fraglist::cast reads as lists::core_distance.
@group(3) @binding(6) var core_distance: texture_storage_2d<r32float, write>;

// Entries of a tile at most: two walks along them, four an iteration, stay below the 65,535 iterations
// of software Vulkan. Invocations side by side share a tile and walk together. Twin: TILE_CAPACITY of
// crates/illes-fraglist/src/options.rs.
const TILE_CAPACITY: u32 = 120000u;

@compute @workgroup_size(8, 8)
fn collect(@builtin(global_invocation_id) id: vec3<u32>) {
    if !in_picture(id.xy) {
        return;
    }
    let pixel = pixel_at(id.xy);
    let ray = rays[pixel];
    let tile = tile_at(id.xy);
    var start = 0u;
    if tile > 0u {
        start = atomicLoad(&tiles::marks[tile - 1u]);
    }
    let end = min(atomicLoad(&tiles::marks[tile]), arrayLength(&tiles::entries));
    if end <= start {
        // Nothing here, or nothing within the capacity.
        textureStore(core_distance, id.xy, vec4(NO_LIMIT));
        return;
    }
    if end - start > TILE_CAPACITY {
        report_unfinished();
        report_needed(3u, end - start);
        return;
    }

    var core = NO_LIMIT;
    for (var entry = start; entry < end; entry += 4u) {
        core = min(core, core_of_entry(entry, ray.direction));
        // Beyond the last entry the last is taken again.
        core = min(core, core_of_entry(min(entry + 1u, end - 1u), ray.direction));
        core = min(core, core_of_entry(min(entry + 2u, end - 1u), ray.direction));
        core = min(core, core_of_entry(min(entry + 3u, end - 1u), ray.direction));
    }
    textureStore(core_distance, id.xy, vec4(core));

    // The last entries tend to be the farthest, and lists are built from the back.
    let limit = min(core, ray.t_max);
    var left = end - start;
    while left > 0u {
        left = gather_last(pixel, start, left, ray.direction, limit);
        left = gather_last(pixel, start, left, ray.direction, limit);
        left = gather_last(pixel, start, left, ray.direction, limit);
        left = gather_last(pixel, start, left, ray.direction, limit);
    }
}

fn core_of_entry(entry: u32, direction: vec3<f32>) -> f32 {
    return core_entry(ball_of_rank[tiles::entries[entry]], direction);
}

// Gathers the last of the entries that are left, if any is. Returns how many are left then.
fn gather_last(pixel: u32, start: u32, left: u32, direction: vec3<f32>, limit: f32) -> u32 {
    if left == 0u {
        return 0u;
    }
    let rank = tiles::entries[start + left - 1u];
    let support = support_of_rank(rank);
    if is_gathered(segment_of(support.center, support.radius, direction), limit) {
        lists::prepend(pixel, rank);
    }
    return left - 1u;
}
