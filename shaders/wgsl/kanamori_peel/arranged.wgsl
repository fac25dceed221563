// What kanamori_peel::arrange made and the tiles' balls, for the passes that draw.

#import kanamori_peel::placed::Placed
#import kanamori_peel::tiles::Tile

// The longest list of active balls that eight targets hold: 4 * 8 - 2.
const MOST_ACTIVE: u32 = 30u;

// Twin of `Arranged` in kanamori-peel.
struct Arranged {
    // Balls whose rectangles are in the picture, and those of them that are drawn.
    in_view: u32,
    drawn: u32,
    // Balls whose supports hold the eye; the first MOST_ACTIVE of them follow.
    around: u32,
    around_balls: array<u32, MOST_ACTIVE>,
}

@group(2) @binding(1) var<storage, read> placed: array<Placed>;
@group(2) @binding(2) var<storage, read> arranged: Arranged;
// Radius of each ball's kernel sphere, in which it reaches the threshold alone; 0 where it never
// does.
@group(2) @binding(3) var<storage, read> kernel_radii: array<f32>;
@group(2) @binding(5) var<storage, read> tiles: array<Tile>;
// Balls of the tiles, one tile after the other, by rising index in each.
@group(2) @binding(6) var<storage, read> registered: array<u32>;
