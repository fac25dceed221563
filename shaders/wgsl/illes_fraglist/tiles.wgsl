// Lists of the balls that can be seen in each tile of the picture: the rasteriser's part of the
// gathering, done in compute.

#import core::cover::covering_corner
#import illes_fraglist::balls::support_of_rank
#import core::view::view

// Tiles of a picture at most: TILES of crates/illes-fraglist/src/tiles.rs. A ball that fills the
// picture takes so many iterations.
const MOST_TILES: u32 = 16384u;

// First the number of entries of each tile; then where they begin; after they are filled in, where they
// end, which is where the next tile's begin.
@group(3) @binding(4) var<storage, read_write> marks: array<atomic<u32>>;
// Ranks, tile by tile.
@group(3) @binding(5) var<storage, read_write> entries: array<u32>;

// Pixels on a tile's side: 16, or more where the picture would have too many tiles.
fn tile_side() -> u32 {
    var side = 16u;
    while tiles_across(side) * tiles_down(side) > MOST_TILES {
        side *= 2u;
    }
    return side;
}

fn tiles_across(side: u32) -> u32 {
    return (view.width + side - 1u) / side;
}

fn tiles_down(side: u32) -> u32 {
    return (view.height + side - 1u) / side;
}

// Columns and rows of tiles, first and behind the last, that a ball's rectangle meets.
struct TileRange {
    first: vec2<u32>,
    end: vec2<u32>,
}

fn tiles_of_ball(rank: u32, side: u32) -> TileRange {
    let support = support_of_rank(rank);
    let low = covering_corner(support.center, support.radius, 0u).xy;
    let high = covering_corner(support.center, support.radius, 3u).xy;
    if low.x >= high.x || low.y >= high.y {
        return TileRange(vec2(0u), vec2(0u));
    }
    // Rows count from the top.
    let size = vec2(f32(view.width), f32(view.height));
    let first = 0.5 * vec2(1.0 + low.x, 1.0 - high.y) * size;
    let last = 0.5 * vec2(1.0 + high.x, 1.0 - low.y) * size;
    let tiles = vec2(tiles_across(side), tiles_down(side));
    return TileRange(vec2<u32>(first) / side, min(vec2<u32>(last) / side + 1u, tiles));
}
