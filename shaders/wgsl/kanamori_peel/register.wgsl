// Sorts the balls that are drawn into the tiles of the picture, by rising index in each, in three
// passes: tally and fill (256 balls a workgroup) with assign (one workgroup, a lane a tile) between
// them.

#import core::scene::scene
#import core::status::{report_needed, report_unfinished}
#import core::tiles::TileRange
#import kanamori_peel::placed::Placed
#import kanamori_peel::tiles::{tile_at, tiles_of, Tile, MOST_TILES}

@group(2) @binding(0) var<storage, read> placed: array<Placed>;
@group(2) @binding(1) var<storage, read_write> tiles: array<Tile>;
@group(2) @binding(2) var<storage, read_write> registered: array<u32>;
// For each workgroup of balls a row with a number for each tile: first the workgroup's balls there,
// then the tile's balls of all workgroups before it.
@group(2) @binding(3) var<storage, read_write> tallies: array<array<u32, MOST_TILES>>;

const LANES: u32 = 256u;
// Bits of a word of a set of lanes, and words of the set.
const BITS: u32 = 32u;
const WORDS: u32 = 8u;

// Of this workgroup's balls, the set in each tile.
var<workgroup> here: array<array<atomic<u32>, WORDS>, MOST_TILES>;
var<workgroup> sizes: array<u32, MOST_TILES>;

@compute @workgroup_size(256)
fn tally(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    gather(id.x, lane);
    let tile = lane;
    tallies[group.x][tile] = balls_before(LANES, tile);
}

// Where the balls do not fit, no tile gets any, and the frame is incomplete.
@compute @workgroup_size(256)
fn assign(@builtin(local_invocation_index) tile: u32) {
    let groups = (scene.balls + LANES - 1u) / LANES;
    var size = 0u;
    for (var group = 0u; group < groups; group++) {
        let own = tallies[group][tile];
        tallies[group][tile] = size;
        size += own;
    }
    sizes[tile] = size;
    workgroupBarrier();
    var first = 0u;
    var total = 0u;
    for (var other = 0u; other < MOST_TILES; other++) {
        first += select(0u, sizes[other], other < tile);
        total += sizes[other];
    }
    let all_fit = total <= arrayLength(&registered);
    tiles[tile] = Tile(first, select(0u, size, all_fit), 0u, 0u);
    if tile == 0u && !all_fit {
        report_needed(0u, total);
        report_unfinished();
    }
}

@compute @workgroup_size(256)
fn fill(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    let range = gather(id.x, lane);
    for (var row = range.first.y; row < range.end.y; row++) {
        for (var column = range.first.x; column < range.end.x; column++) {
            let tile = tile_at(column, row);
            if tiles[tile].balls > 0u {
                let offset = tallies[group.x][tile] + balls_before(lane, tile);
                registered[tiles[tile].first + offset] = id.x;
            }
        }
    }
}

// Makes the sets of this workgroup's balls; returns the ball's own tiles.
fn gather(ball: u32, lane: u32) -> TileRange {
    for (var word = 0u; word < WORDS; word++) {
        atomicStore(&here[lane][word], 0u);
    }
    workgroupBarrier();
    var range = TileRange();
    if ball < scene.balls {
        range = tiles_of(placed[ball]);
    }
    for (var row = range.first.y; row < range.end.y; row++) {
        for (var column = range.first.x; column < range.end.x; column++) {
            atomicOr(&here[tile_at(column, row)][lane / BITS], 1u << (lane % BITS));
        }
    }
    workgroupBarrier();
    return range;
}

// The tile's balls among the first so many lanes.
fn balls_before(lanes: u32, tile: u32) -> u32 {
    var balls = 0u;
    for (var word = 0u; word < lanes / BITS; word++) {
        balls += countOneBits(atomicLoad(&here[tile][word]));
    }
    if lanes % BITS > 0u {
        let first = (1u << (lanes % BITS)) - 1u;
        balls += countOneBits(atomicLoad(&here[tile][lanes / BITS]) & first);
    }
    return balls;
}
