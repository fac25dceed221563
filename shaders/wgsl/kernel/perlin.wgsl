// Perlin's polynomial of degree five in r (Illés and Szécsi).

#import profile::perlin::{perlin, perlin_slope, PERLIN_BEND, PERLIN_PEAK, PERLIN_STEEPEST}
#import profile::rim::ROUNDINGS

fn kernel(v: f32) -> f32 {
    return perlin(v);
}

fn kernel_slope(v: f32) -> f32 {
    return perlin_slope(v);
}

fn greatest_bend() -> f32 {
    return PERLIN_BEND;
}

fn steepest_slope(least: f32, most: f32) -> f32 {
    if least > PERLIN_PEAK {
        return kernel_slope(least);
    }
    return select(kernel_slope(most), PERLIN_STEEPEST, most > PERLIN_PEAK);
}

fn kernel_roundings() -> u32 {
    return ROUNDINGS;
}
