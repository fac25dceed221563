// The excess T - F, for the search for an exit of a ray that starts in the solid. Every bound is on the
// other side than for an entry: a ball adds least at the interval's farther end from its projection.

#import core::scene::scene
#import fbvh::projection::Depths

const SIGN: f32 = -1.0;

const SOLID_ANSWERS: bool = false;

// Never known: that takes a lower bound of the field.
fn stays_below(most: f32) -> bool {
    return false;
}

fn depth_of_most(v: Depths) -> f32 {
    return v.least;
}

// At the interval's start.
fn way_of_least_slope(to_start: f32, to_end: f32) -> f32 {
    return to_start;
}

fn upper_bound(least: f32, most: f32, error: f32) -> f32 {
    return scene.threshold - least * (1.0 - error);
}

fn lower_bound(least: f32, most: f32, error: f32) -> f32 {
    return scene.threshold - most * (1.0 + error);
}
