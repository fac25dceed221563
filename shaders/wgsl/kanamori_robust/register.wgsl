// Registers balls with the tiles of the picture: counts, adds up, fills in, and sorts each tile's list.

#import core::cover::cover_sphere
#import core::prefix_sum::{sum_before, THREADS}
#import core::scene::{scene, Support}
#import core::status::{report_needed, report_unfinished}
#import core::tiles::{square_tiles_under, TileRange, MOST_TILES}
#import core::view::view
#import kanamori_robust::lists
#import kanamori_robust::lists::{entries, marks, Entry}
#import support::support_of

@compute @workgroup_size(64)
fn count_entries(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let ball = id.x + id.y * groups.x * 64u;
    if ball >= scene.balls {
        return;
    }
    let range = tiles_of(support_of(ball));
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
    var longest = 0u;
    for (var tile = thread * run; tile < (thread + 1u) * run; tile++) {
        let count = atomicLoad(&marks[tile]);
        sum += count;
        longest = max(longest, count);
    }
    if longest > lists::TILE_CAPACITY {
        report_unfinished();
        report_needed(1u, longest);
    }
    var offset = sum_before(thread, sum);
    for (var tile = thread * run; tile < (thread + 1u) * run; tile++) {
        offset += atomicExchange(&marks[tile], offset);
    }
    if thread == THREADS - 1u && offset > arrayLength(&entries) {
        report_unfinished();
        report_needed(0u, offset);
    }
}

@compute @workgroup_size(64)
fn fill_entries(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let ball = id.x + id.y * groups.x * 64u;
    if ball >= scene.balls {
        return;
    }
    let support = support_of(ball);
    let distance = length(support.center - view.eye);
    // The difference, the length and the direction's own length err by a few parts in 2^23.
    let near = distance - support.radius - 8.0 * 0x1p-23f * (distance + support.radius);
    let range = tiles_of(support);
    for (var row = range.first.y; row < range.end.y; row++) {
        for (var column = range.first.x; column < range.end.x; column++) {
            let index = atomicAdd(&marks[row * range.across + column], 1u);
            if index < arrayLength(&entries) {
                entries[index] = Entry(near, ball);
            }
        }
    }
}

// The tiles that a ball's rectangle meets.
fn tiles_of(support: Support) -> TileRange {
    return square_tiles_under(cover_sphere(support.center - view.eye, support.radius));
}

var<workgroup> range_of_tile: vec2<u32>;

// Sorts a tile's list, one workgroup a tile: Batcher's bitonic merges, all rising. What is behind the
// list's end counts as greatest and stays there.
@compute @workgroup_size(256)
fn sort_entries(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    if thread == 0u {
        let list = lists::list_of(group.x);
        range_of_tile = vec2(list.x, min(list.y, list.x + lists::TILE_CAPACITY));
    }
    let range = workgroupUniformLoad(&range_of_tile);
    let length = range.y - range.x;
    for (var block = 2u; block < 2u * length; block *= 2u) {
        exchange(range, thread, block, true);
        storageBarrier();
        for (var part = block / 2u; part > 1u; part /= 2u) {
            exchange(range, thread, part, false);
            storageBarrier();
        }
    }
}

// One step of a merge: in each block, the first half against the second, as it lies or mirrored.
fn exchange(range: vec2<u32>, thread: u32, block: u32, mirrored: bool) {
    let half = block / 2u;
    let length = range.y - range.x;
    // Pairs up to the block that holds the list's end.
    let pairs = (length + block - 1u) / block * half;
    for (var pair = thread; pair < pairs; pair += THREADS) {
        let start = pair / half * block;
        let within = pair % half;
        let one = start + within;
        let other = start + select(half + within, block - 1u - within, mirrored);
        if other < length {
            let low = entries[range.x + one];
            let high = entries[range.x + other];
            if high.near < low.near || high.near == low.near && high.ball < low.ball {
                entries[range.x + one] = high;
                entries[range.x + other] = low;
            }
        }
    }
}
