// Wendland's function of smoothness C2 in three dimensions: (1 - rho)^4 (1 + 4 rho), rho = r/R.

#import profile::rim::ROUNDINGS
#import profile::wendland::{wendland_c2, wendland_c2_slope, WENDLAND_C2_BEND}

fn kernel(v: f32) -> f32 {
    return wendland_c2(v);
}

fn kernel_slope(v: f32) -> f32 {
    return wendland_c2_slope(v);
}

fn greatest_bend() -> f32 {
    return WENDLAND_C2_BEND;
}

// The slope grows with v.
fn steepest_slope(least: f32, most: f32) -> f32 {
    return kernel_slope(most);
}

fn kernel_roundings() -> u32 {
    return ROUNDINGS;
}
