// Squares of the picture whose rays end together: the passes over the picture leave out those that
// have no ray left (the gain of section 5.3 for the isosurface test).
#define_import_path metaball::kanamori_peel::tile

#import metaball::view::view

// Pixels on a side; twin of `TILE` in kanamori-peel.
const TILE: u32 = 16u;

fn tile_columns() -> u32 {
    return (view.width + TILE - 1u) / TILE;
}

fn tile_count() -> u32 {
    return tile_columns() * ((view.height + TILE - 1u) / TILE);
}

fn tile_of(position: vec2<u32>) -> u32 {
    return position.y / TILE * tile_columns() + position.x / TILE;
}

// A corner of the strip of two triangles that is the tile, counted from 0, in clip space.
fn corner_of_tile(tile: u32, vertex: u32) -> vec4<f32> {
    let first = vec2(tile % tile_columns(), tile / tile_columns());
    let pixel = vec2<f32>((first + vec2(vertex & 1u, vertex >> 1u)) * TILE);
    let place = 2.0 * pixel / vec2(f32(view.width), f32(view.height)) - 1.0;
    return vec4(place.x, -place.y, 0.5, 1.0);
}
