// Sorts balls into the tiles of the picture: counts, adds up, fills in.

#import illes_fraglist::prefix::{sum_before, THREADS}
#import illes_fraglist::tiles
#import illes_fraglist::tiles::{entries, marks}
#import core::scene::scene
#import core::status::{report_needed, report_unfinished}

@compute @workgroup_size(64)
fn count_entries(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let range = tiles_of_rank(id.x + id.y * groups.x * 64u);
    let across = tiles::tiles_across(tiles::tile_side());
    for (var row = range.first.y; row < range.end.y; row++) {
        for (var column = range.first.x; column < range.end.x; column++) {
            atomicAdd(&marks[row * across + column], 1u);
        }
    }
}

// Turns counts into places, in one workgroup: each invocation adds up a run of tiles.
@compute @workgroup_size(256)
fn place_tiles(@builtin(local_invocation_index) thread: u32) {
    let run = tiles::MOST_TILES / THREADS;
    var sum = 0u;
    for (var tile = thread * run; tile < (thread + 1u) * run; tile++) {
        sum += atomicLoad(&marks[tile]);
    }
    var place = sum_before(thread, sum);
    for (var tile = thread * run; tile < (thread + 1u) * run; tile++) {
        place += atomicExchange(&marks[tile], place);
    }
    if thread == THREADS - 1u && place > arrayLength(&entries) {
        report_unfinished();
        report_needed(2u, place);
    }
}

@compute @workgroup_size(64)
fn fill_entries(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let rank = id.x + id.y * groups.x * 64u;
    let range = tiles_of_rank(rank);
    let across = tiles::tiles_across(tiles::tile_side());
    for (var row = range.first.y; row < range.end.y; row++) {
        for (var column = range.first.x; column < range.end.x; column++) {
            let place = atomicAdd(&marks[row * across + column], 1u);
            if place < arrayLength(&entries) {
                entries[place] = rank;
            }
        }
    }
}

// No tiles for what is no ball.
fn tiles_of_rank(rank: u32) -> tiles::TileRange {
    if rank >= scene.balls {
        return tiles::TileRange(vec2(0u), vec2(0u));
    }
    return tiles::tiles_of_ball(rank, tiles::tile_side());
}
