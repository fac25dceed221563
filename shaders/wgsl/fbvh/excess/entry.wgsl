// The excess F - T, for the search for an entry into the solid. Derived in
// crates/fbvh/src/trace/certified/ranges.rs.

#import core::scene::scene
#import fbvh::projection::Depths

const SIGN: f32 = 1.0;

const SOLID_ANSWERS: bool = true;

fn stays_below(most: f32) -> bool {
    return most < scene.threshold;
}

fn depth_of_most(v: Depths) -> f32 {
    return v.most;
}

// At the interval's end.
fn way_of_least_slope(to_start: f32, to_end: f32) -> f32 {
    return -to_end;
}

fn upper_bound(least: f32, most: f32, error: f32) -> f32 {
    return most * (1.0 + error) - scene.threshold;
}

fn lower_bound(least: f32, most: f32, error: f32) -> f32 {
    return least * (1.0 - error) - scene.threshold;
}
