// Sorts balls into the tiles of the picture: counts, adds up, fills in.

#import core::prefix_sum::{sum_before, THREADS}
#import core::scene::scene
#import core::status::{report_needed, report_unfinished}
#import core::tiles::MOST_TILES
#import illes_fraglist::tiles::{entries, marks, tiles_of_rank}

@compute @workgroup_size(64)
fn count_entries(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let rank = id.x + id.y * groups.x * 64u;
    if rank >= scene.balls {
        return;
    }
    let range = tiles_of_rank(rank);
    for (var row = range.first.y; row < range.end.y; row++) {
        for (var column = range.first.x; column < range.end.x; column++) {
            atomicAdd(&marks[row * range.across + column], 1u);
        }
    }
}

// Turns counts into offsets, in one workgroup: each invocation adds up a run of tiles.
@compute @workgroup_size(256)
fn scan_tiles(@builtin(local_invocation_index) thread: u32) {
    let run = MOST_TILES / THREADS;
    var sum = 0u;
    for (var tile = thread * run; tile < (thread + 1u) * run; tile++) {
        sum += atomicLoad(&marks[tile]);
    }
    var offset = sum_before(thread, sum);
    for (var tile = thread * run; tile < (thread + 1u) * run; tile++) {
        offset += atomicExchange(&marks[tile], offset);
    }
    if thread == THREADS - 1u && offset > arrayLength(&entries) {
        report_unfinished();
        report_needed(2u, offset);
    }
}

@compute @workgroup_size(64)
fn fill_entries(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let rank = id.x + id.y * groups.x * 64u;
    if rank >= scene.balls {
        return;
    }
    let range = tiles_of_rank(rank);
    for (var row = range.first.y; row < range.end.y; row++) {
        for (var column = range.first.x; column < range.end.x; column++) {
            let index = atomicAdd(&marks[row * range.across + column], 1u);
            if index < arrayLength(&entries) {
                entries[index] = rank;
            }
        }
    }
}
