// A scene whose balls have radii of their own.

#import core::scene::Support

// Centre and radius of each ball in one vector: one load.
@group(1) @binding(0) var<storage, read> supports: array<vec4<f32>>;

fn support_of(ball: u32) -> Support {
    let support = supports[ball];
    return Support(support.xyz, support.w);
}
