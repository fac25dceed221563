// What arrange.wgsl made, for the passes that draw.
#define_import_path metaball::kanamori_peel::arranged

#import metaball::kanamori_peel::rectangle::Placed

// The longest list of active balls that eight targets hold: 4 * 8 - 2.
const MOST_ACTIVE: u32 = 30u;

struct Arranged {
    // Balls to draw.
    drawn: u32,
    // Balls whose supports hold the eye; the first MOST_ACTIVE of them follow.
    around: u32,
    around_balls: array<u32, MOST_ACTIVE>,
    // The balls to draw, by rising index.
    balls: array<u32>,
}

@group(2) @binding(1) var<storage, read> placed: array<Placed>;
@group(2) @binding(2) var<storage, read> arranged: Arranged;
// Radius of each ball's kernel sphere, in which it reaches the threshold alone; 0 where it never
// does.
@group(2) @binding(3) var<storage, read> kernel_radii: array<f32>;
