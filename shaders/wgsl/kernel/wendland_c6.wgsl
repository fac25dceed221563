// Wendland's function of smoothness C6 in three dimensions:
// (1 - rho)^8 (1 + 8 rho + 25 rho^2 + 32 rho^3), rho = r/R.

#import profile::rim::ROUNDINGS
#import profile::wendland::{wendland_c6, wendland_c6_slope, WENDLAND_C6_BEND}

fn kernel(v: f32) -> f32 {
    return wendland_c6(v);
}

fn kernel_slope(v: f32) -> f32 {
    return wendland_c6_slope(v);
}

fn greatest_bend() -> f32 {
    return WENDLAND_C6_BEND;
}

// The slope grows with v.
fn steepest_slope(least: f32, most: f32) -> f32 {
    return kernel_slope(most);
}

fn kernel_roundings() -> u32 {
    return ROUNDINGS;
}
