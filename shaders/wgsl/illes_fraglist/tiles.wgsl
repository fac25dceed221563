// Lists of the balls that can be seen in each tile of the picture: the rasteriser's part of the
// gathering, done in compute.

#import core::cover::cover_sphere
#import core::tiles::{square_tiles_under, TileRange}
#import core::view::view
#import illes_fraglist::balls::support_of_rank

// First the number of entries of each tile; then where they begin; after they are filled in, where they
// end, which is where the next tile's begin.
@group(3) @binding(4) var<storage, read_write> marks: array<atomic<u32>>;
// Ranks, tile by tile.
@group(3) @binding(5) var<storage, read_write> entries: array<u32>;

// The tiles that a ball's rectangle meets.
fn tiles_of_rank(rank: u32) -> TileRange {
    let support = support_of_rank(rank);
    return square_tiles_under(cover_sphere(support.center - view.eye, support.radius));
}
