// Wendland's function of smoothness C4 in three dimensions:
// (1 - rho)^6 (1 + 6 rho + 35/3 rho^2), rho = r/R.

#import profile::rim::ROUNDINGS
#import profile::wendland::{wendland_c4, wendland_c4_slope, WENDLAND_C4_BEND}

fn kernel(v: f32) -> f32 {
    return wendland_c4(v);
}

fn kernel_slope(v: f32) -> f32 {
    return wendland_c4_slope(v);
}

fn greatest_bend() -> f32 {
    return WENDLAND_C4_BEND;
}

// The slope grows with v.
fn steepest_slope(least: f32, most: f32) -> f32 {
    return kernel_slope(most);
}

fn kernel_roundings() -> u32 {
    return ROUNDINGS;
}
