// Perlin's polynomial of degree five in rho = r/R, 1 - 10 rho^3 + 15 rho^4 - 6 rho^5 (Illés and
// Szécsi), as the product (1 - rho)^3 (1 + 3 rho + 6 rho^2), which does not cancel at the rim.

fn kernel(v: f32) -> f32 {
    let rho = sqrt(clamp(1.0 - v, 0.0, 1.0));
    let rest = 1.0 - rho;
    return rest * rest * rest * (1.0 + 3.0 * rho + 6.0 * rho * rho);
}

fn kernel_slope(v: f32) -> f32 {
    let rho = sqrt(clamp(1.0 - v, 0.0, 1.0));
    let rest = 1.0 - rho;
    return 15.0 * rho * rest * rest;
}

// Across a radius 30 rho (1 - rho)^2 <= 4.45, along it 60 rho (1 - rho) |1 - 2 rho| <= 5.78.
fn greatest_bend() -> f32 {
    return 6.0;
}

// The slope peaks at rho = 1/3.
fn steepest_slope(least: f32, most: f32) -> f32 {
    const PEAK: f32 = 8.0 / 9.0;
    if least > PEAK {
        return kernel_slope(least);
    }
    return select(kernel_slope(most), 20.0 / 9.0, most > PEAK);
}
