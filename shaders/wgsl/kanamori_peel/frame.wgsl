// What all passes of the method agree on.

#import core::view::NO_LIMIT

// Twin of `Peeling` in kanamori-peel.
struct Peeling {
    // A power of two, so that nothing is rounded; distances of interest times this are below 1.
    depth_scale: f32,
}

@group(2) @binding(0) var<uniform> peeling: Peeling;

// A distance along a ray as the depth buffer keeps it.
fn to_depth(t: f32) -> f32 {
    return t * peeling.depth_scale;
}

// The distance kept; NO_LIMIT where the buffer is as it was cleared.
fn from_depth(depth: f32) -> f32 {
    return select(depth / peeling.depth_scale, NO_LIMIT, depth >= 1.0);
}
