//! What profiles are computed in: f32 and f64, or several of them side by side, by the same formulas.

use std::ops::{Add, Div, Mul, Sub};

/// A floating-point number, or numbers side by side of which each is computed alone.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Terms of the series of eʳ, |r| ≤ ½ln 2, after which the rest is below the rounding.
    const EXPONENTIAL_TERMS: usize;

    /// The number nearest to this one.
    fn of(number: f64) -> Self;

    /// The square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;

    /// `below` where this is less than the limit, `otherwise` elsewhere.
    #[must_use]
    fn choose(self, limit: Self, below: Self, otherwise: Self) -> Self;

    /// The integer n nearest to a number from −120 to 120, and 2ⁿ.
    #[must_use]
    fn nearest_power(self) -> (Self, Self);

    /// The greater one, of this and another.
    #[inline(always)]
    #[must_use]
    fn at_least(self, least: Self) -> Self {
        self.choose(least, least, self)
    }

    /// eˣ for x from −80 to 80, to four units in the last place: the same bits on every machine.
    #[inline(always)]
    #[must_use]
    fn exp(self) -> Self {
        // ln 2 in a part whose products with small integers are exact, and the rest of it.
        const LN_2: (f64, f64) = (0.693_145_751_953_125, 1.428_606_820_309_417_3e-6);
        let (turns, power) = (self * Self::of(std::f64::consts::LOG2_E)).nearest_power();
        let rest = (self - turns * Self::of(LN_2.0)) - turns * Self::of(LN_2.1);
        let mut sum = Self::of(INVERSE_FACTORIALS[Self::EXPONENTIAL_TERMS - 1]);
        for n in (0..Self::EXPONENTIAL_TERMS - 1).rev() {
            sum = sum * rest + Self::of(INVERSE_FACTORIALS[n]);
        }
        power * sum
    }
}

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

impl Real for f64 {
    const EXPONENTIAL_TERMS: usize = 14;

    #[inline(always)]
    fn of(number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn choose(self, limit: Self, below: Self, otherwise: Self) -> Self {
        if self < limit { below } else { otherwise }
    }

    #[inline(always)]
    fn nearest_power(self) -> (Self, Self) {
        // Adding it leaves the nearest integer in the last bits of the mantissa.
        const SHIFT: f64 = (1u64 << 52) as f64 * 1.5;
        let shifted = self + SHIFT;
        (shifted - SHIFT, Self::from_bits(shifted.to_bits().wrapping_add(1023) << 52))
    }
}

impl Real for f32 {
    const EXPONENTIAL_TERMS: usize = 8;

    #[inline(always)]
    fn of(number: f64) -> Self {
        number as Self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn choose(self, limit: Self, below: Self, otherwise: Self) -> Self {
        if self < limit { below } else { otherwise }
    }

    #[inline(always)]
    fn nearest_power(self) -> (Self, Self) {
        const SHIFT: f32 = (1u32 << 23) as f32 * 1.5;
        let shifted = self + SHIFT;
        (shifted - SHIFT, Self::from_bits(shifted.to_bits().wrapping_add(127) << 23))
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
