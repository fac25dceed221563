//! Kernels: the falloff of a ball, its slope and its inverse.

use std::fmt;

use thiserror::Error;

use crate::Metaball;

/// Exponent of a power kernel: an integer from 1 to 8.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Exponent(u8);

impl Exponent {
    /// The value, 1 to 8.
    pub const fn get(self) -> u8 {
        self.0
    }
}

/// The falloff k(s), s = r²/R², shared by all balls of a scene: 1 at the centre, falling, 0 from the
/// support radius R on.
///
/// Formulas are in the *depth* v = 1 − s, which is a parabola along any ray:
///
/// | kernel | k | source |
/// | --- | --- | --- |
/// | power α | v^α | Gourmel et al. 2010, section 2.1; α = 2 is Kanamori's quartic |
/// | Wyvill | v²(5 + 4v)/9 | the polynomial of degree six in r of Kanamori et al. 2008, rewritten in v |
/// | Perlin | (1−ρ)³(1 + 3ρ + 6ρ²), ρ = r/R | 1 − 10ρ³ + 15ρ⁴ − 6ρ⁵ of Illés and Szécsi, as a product, which does not cancel at the rim |
///
/// ```
/// use metaball_core::{Kernel, Metaball, glam::Vec3};
///
/// let ball = Metaball::new(Vec3::ZERO, 2.0);
/// assert_eq!(Kernel::QUARTIC.value(0.5), 0.25);
/// // Alone, this ball is a sphere of half its support radius under T = 9/16.
/// assert_eq!(Kernel::QUARTIC.core_radius(&ball, 0.5625), Some(1.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kernel {
    /// (1 − r²/R²)^α. Make one with [`Kernel::power`].
    Power(Exponent),
    /// Wyvill's polynomial of degree six in r.
    Wyvill,
    /// Perlin's polynomial of degree five in r; not a polynomial along a ray.
    Perlin,
}

/// An exponent that no power kernel has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("kernel exponent: needed an integer from 1 to 8, found {found}")]
pub struct ExponentError {
    /// The number given.
    pub found: i64,
}

impl Kernel {
    /// The quartic, the power kernel with α = 2.
    pub const QUARTIC: Self = Self::Power(Exponent(2));

    /// The power kernel (1 − r²/R²)^α.
    ///
    /// # Errors
    /// When the exponent is not from 1 to 8.
    pub fn power(exponent: i64) -> Result<Self, ExponentError> {
        match u8::try_from(exponent) {
            Ok(value @ 1..=8) => Ok(Self::Power(Exponent(value))),
            _ => Err(ExponentError { found: exponent }),
        }
    }

    /// Every kernel there is, the power kernels by rising exponent first.
    pub fn all() -> impl Iterator<Item = Self> {
        (1..=8).map(|exponent| Self::Power(Exponent(exponent))).chain([Self::Wyvill, Self::Perlin])
    }

    /// The kernel at `squared_ratio` = r²/R². In \[0, 1\]; 0 from the support radius on.
    pub fn value(self, squared_ratio: f64) -> f64 {
        let v = 1.0 - squared_ratio;
        if v <= 0.0 {
            return 0.0;
        }
        match self {
            Self::Power(exponent) => v.powi(exponent.0.into()),
            Self::Wyvill => v * v * (5.0 + 4.0 * v) / 9.0,
            Self::Perlin => {
                let rho = squared_ratio.max(0.0).sqrt();
                // 1 − ρ = v/(1 + ρ): no cancellation at the rim.
                (v / (1.0 + rho)).powi(3) * (1.0 + 3.0 * rho + 6.0 * squared_ratio)
            }
        }
    }

    /// The derivative of [`Kernel::value`] by its argument, dk/d(r²/R²). Never positive; 0 outside
    /// the support, and at its rim the limit from outside.
    pub fn slope(self, squared_ratio: f64) -> f64 {
        let v = 1.0 - squared_ratio;
        if v <= 0.0 {
            return 0.0;
        }
        match self {
            Self::Power(exponent) => {
                let alpha = i32::from(exponent.0);
                -f64::from(alpha) * v.powi(alpha - 1)
            }
            Self::Wyvill => -(10.0 * v + 12.0 * v * v) / 9.0,
            Self::Perlin => {
                // dk/dρ = −30ρ²(1−ρ)², dρ/ds = 1/(2ρ).
                let rho = squared_ratio.max(0.0).sqrt();
                -15.0 * rho * (v / (1.0 + rho)).powi(2)
            }
        }
    }

    /// The kernel in f32 at depth v = 1 − r²/R², in the order of operations of the shaders; 0 for v ≤ 0.
    #[inline]
    pub fn value_at_depth(self, v: f32) -> f32 {
        let v = v.max(0.0);
        match self {
            Self::Power(exponent) => power(v, exponent.0),
            Self::Wyvill => v * v * (5.0 + 4.0 * v) * (1.0 / 9.0),
            Self::Perlin => {
                let rho = (1.0 - v).max(0.0).sqrt();
                let rest = 1.0 - rho;
                rest * rest * rest * (1.0 + 3.0 * rho + 6.0 * rho * rho)
            }
        }
    }

    /// The derivative of [`Kernel::value_at_depth`] by v, f32; never negative, 0 for v ≤ 0.
    #[inline]
    pub fn slope_at_depth(self, v: f32) -> f32 {
        if v <= 0.0 {
            return 0.0;
        }
        match self {
            Self::Power(exponent) => f32::from(exponent.0) * power(v, exponent.0 - 1),
            Self::Wyvill => v * (10.0 + 12.0 * v) * (1.0 / 9.0),
            Self::Perlin => {
                let rho = (1.0 - v).max(0.0).sqrt();
                15.0 * rho * (1.0 - rho) * (1.0 - rho)
            }
        }
    }

    /// The inverse: the ratio r/R in \[0, 1\] at which the kernel takes `value`. `None` where it never
    /// does, that is outside \[0, 1\].
    pub fn ratio_at(self, value: f64) -> Option<f64> {
        if !(0.0..=1.0).contains(&value) {
            return None;
        }
        let v = match self {
            Self::QUARTIC => value.sqrt(),
            Self::Power(exponent) => value.powf(f64::from(exponent.0).recip()),
            Self::Wyvill => wyvill_depth(value),
            // Increasing in v on [0, 1].
            Self::Perlin => bisect(|v| self.value(1.0 - v) - value),
        };
        Some((1.0 - v).max(0.0).sqrt())
    }

    /// The core radius of a ball, scene units: inside this sphere its own contribution reaches
    /// `threshold`, whatever the others add. `None` when it never does.
    pub fn core_radius(self, ball: &Metaball, threshold: f32) -> Option<f64> {
        let ratio = self.ratio_at(f64::from(threshold) / f64::from(ball.strength))?;
        Some(ratio * f64::from(ball.radius))
    }

    /// The coefficients c of k = Σ cₙ vⁿ, v = 1 − r²/R², constant first. `None` for Perlin's kernel,
    /// which is no polynomial in v.
    ///
    /// Along a ray at distance d from the centre, at t from the centre's projection,
    /// v = (R² − d² − t²)/R²: so k is a polynomial along the ray, of degree 2(c.len() − 1).
    pub fn coefficients(self) -> Option<&'static [f64]> {
        const POWERS: [f64; 9] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        match self {
            Self::Power(exponent) => Some(&POWERS[8 - usize::from(exponent.0)..]),
            Self::Wyvill => Some(&[0.0, 0.0, 5.0 / 9.0, 4.0 / 9.0]),
            Self::Perlin => None,
        }
    }

    /// Degree of the field along a ray, `None` where it is no polynomial.
    pub fn degree_along_ray(self) -> Option<usize> {
        self.coefficients().map(|coefficients| 2 * (coefficients.len() - 1))
    }
}

impl fmt::Display for Kernel {
    /// The name that scene files and records use: `power-2`, `wyvill`, `perlin`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Power(exponent) => write!(formatter, "power-{}", exponent.0),
            Self::Wyvill => formatter.write_str("wyvill"),
            Self::Perlin => formatter.write_str("perlin"),
        }
    }
}

/// v^exponent by repeated squaring, in the order of multiplications that the shader uses.
#[inline]
fn power(v: f32, exponent: u8) -> f32 {
    let squared = v * v;
    let fourth = squared * squared;
    let mut product = if exponent & 1 != 0 { v } else { 1.0 };
    if exponent & 2 != 0 {
        product *= squared;
    }
    if exponent & 4 != 0 {
        product *= fourth;
    }
    if exponent & 8 != 0 {
        product *= fourth * fourth;
    }
    product
}

/// Where v²(5 + 4v)/9 is a value from 0 to 1. It is convex and at least 5v²/9, so Newton's steps from there
/// come down to the root without passing it.
fn wyvill_depth(value: f64) -> f64 {
    let mut depth = (1.8 * value).sqrt().min(1.0);
    while depth > 0.0 {
        let excess = depth * depth * (5.0 + 4.0 * depth) - 9.0 * value;
        let next = depth - excess / (depth * (10.0 + 12.0 * depth));
        // Rounding alone lifts a step, or keeps it where it is.
        if next >= depth {
            break;
        }
        depth = next;
    }
    depth
}

/// The root in \[0, 1\] of an increasing function, to the last float.
fn bisect(function: impl Fn(f64) -> f64) -> f64 {
    let (mut below, mut above) = (0.0, 1.0);
    loop {
        let middle = 0.5 * (below + above);
        if middle <= below || middle >= above {
            return middle;
        }
        if function(middle) < 0.0 {
            below = middle;
        } else {
            above = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn any_kernel() -> impl Strategy<Value = Kernel> {
        proptest::sample::select(Kernel::all().collect::<Vec<_>>())
    }

    proptest! {
        #[test]
        fn support_is_compact(kernel in any_kernel(), beyond in 0.0f64..1e6) {
            prop_assert_eq!(kernel.value(1.0 + beyond), 0.0);
            prop_assert_eq!(kernel.slope(1.0 + beyond), 0.0);
            prop_assert_eq!(kernel.value_at_depth(-beyond as f32), 0.0);
        }

        #[test]
        fn falls_from_one_to_zero(kernel in any_kernel(), a in 0.0f64..1.0, b in 0.0f64..1.0) {
            let (near, far) = if a < b { (a, b) } else { (b, a) };
            prop_assert!(kernel.value(near) >= kernel.value(far));
            prop_assert!((0.0..=1.0).contains(&kernel.value(near)));
            prop_assert_eq!(kernel.value(0.0), 1.0);
        }

        /// The central difference of a function with third derivative below M errs by h²M/6 plus
        /// rounding 2e-16/h; M < 336 (α = 8) and h = 1e-5 give 6e-9. Perlin's third derivative in s
        /// is unbounded at the centre, so s stays above 0.01, where it is below 4e4: 7e-7.
        #[test]
        fn slope_is_the_derivative(kernel in any_kernel(), s in 0.01f64..0.99) {
            let h = 1e-5;
            let difference = (kernel.value(s + h) - kernel.value(s - h)) / (2.0 * h);
            prop_assert!((kernel.slope(s) - difference).abs() < 1e-6);
        }

        /// The inverse is right to rounding in v; the value moves by slope (at most 8) times that.
        #[test]
        fn ratio_at_inverts(kernel in any_kernel(), value in 0.0f64..=1.0) {
            let ratio = kernel.ratio_at(value).expect("a value from 0 to 1 is taken");
            prop_assert!((kernel.value(ratio * ratio) - value).abs() < 1e-14);
        }

        /// v⁸ in f32 makes at most four roundings of 6e-8 relative, Wyvill five; Perlin's ρ loses up
        /// to half its bits near the rim, but there the value is below its cube.
        #[test]
        fn single_precision_agrees(kernel in any_kernel(), v in 0.0f32..=1.0) {
            let s = 1.0 - f64::from(v);
            prop_assert!((f64::from(kernel.value_at_depth(v)) - kernel.value(s)).abs() < 1e-6);
            prop_assert!((f64::from(kernel.slope_at_depth(v)) + kernel.slope(s)).abs() < 4e-6);
        }

        #[test]
        fn coefficients_are_the_kernel(kernel in any_kernel(), v in 0.0f64..=1.0) {
            if let Some(coefficients) = kernel.coefficients() {
                let sum = coefficients.iter().rev().fold(0.0, |sum, c| sum * v + c);
                prop_assert!((sum - kernel.value(1.0 - v)).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn values_outside_the_range_have_no_ratio() {
        for kernel in Kernel::all() {
            assert_eq!(kernel.ratio_at(-0.1), None);
            assert_eq!(kernel.ratio_at(1.1), None);
            assert_eq!(kernel.ratio_at(f64::NAN), None);
        }
    }

    #[test]
    fn exponents_out_of_range_are_named() {
        let error = Kernel::power(9).expect_err("9 is out of range");
        assert_eq!(error.to_string(), "kernel exponent: needed an integer from 1 to 8, found 9");
        assert!(Kernel::power(0).is_err() && Kernel::power(-1).is_err());
    }

    #[test]
    fn core_radii_are_those_of_the_literature() {
        // Wyvill's v²(5 + 4v)/9 is 1/2 at v = 3/4, so r = R/2, and 1/5 at v = 0.5062, so r = 0.7027R.
        let ball = Metaball::new(glam::Vec3::ZERO, 1.0);
        let core = |threshold| Kernel::Wyvill.core_radius(&ball, threshold).expect("below 1");
        approx::assert_abs_diff_eq!(core(0.2), 0.7027, epsilon = 1e-4);
        approx::assert_abs_diff_eq!(core(0.5), 0.5, epsilon = 1e-6);
        assert_eq!(Kernel::QUARTIC.core_radius(&ball, 1.5), None);
    }
}
