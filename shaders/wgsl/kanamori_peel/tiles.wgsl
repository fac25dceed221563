// The grid of tiles that the picture is divided into (section 5.3): each is peeled with its own balls
// until none of its rays is left.

#import core::cover::Cover
#import core::tiles::{tiles_under, TileRange}
#import core::view::view
#import kanamori_peel::placed::Placed

// Tiles on a side of the grid.
@id(38) override tiles_on_side: u32 = 8u;

// Twin of the square of `MOST_TILES` in kanamori-peel.
const MOST_TILES: u32 = 256u;

// Twin of `Tile` in kanamori-peel.
struct Tile {
    // The tile's balls: index of the first among those registered, and their number.
    first: u32,
    balls: u32,
    // Not 0 where a ray of the tile has no answer before the layer at hand.
    is_live: u32,
    // Layers that the tile was given, with the one at hand.
    layers: u32,
}

// Pixels across and down; the last tiles may have fewer, or none.
fn tile_size() -> vec2<u32> {
    return (vec2(view.width, view.height) + tiles_on_side - 1u) / tiles_on_side;
}

fn tile_at(column: u32, row: u32) -> u32 {
    return row * tiles_on_side + column;
}

// The tiles that a ball's rectangle meets.
fn tiles_of(ball: Placed) -> TileRange {
    return tiles_under(Cover(ball.low, ball.high), tile_size(), vec2(tiles_on_side));
}

fn tile_of(position: vec2<u32>) -> u32 {
    let tile = position / tile_size();
    return tile_at(tile.x, tile.y);
}

// A corner of the strip of two triangles that is the tile, counted from 0, in clip space, at the far end.
fn corner_of_tile(tile: u32, vertex: u32) -> vec4<f32> {
    let first = vec2(tile % tiles_on_side, tile / tiles_on_side);
    let pixel = (first + vec2(vertex & 1u, vertex >> 1u)) * tile_size();
    let position = 2.0 * vec2<f32>(pixel) / vec2(f32(view.width), f32(view.height)) - 1.0;
    return vec4(position.x, -position.y, 1.0, 1.0);
}
