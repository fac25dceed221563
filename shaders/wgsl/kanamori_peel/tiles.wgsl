// The grid of tiles that the picture is divided into (section 5.3): each is peeled with its own balls
// until none of its rays is left.

#import kanamori_peel::placed::{is_drawn, Placed}
#import core::view::view

// Tiles on a side of the grid.
@id(38) override tiles_on_side: u32 = 8u;

// Twin of the square of `MOST_TILES` in kanamori-peel.
const MOST_TILES: u32 = 256u;

// Twin of `Tile` in kanamori-peel.
struct Tile {
    // The tile's balls: place of the first among those registered, and their number.
    first: u32,
    balls: u32,
    // Not 0 where a ray of the tile has no answer before the layer at hand.
    is_live: u32,
}

// Columns and rows of tiles, first and behind the last.
struct TileRange {
    first: vec2<u32>,
    end: vec2<u32>,
}

// Pixels across and down; the last tiles may have fewer, or none.
fn tile_size() -> vec2<u32> {
    return (vec2(view.width, view.height) + tiles_on_side - 1u) / tiles_on_side;
}

fn tile_at(column: u32, row: u32) -> u32 {
    return row * tiles_on_side + column;
}

fn tile_of(position: vec2<u32>) -> u32 {
    let place = position / tile_size();
    return tile_at(place.x, place.y);
}

// The tiles that a ball's rectangle meets.
fn tiles_of(ball: Placed) -> TileRange {
    if !is_drawn(ball) {
        return TileRange(vec2(0u), vec2(0u));
    }
    // Rows count from the top.
    let size = vec2(f32(view.width), f32(view.height));
    let first = vec2<u32>(0.5 * vec2(1.0 + ball.low.x, 1.0 - ball.high.y) * size);
    let last = vec2<u32>(0.5 * vec2(1.0 + ball.high.x, 1.0 - ball.low.y) * size);
    return TileRange(first / tile_size(), min(last / tile_size() + 1u, vec2(tiles_on_side)));
}

// A corner of the strip of two triangles that is the tile, counted from 0, in clip space.
fn corner_of_tile(tile: u32, vertex: u32) -> vec4<f32> {
    let first = vec2(tile % tiles_on_side, tile / tiles_on_side);
    let pixel = (first + vec2(vertex & 1u, vertex >> 1u)) * tile_size();
    let place = 2.0 * vec2<f32>(pixel) / vec2(f32(view.width), f32(view.height)) - 1.0;
    return vec4(place.x, -place.y, 0.5, 1.0);
}
