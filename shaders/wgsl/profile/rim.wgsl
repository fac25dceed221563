// Where a point lies between a ball's centre and the rim of its support, in parts of the support radius, by
// the depth v = 1 - r^2/R^2.

struct Place {
    // rho = r/R.
    ratio: f32,
    // 1 - rho, as v/(1 + rho): without cancellation at the rim.
    to_rim: f32,
}

// Kernels of these two, and their slopes, err by less than so many units in the last place of themselves.
//
// WGSL allows a square root 4.5 units and a division 2.5: rho errs by 5, and v/(1 + rho) by 3.5 and by what
// rho does to it. That counts little, since 1 - rho falls as the other factor rises: at most 8.4 units in
// (1 - rho)^8 (1 + 8 rho + 25 rho^2 + 32 rho^3) and 9.4 in its slope's factors, at the rim. The powers of
// 1 - rho add 3.5 units a factor, up to 28, and their products 7; the polynomials up to 6. Splines are sums
// with signs: the cubic's is 1/4 of its terms at least and errs by 48 units, the quintic's by 42.
const ROUNDINGS: u32 = 50u;

fn place_at(v: f32) -> Place {
    let ratio = sqrt(max(1.0 - v, 0.0));
    return Place(ratio, max(v, 0.0) / (1.0 + ratio));
}
