// A scene whose balls have strengths of their own.

@group(1) @binding(1) var<storage, read> strengths: array<f32>;

fn strength(ball: u32) -> f32 {
    return strengths[ball];
}
