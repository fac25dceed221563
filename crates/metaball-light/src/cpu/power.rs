//! Powers of numbers from 0 to 1, the same on every machine, without the work of a library that is right to
//! the last digit.

/// x^y to a part in a million, for x from 0 to 1 and y from 0 to 1: 2^(y·log₂x).
pub(super) fn power(x: f32, y: f32) -> f32 {
    if x < f32::MIN_POSITIVE {
        return 0.0;
    }
    exp2(y * log2(x))
}

/// log₂x of a normal number above 0: its exponent, and the series of artanh for a significand m from
/// √½ to √2, log₂m = 2/ln 2 · artanh((m − 1)/(m + 1)).
fn log2(x: f32) -> f32 {
    // The bits of √½: subtracted, they leave the exponent of x rounded at √2.
    const ROOT_OF_HALF: u32 = 0x3f35_04f3;
    let shifted = x.to_bits().wrapping_sub(ROOT_OF_HALF);
    let exponent = shifted.cast_signed() >> 23;
    let significand = f32::from_bits((shifted & 0x007f_ffff) + ROOT_OF_HALF);
    let s = (significand - 1.0) / (significand + 1.0);
    let square = s * s;
    // Of 2/ln 2 the parts 1, 1/3, 1/5, 1/7, 1/9; the next is below 1e-8.
    let series = 2.885_39
        + square
            * (0.961_796_7 + square * (0.577_078 + square * (0.412_198_6 + square * 0.320_598_9)));
    exponent as f32 + s * series
}

/// 2^x for x from −126 to 0: its whole part is an exponent, the rest Taylor's series.
fn exp2(x: f32) -> f32 {
    // Truncation rounds a negative number, less a half, to the nearest.
    let x = x.max(-126.0);
    let whole = (x - 0.5) as i32;
    let rest = (x - whole as f32) * std::f32::consts::LN_2;
    let series = 1.0
        + rest
            * (1.0
                + rest
                    * (1.0 / 2.0
                        + rest
                            * (1.0 / 6.0
                                + rest * (1.0 / 24.0 + rest * (1.0 / 120.0 + rest / 720.0)))));
    series * f32::from_bits(((whole + 127) as u32) << 23)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_right_to_a_part_in_a_million() {
        for y in [0.35f32, 0.55, 1.0] {
            for step in 0..=100_000u32 {
                let x = step as f32 / 100_000.0;
                let (found, exact) = (f64::from(power(x, y)), f64::from(x).powf(f64::from(y)));
                assert!((found - exact).abs() <= 1e-6 * exact, "{x}^{y}: {found} {exact}");
            }
        }
        assert_eq!(power(1e-40, 0.5), 0.0);
        assert_eq!(power(1.0, 0.55), 1.0);
    }
}
