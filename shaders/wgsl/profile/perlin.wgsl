// Perlin's polynomial of degree five in rho = r/R, 1 - 10 rho^3 + 15 rho^4 - 6 rho^5 (Illés and
// Szécsi), as the product (1 - rho)^3 (1 + 3 rho + 6 rho^2), which does not cancel at the rim.

#import profile::rim::place_at

// The slope is greatest at v = 8/9, rho = 1/3.
const PERLIN_PEAK: f32 = 8.0 / 9.0;
const PERLIN_STEEPEST: f32 = 20.0 / 9.0;
// |d2k/dt2| R^2 along any line: across a radius 30 rho (1 - rho)^2 <= 4.45, along it
// 60 rho (1 - rho) |1 - 2 rho| <= 5.78.
const PERLIN_BEND: f32 = 6.0;

fn perlin(v: f32) -> f32 {
    let place = place_at(v);
    let rho = place.ratio;
    return place.to_rim * place.to_rim * place.to_rim * (1.0 + 3.0 * rho + 6.0 * rho * rho);
}

fn perlin_slope(v: f32) -> f32 {
    let place = place_at(v);
    return 15.0 * place.ratio * place.to_rim * place.to_rim;
}
