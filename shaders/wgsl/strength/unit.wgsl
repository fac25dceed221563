// A scene whose balls all have strength 1.

fn strength(ball: u32) -> f32 {
    return 1.0;
}
