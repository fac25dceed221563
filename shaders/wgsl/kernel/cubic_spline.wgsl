// The cubic spline of SPH (Monaghan and Lattanzio 1985), for a support radius of 2 h.

#import profile::rim::ROUNDINGS
#import profile::splines::{cubic_spline, cubic_spline_slope, CUBIC_SPLINE_BEND}

fn kernel(v: f32) -> f32 {
    return cubic_spline(v);
}

fn kernel_slope(v: f32) -> f32 {
    return cubic_spline_slope(v);
}

fn greatest_bend() -> f32 {
    return CUBIC_SPLINE_BEND;
}

// The slope grows with v.
fn steepest_slope(least: f32, most: f32) -> f32 {
    return kernel_slope(most);
}

fn kernel_roundings() -> u32 {
    return ROUNDINGS;
}
