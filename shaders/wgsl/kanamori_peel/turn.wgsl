// Before a layer: what it draws. A tile without balls, or without a ray that lacks an answer, draws
// nothing, so that what is recorded beyond its last layer costs little.

#import kanamori_peel::outline::VERTICES
#import kanamori_peel::tiles::{MOST_TILES, Tile}

// An indirect draw. The number of the tile is in the first vertex: a first instance, which could be the
// index of its first ball, would take a feature.
struct Draw {
    vertices: u32,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
}

@group(2) @binding(0) var<storage, read_write> tiles: array<Tile, MOST_TILES>;
// Set by rays that have no answer.
@group(2) @binding(1) var<storage, read_write> rays_left: array<u32, MOST_TILES>;
@group(2) @binding(2) var<storage, read_write> draws: array<Draw, MOST_TILES>;

@compute @workgroup_size(256)
fn turn(@builtin(local_invocation_index) tile: u32) {
    // Before the first layer no ray has an answer.
    let is_live = select(rays_left[tile] != 0u, tiles[tile].balls > 0u, tiles[tile].layers == 0u);
    rays_left[tile] = 0u;
    tiles[tile].is_live = select(0u, 1u, is_live);
    tiles[tile].layers += select(0u, 1u, is_live);
    let balls = select(0u, tiles[tile].balls, is_live);
    draws[tile] = Draw(VERTICES, balls, tile * VERTICES, 0u);
}
