// A Gaussian that the shader is compiled for, cut and lowered to reach 0 at the rim.

#import profile::gaussian::{gaussian, gaussian_roundings, gaussian_slope, Gaussian, GAUSSIAN_BEND}

// Ids 4 and 5 of the ids that metaball-core sets.
@id(4) override gaussian_exponent: f32 = 4.5;
@id(5) override gaussian_scale: f32 = 0.0112;

fn shape() -> Gaussian {
    return Gaussian(gaussian_exponent, gaussian_scale);
}

fn kernel(v: f32) -> f32 {
    return gaussian(shape(), v);
}

fn kernel_slope(v: f32) -> f32 {
    return gaussian_slope(shape(), v);
}

fn greatest_bend() -> f32 {
    return GAUSSIAN_BEND;
}

// The slope grows with v.
fn steepest_slope(least: f32, most: f32) -> f32 {
    return kernel_slope(most);
}

fn kernel_roundings() -> u32 {
    return gaussian_roundings(shape());
}
