// Any kernel, by a branch wherever a value is needed. Formulas and order of operations are those of the
// kernel's own module.

#import core::kernel_read::{kernel_read, CUBIC_SPLINE, GAUSSIAN, PERLIN, POWER, QUINTIC_SPLINE, WENDLAND_C2, WENDLAND_C4, WENDLAND_C6}
#import core::powers::power
#import exponent::exponent
#import profile::gaussian
#import profile::gaussian::Gaussian
#import profile::perlin
#import profile::rim::ROUNDINGS
#import profile::splines
#import profile::wendland

fn shape() -> Gaussian {
    return Gaussian(kernel_read.gaussian_exponent, kernel_read.gaussian_scale);
}

fn kernel(v: f32) -> f32 {
    let depth = max(v, 0.0);
    switch kernel_read.family {
        case POWER: {
            return power(depth, exponent());
        }
        case PERLIN: {
            return perlin::perlin(v);
        }
        case CUBIC_SPLINE: {
            return splines::cubic_spline(v);
        }
        case QUINTIC_SPLINE: {
            return splines::quintic_spline(v);
        }
        case WENDLAND_C2: {
            return wendland::wendland_c2(v);
        }
        case WENDLAND_C4: {
            return wendland::wendland_c4(v);
        }
        case WENDLAND_C6: {
            return wendland::wendland_c6(v);
        }
        case GAUSSIAN: {
            return gaussian::gaussian(shape(), v);
        }
        default: {
            return depth * depth * (5.0 + 4.0 * depth) * (1.0 / 9.0);
        }
    }
}

fn kernel_slope(v: f32) -> f32 {
    let depth = max(v, 0.0);
    switch kernel_read.family {
        case POWER: {
            return select(0.0, f32(exponent()) * power(depth, exponent() - 1u), v > 0.0);
        }
        case PERLIN: {
            return perlin::perlin_slope(v);
        }
        case CUBIC_SPLINE: {
            return splines::cubic_spline_slope(v);
        }
        case QUINTIC_SPLINE: {
            return splines::quintic_spline_slope(v);
        }
        case WENDLAND_C2: {
            return wendland::wendland_c2_slope(v);
        }
        case WENDLAND_C4: {
            return wendland::wendland_c4_slope(v);
        }
        case WENDLAND_C6: {
            return wendland::wendland_c6_slope(v);
        }
        case GAUSSIAN: {
            return gaussian::gaussian_slope(shape(), v);
        }
        default: {
            return depth * (10.0 + 12.0 * depth) * (1.0 / 9.0);
        }
    }
}

fn greatest_bend() -> f32 {
    switch kernel_read.family {
        case POWER: {
            return select(f32(4u * exponent() * (exponent() - 1u)), 1e9, exponent() == 1u);
        }
        case PERLIN: {
            return perlin::PERLIN_BEND;
        }
        case CUBIC_SPLINE: {
            return splines::CUBIC_SPLINE_BEND;
        }
        case QUINTIC_SPLINE: {
            return splines::QUINTIC_SPLINE_BEND;
        }
        case WENDLAND_C2: {
            return wendland::WENDLAND_C2_BEND;
        }
        case WENDLAND_C4: {
            return wendland::WENDLAND_C4_BEND;
        }
        case WENDLAND_C6: {
            return wendland::WENDLAND_C6_BEND;
        }
        case GAUSSIAN: {
            return gaussian::GAUSSIAN_BEND;
        }
        default: {
            return 6.0;
        }
    }
}

// Perlin's slope peaks at rho = 1/3, the others grow with v.
fn steepest_slope(least: f32, most: f32) -> f32 {
    if kernel_read.family != PERLIN {
        return kernel_slope(most);
    }
    if least > perlin::PERLIN_PEAK {
        return kernel_slope(least);
    }
    return select(kernel_slope(most), perlin::PERLIN_STEEPEST, most > perlin::PERLIN_PEAK);
}

fn kernel_roundings() -> u32 {
    if kernel_read.family == GAUSSIAN {
        return gaussian::gaussian_roundings(shape());
    }
    return select(0u, ROUNDINGS, kernel_read.family >= PERLIN);
}
