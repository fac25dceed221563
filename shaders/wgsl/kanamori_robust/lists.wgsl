// Tiles of the picture with the balls that can be seen in each, nearest first (section 5.3, in compute).

// Balls over a tile at most: a sort of more would take too many iterations of an invocation.
const TILE_CAPACITY: u32 = 131072u;

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
    let capacity = arrayLength(&entries);
    return min(vec2(first, atomicLoad(&marks[tile])), vec2(capacity));
}
