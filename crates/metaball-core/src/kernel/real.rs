//! What profiles are computed in: f32 and f64, by the same formulas.

use std::ops::{Add, Div, Mul, Sub};

/// A floating-point number.
pub trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// The number nearest to this one.
    fn of(number: f64) -> Self;

    /// The square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;

    /// eˣ for x from −80 to 80, to four units in the last place; the same bits on every machine, without
    /// a branch, so that it can be computed side by side.
    #[must_use]
    fn exp(self) -> Self;

    /// The greater of two numbers, of which neither is NaN.
    #[inline(always)]
    #[must_use]
    fn at_least(self, least: Self) -> Self {
        if self < least { least } else { self }
    }
}

/// ln 2, in a part whose products with small integers are exact, and the rest of it.
const LN_2: (f64, f64) = (0.693_145_751_953_125, 1.428_606_820_309_417_3e-6);

/// 1/n!.
const INVERSE_FACTORIALS: [f64; 14] = {
    let mut inverses = [1.0; 14];
    let mut factorial = 1.0;
    let mut n = 1;
    while n < 14 {
        factorial *= n as f64;
        inverses[n] = 1.0 / factorial;
        n += 1;
    }
    inverses
};

/// eʳ for |r| ≤ ½ln 2 by so many terms of its series.
#[inline(always)]
fn series<R: Real, const TERMS: usize>(r: R) -> R {
    let mut sum = R::of(INVERSE_FACTORIALS[TERMS - 1]);
    for n in (0..TERMS - 1).rev() {
        sum = sum * r + R::of(INVERSE_FACTORIALS[n]);
    }
    sum
}

impl Real for f64 {
    #[inline(always)]
    fn of(number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn exp(self) -> Self {
        // Adding it leaves the nearest integer in the last bits of the mantissa.
        const SHIFT: f64 = (1u64 << 52) as f64 * 1.5;
        let shifted = self * std::f64::consts::LOG2_E + SHIFT;
        let turns = shifted - SHIFT;
        let power = Self::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
        power * series::<_, 14>((self - turns * LN_2.0) - turns * LN_2.1)
    }
}

impl Real for f32 {
    #[inline(always)]
    fn of(number: f64) -> Self {
        number as Self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn exp(self) -> Self {
        const SHIFT: f32 = (1u32 << 23) as f32 * 1.5;
        let shifted = self * std::f32::consts::LOG2_E + SHIFT;
        let turns = shifted - SHIFT;
        let power = Self::from_bits(shifted.to_bits().wrapping_add(127) << 23);
        power * series::<_, 8>((self - turns * LN_2.0 as Self) - turns * LN_2.1 as Self)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn exponentials_are_right_to_a_few_units(x in -80.0f64..80.0) {
            let single = x as f32;
            let error = (Real::exp(x) - libm::exp(x)).abs() / libm::exp(x);
            prop_assert!(error <= 4.0 * f64::EPSILON, "{error:e}");
            let exact = libm::exp(f64::from(single));
            let error = (f64::from(Real::exp(single)) - exact).abs() / exact;
            prop_assert!(error <= 4.0 * f64::from(f32::EPSILON), "{error:e}");
        }
    }
}
