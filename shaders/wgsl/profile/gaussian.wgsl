// A Gaussian that is cut and lowered, (e^(c v) - 1) / (e^c - 1), by the depth v.

struct Gaussian {
    // c, from 1/2 to 18: how far down the cut is, in powers of e.
    exponent: f32,
    // 1/(e^c - 1).
    scale: f32,
}

// The slope jumps at the rim: a number so large that it allows for nothing.
const GAUSSIAN_BEND: f32 = 1e9;

// Value and slope err by less than so many units in the last place of themselves: c and c v are rounded, and
// a compiler may round what is taken off for the powers of 2 once more, which moves x = c v by 2.5 units of
// x, and e^x - 1 by 1 + x times that part of itself; all the rest errs by five.
fn gaussian_roundings(shape: Gaussian) -> u32 {
    return 8u + u32(3.0 * shape.exponent);
}

fn gaussian(shape: Gaussian, v: f32) -> f32 {
    return exponential_less_1(shape.exponent * max(v, 0.0)) * shape.scale;
}

fn gaussian_slope(shape: Gaussian, v: f32) -> f32 {
    let rise = exponential_less_1(shape.exponent * max(v, 0.0)) + 1.0;
    return select(0.0, rise * (shape.exponent * shape.scale), v > 0.0);
}

// e^x - 1 for x from 0 to 80, free of cancellation. WGSL's own exponential may err by 3 + 2x units in the
// last place, and does by 15 of 1 where e^x - 1 is next to nothing.
//
// With x = n ln 2 + r it is 2^n (e^r - 1) + (2^n - 1), of which for n > 0 the second part is at least twice
// the first where that is negative; e^r - 1 by seven terms of its series, |r| <= ln(2)/2.
fn exponential_less_1(x: f32) -> f32 {
    // ln 2, in a part whose products with small integers are exact, and the rest of it.
    const LN_2 = vec2(0.693145751953125, 1.428606820309417e-6);
    let turns = round(x * 1.4426950408889634);
    let r = (x - turns * LN_2.x) - turns * LN_2.y;
    var rise = 1.0 / 5040.0;
    rise = rise * r + 1.0 / 720.0;
    rise = rise * r + 1.0 / 120.0;
    rise = rise * r + 1.0 / 24.0;
    rise = rise * r + 1.0 / 6.0;
    rise = rise * r + 0.5;
    rise = (rise * r + 1.0) * r;
    let power = bitcast<f32>((u32(turns) + 127u) << 23u);
    return power * rise + (power - 1.0);
}
