// Tiles of the picture with the balls that can be seen in each, nearest first (section 5.3, in compute).

#import core::view::view

// Tiles of a picture at most: MOST_TILES of crates/kanamori-peel/src/robust/room.rs.
const MOST_TILES: u32 = 16384u;
// Balls over a tile at most: a sort of more would take too many iterations of an invocation.
const MOST_ENTRIES: u32 = 131072u;

struct Entry {
    // No point of the support is nearer to the eye, rounding included; negative around the eye.
    near: f32,
    ball: u32,
}

// First the number of entries of each tile; then where they begin; after they are filled in, where they
// end, which is where the next tile's begin.
@group(2) @binding(0) var<storage, read_write> marks: array<atomic<u32>>;
@group(2) @binding(1) var<storage, read_write> entries: array<Entry>;

// Entries of a tile, first and behind the last.
fn list_of(tile: u32) -> vec2<u32> {
    var first = 0u;
    if tile > 0u {
        first = atomicLoad(&marks[tile - 1u]);
    }
    let room = arrayLength(&entries);
    return min(vec2(first, atomicLoad(&marks[tile])), vec2(room));
}

// Pixels on a tile's side: 16, or more where the picture would have too many tiles.
fn tile_side() -> u32 {
    var side = 16u;
    while tiles_along(view.width, side) * tiles_along(view.height, side) > MOST_TILES {
        side *= 2u;
    }
    return side;
}

fn tiles_along(pixels: u32, side: u32) -> u32 {
    return (pixels + side - 1u) / side;
}

fn tile_at(position: vec2<u32>) -> u32 {
    let side = tile_side();
    return position.y / side * tiles_along(view.width, side) + position.x / side;
}
