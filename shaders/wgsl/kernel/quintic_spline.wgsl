// The quintic spline of SPH (Morris 1996), for a support radius of 3 h.

#import profile::rim::ROUNDINGS
#import profile::splines::{quintic_spline, quintic_spline_slope, QUINTIC_SPLINE_BEND}

fn kernel(v: f32) -> f32 {
    return quintic_spline(v);
}

fn kernel_slope(v: f32) -> f32 {
    return quintic_spline_slope(v);
}

fn greatest_bend() -> f32 {
    return QUINTIC_SPLINE_BEND;
}

// The slope grows with v.
fn steepest_slope(least: f32, most: f32) -> f32 {
    return kernel_slope(most);
}

fn kernel_roundings() -> u32 {
    return ROUNDINGS;
}
