// Wyvill's polynomial of degree six in r, written in v: v^2 (5 + 4v) / 9 (Kanamori et al. 2008).

fn kernel(v: f32) -> f32 {
    let depth = max(v, 0.0);
    return depth * depth * (5.0 + 4.0 * depth) * (1.0 / 9.0);
}

fn kernel_slope(v: f32) -> f32 {
    let depth = max(v, 0.0);
    return depth * (10.0 + 12.0 * depth) * (1.0 / 9.0);
}

// 2 k' <= 44/9 where the line is nearest, and elsewhere 4 k'' (1 - v) <= 5.36 less that.
fn greatest_bend() -> f32 {
    return 6.0;
}

// The slope grows with v.
fn steepest_slope(least: f32, most: f32) -> f32 {
    return kernel_slope(most);
}

fn kernel_roundings() -> u32 {
    return 0u;
}
