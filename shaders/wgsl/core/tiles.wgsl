// The picture in tiles, for passes that list the balls of each.

#import core::cover::Cover
#import core::view::view

// Square tiles of a picture at most: a ball that fills the picture takes so many iterations. Twin: MOST_TILES
// of crates/metaball-core/src/gpu/tile_bins.rs.
const MOST_TILES: u32 = 16384u;

// Pixels on a square tile's side: 16, or more where the picture would have too many tiles.
fn tile_side() -> u32 {
    var side = 16u;
    var count = tiles_of_side(side);
    while count.x * count.y > MOST_TILES {
        side *= 2u;
        count = tiles_of_side(side);
    }
    return side;
}

// Square tiles across and down the picture.
fn tiles_of_side(side: u32) -> vec2<u32> {
    return (vec2(view.width, view.height) + side - 1u) / side;
}

// Index of the square tile of a pixel.
fn tile_at(position: vec2<u32>) -> u32 {
    let side = tile_side();
    return position.y / side * tiles_of_side(side).x + position.x / side;
}

// Columns and rows of tiles, first and behind the last; and how many tiles are in a row of the grid.
struct TileRange {
    first: vec2<u32>,
    end: vec2<u32>,
    across: u32,
}

// The tiles that a rectangle meets, of a grid of so many across and down with tiles of one size.
fn tiles_under(cover: Cover, size: vec2<u32>, count: vec2<u32>) -> TileRange {
    if cover.low.x >= cover.high.x || cover.low.y >= cover.high.y {
        return TileRange(vec2(0u), vec2(0u), count.x);
    }
    // Rows count from the top.
    let picture = vec2(f32(view.width), f32(view.height));
    let first = 0.5 * vec2(1.0 + cover.low.x, 1.0 - cover.high.y) * picture;
    let last = 0.5 * vec2(1.0 + cover.high.x, 1.0 - cover.low.y) * picture;
    return TileRange(vec2<u32>(first) / size, min(vec2<u32>(last) / size + 1u, count), count.x);
}

// The square tiles that a rectangle meets.
fn square_tiles_under(cover: Cover) -> TileRange {
    let side = tile_side();
    return tiles_under(cover, vec2(side), tiles_of_side(side));
}
