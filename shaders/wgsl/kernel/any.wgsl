// Any kernel, by a branch wherever a value is needed. Formulas and order of operations are those of the
// kernel's own module.

#import core::kernel_read::{kernel_read, PERLIN, POWER}
#import core::powers::power
#import exponent::exponent

fn kernel(v: f32) -> f32 {
    let depth = max(v, 0.0);
    if kernel_read.family == POWER {
        return power(depth, exponent());
    }
    if kernel_read.family == PERLIN {
        let rho = sqrt(clamp(1.0 - v, 0.0, 1.0));
        let rest = 1.0 - rho;
        return rest * rest * rest * (1.0 + 3.0 * rho + 6.0 * rho * rho);
    }
    return depth * depth * (5.0 + 4.0 * depth) * (1.0 / 9.0);
}

fn kernel_slope(v: f32) -> f32 {
    let depth = max(v, 0.0);
    if kernel_read.family == POWER {
        return select(0.0, f32(exponent()) * power(depth, exponent() - 1u), v > 0.0);
    }
    if kernel_read.family == PERLIN {
        let rho = sqrt(clamp(1.0 - v, 0.0, 1.0));
        let rest = 1.0 - rho;
        return 15.0 * rho * rest * rest;
    }
    return depth * (10.0 + 12.0 * depth) * (1.0 / 9.0);
}

fn greatest_bend() -> f32 {
    if kernel_read.family == POWER {
        return select(f32(4u * exponent() * (exponent() - 1u)), 1e9, exponent() == 1u);
    }
    return 6.0;
}

// Perlin's slope peaks at rho = 1/3, the others grow with v.
fn steepest_slope(least: f32, most: f32) -> f32 {
    const PEAK: f32 = 8.0 / 9.0;
    if kernel_read.family == PERLIN {
        if least > PEAK {
            return kernel_slope(least);
        }
        return select(kernel_slope(most), 20.0 / 9.0, most > PEAK);
    }
    return kernel_slope(most);
}
