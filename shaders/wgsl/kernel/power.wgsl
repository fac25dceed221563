// The power kernel v^alpha, alpha from 1 to 8 (Gourmel et al. 2010, section 2.1).

#import core::powers::power
#import exponent::exponent

fn kernel(v: f32) -> f32 {
    return power(max(v, 0.0), exponent());
}

fn kernel_slope(v: f32) -> f32 {
    if v <= 0.0 {
        return 0.0;
    }
    return f32(exponent()) * power(v, exponent() - 1u);
}

// 2 alpha v^(alpha - 1) where the line is nearest, 4 alpha (alpha - 1) v^(alpha - 2) (1 - v) less that
// elsewhere. With alpha = 1 the slope jumps at the rim: a number so large that it allows for nothing.
fn greatest_bend() -> f32 {
    return select(f32(4u * exponent() * (exponent() - 1u)), 1e9, exponent() == 1u);
}

// The slope grows with v.
fn steepest_slope(least: f32, most: f32) -> f32 {
    return kernel_slope(most);
}

fn kernel_roundings() -> u32 {
    return 0u;
}
