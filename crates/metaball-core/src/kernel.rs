//! Kernels: the falloff of a ball, its slope and its inverse.

mod profile;
mod real;

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

pub use self::profile::{
    AnyProfile, CubicSpline, Gaussian, Power, Profile, QuinticSpline, WendlandC2, WendlandC4,
    WendlandC6, Wyvill,
};
pub use self::real::Real;
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

/// Where a Gaussian is cut, in standard deviations: from 1 to 6 in steps of a hundredth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Cut {
    hundredths: u16,
    /// The bits of the Gaussian's scale, so that no value has to find it again.
    scale: u64,
}

impl Cut {
    fn at(hundredths: u16) -> Self {
        let scale = Gaussian::cut_at(f64::from(hundredths) / 100.0).scale();
        Self { hundredths, scale: scale.to_bits() }
    }

    /// The value, 1 to 6.
    pub fn get(self) -> f64 {
        f64::from(self.hundredths) / 100.0
    }

    /// The Gaussian that is cut there.
    #[inline]
    pub fn profile(self) -> Gaussian {
        Gaussian::of_scale(self.get(), f64::from_bits(self.scale))
    }
}

/// The falloff k(s), s = r²/R², shared by all balls of a scene: 1 at the centre, falling, 0 from the
/// support radius R on.
///
/// Formulas are in the *depth* v = 1 − s, which is a parabola along any ray; ρ = r/R:
///
/// | kernel | k | source |
/// | --- | --- | --- |
/// | power α | v^α | Gourmel et al. 2010, section 2.1; α = 2 is Kanamori's quartic |
/// | Wyvill | v²(5 + 4v)/9 | the polynomial of degree six in r of Kanamori et al. 2008, rewritten in v |
/// | Perlin | (1−ρ)³(1 + 3ρ + 6ρ²) | 1 − 10ρ³ + 15ρ⁴ − 6ρ⁵ of Illés and Szécsi, as a product, which does not cancel at the rim |
/// | cubic spline | 1 − 6ρ²(1−ρ), from ρ = ½ on 2(1−ρ)³ | M₄ of SPH, R = 2h ([`CubicSpline`]) |
/// | quintic spline | ((3−q)⁵ − 6(2−q)⁵ + 15(1−q)⁵)/66, q = 3ρ | M₆ of SPH, R = 3h ([`QuinticSpline`]) |
/// | Wendland C² | (1−ρ)⁴(1 + 4ρ) | [`WendlandC2`] |
/// | Wendland C⁴ | (1−ρ)⁶(1 + 6ρ + 35/3 ρ²) | [`WendlandC4`] |
/// | Wendland C⁶ | (1−ρ)⁸(1 + 8ρ + 25ρ² + 32ρ³) | [`WendlandC6`] |
/// | Gaussian | (e^{cv} − 1)/(eᶜ − 1), c = cut²/2 | cut at so many standard deviations, and lowered to reach 0 there ([`Gaussian`]) |
///
/// The SPH kernel W(r, h) is W(0, h)·k, so a particle of mass m and density ρ has the strength
/// m/ρ·W(0, h): [`Kernel::normalization`].
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
    /// The cubic B-spline M₄ of r; not a polynomial along a ray.
    CubicSpline,
    /// The quintic B-spline M₆ of r; not a polynomial along a ray.
    QuinticSpline,
    /// Wendland's function of smoothness C²; not a polynomial along a ray.
    WendlandC2,
    /// Wendland's function of smoothness C⁴; not a polynomial along a ray.
    WendlandC4,
    /// Wendland's function of smoothness C⁶; not a polynomial along a ray.
    WendlandC6,
    /// A Gaussian, cut and lowered to reach 0. Make one with [`Kernel::gaussian`].
    Gaussian(Cut),
}

/// An exponent that no power kernel has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("kernel exponent: needed an integer from 1 to 8, found {found}")]
pub struct ExponentError {
    /// The number given.
    pub found: i64,
}

/// A cut that no Gaussian has.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("cut of a Gaussian: needed 1 to 6 standard deviations in steps of 0.01, found {found}")]
pub struct CutError {
    /// The number given.
    pub found: f64,
}

/// A name that no kernel has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("kernel: needed {}, found {found:?}", Kernel::NAMES)]
pub struct KernelNameError {
    /// The name given.
    pub found: String,
}

impl Kernel {
    /// The names that a kernel can be called by.
    pub const NAMES: &str = "power-1 to power-8 (power is power-2, quartic too, and poly6 is power-3), wyvill, \
        perlin, cubic-spline, quintic-spline, wendland-c2, wendland-c4, wendland-c6, or gaussian-1 to \
        gaussian-6 with the cut in standard deviations (gaussian is gaussian-3)";

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

    /// A Gaussian that is cut at so many standard deviations, which are its support radius, and lowered to
    /// reach 0 there: with a jump the surface would have holes.
    ///
    /// # Errors
    /// When the cut is not from 1 to 6, or no multiple of 0.01.
    pub fn gaussian(deviations: f64) -> Result<Self, CutError> {
        let hundredths = (100.0 * deviations).round();
        let is_exact = (hundredths / 100.0 - deviations).abs() <= 1e-9;
        if is_exact && (100.0..=600.0).contains(&hundredths) {
            Ok(Self::Gaussian(Cut::at(hundredths as u16)))
        } else {
            Err(CutError { found: deviations })
        }
    }

    /// Every kernel there is, the power kernels by rising exponent first; of the Gaussians the one that is
    /// cut at three standard deviations.
    pub fn all() -> impl Iterator<Item = Self> {
        let others = [
            Self::Wyvill,
            Self::Perlin,
            Self::CubicSpline,
            Self::QuinticSpline,
            Self::WendlandC2,
            Self::WendlandC4,
            Self::WendlandC6,
            Self::Gaussian(Cut::at(300)),
        ];
        (1..=8).map(|exponent| Self::Power(Exponent(exponent))).chain(others)
    }

    /// The profile; `None` for Perlin's kernel, which is not convex in v.
    #[inline]
    pub fn profile(self) -> Option<AnyProfile> {
        Some(match self {
            Self::Perlin => return None,
            Self::Power(exponent) => AnyProfile::Power(Power(exponent)),
            Self::Wyvill => AnyProfile::Wyvill(Wyvill),
            Self::CubicSpline => AnyProfile::CubicSpline(CubicSpline),
            Self::QuinticSpline => AnyProfile::QuinticSpline(QuinticSpline),
            Self::WendlandC2 => AnyProfile::WendlandC2(WendlandC2),
            Self::WendlandC4 => AnyProfile::WendlandC4(WendlandC4),
            Self::WendlandC6 => AnyProfile::WendlandC6(WendlandC6),
            Self::Gaussian(cut) => AnyProfile::Gaussian(cut.profile()),
        })
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
            _ => self.profile().map_or(0.0, |profile| profile.value(v)),
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
            _ => self.profile().map_or(0.0, |profile| -profile.slope(v)),
        }
    }

    /// The greatest slope by v = 1 − r²/R² that the kernel has anywhere.
    pub fn steepest(self) -> f64 {
        match self {
            Self::Perlin => 20.0 / 9.0,
            // Convex in v.
            _ => -self.slope(0.0),
        }
    }

    /// Whether the slope jumps at the rim.
    pub fn has_kink(self) -> bool {
        matches!(self, Self::Power(Exponent(1)) | Self::Gaussian(_))
    }

    /// 1/(4π∫k(r²/R²)r²dr) in units of 1/R³: W(0, h)·R³ of the SPH kernel with this shape, whose integral
    /// over space is 1.
    pub fn normalization(self) -> f64 {
        // Gauss's rule on parts of ρ from 0 to 1, whose ends are the knots of all splines.
        const PARTS: u32 = 48;
        const NODE: f64 = 0.577_350_269_189_625_8;
        let at = |rho: f64| self.value(rho * rho) * rho * rho;
        let half = 0.5 / f64::from(PARTS);
        let middle = |part: u32| (2.0 * f64::from(part) + 1.0) * half;
        let integral: f64 = (0..PARTS)
            .map(|part| half * (at(middle(part) - NODE * half) + at(middle(part) + NODE * half)))
            .sum();
        1.0 / (4.0 * std::f64::consts::PI * integral)
    }

    /// The kernel in f32 at depth v = 1 − r²/R², in the order of operations of the shaders; 0 for v ≤ 0.
    #[inline]
    pub fn value_at_depth(self, v: f32) -> f32 {
        let v = v.max(0.0);
        match self {
            Self::Power(exponent) => power(v, exponent.0),
            Self::Perlin => {
                let rho = (1.0 - v).max(0.0).sqrt();
                let rest = v / (1.0 + rho);
                rest * rest * rest * (1.0 + 3.0 * rho + 6.0 * rho * rho)
            }
            _ => self.profile().map_or(0.0, |profile| profile.value(v)),
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
            Self::Perlin => {
                let rho = (1.0 - v).max(0.0).sqrt();
                let rest = v / (1.0 + rho);
                15.0 * rho * rest * rest
            }
            _ => self.profile().map_or(0.0, |profile| profile.slope(v)),
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
            _ => bisect(|v| self.value(1.0 - v) - value),
        };
        Some((1.0 - v).max(0.0).sqrt())
    }

    /// The core radius of a ball, scene units: inside this sphere its own contribution reaches
    /// `threshold`, if no other takes away from it. `None` when it never does.
    pub fn core_radius(self, ball: &Metaball, threshold: f32) -> Option<f64> {
        let ratio = self.ratio_at(f64::from(threshold) / f64::from(ball.strength))?;
        Some(ratio * f64::from(ball.radius))
    }

    /// The coefficients c of k = Σ cₙ vⁿ, v = 1 − r²/R², constant first. `None` for a kernel
    /// that is no polynomial in v.
    ///
    /// Along a ray at distance d from the centre, at t from the centre's projection,
    /// v = (R² − d² − t²)/R²: so k is a polynomial along the ray, of degree 2(c.len() − 1).
    pub fn coefficients(self) -> Option<&'static [f64]> {
        const POWERS: [f64; 9] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        match self {
            Self::Power(exponent) => Some(&POWERS[8 - usize::from(exponent.0)..]),
            Self::Wyvill => Some(&[0.0, 0.0, 5.0 / 9.0, 4.0 / 9.0]),
            _ => None,
        }
    }

    /// Degree of the field along a ray, `None` where it is no polynomial.
    pub fn degree_along_ray(self) -> Option<usize> {
        self.coefficients().map(|coefficients| 2 * (coefficients.len() - 1))
    }
}

impl fmt::Display for Kernel {
    /// The name that scene files and records use: `power-2`, `wyvill`, `cubic-spline`, `gaussian-3`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Power(exponent) => write!(formatter, "power-{}", exponent.0),
            Self::Wyvill => formatter.write_str("wyvill"),
            Self::Perlin => formatter.write_str("perlin"),
            Self::CubicSpline => formatter.write_str("cubic-spline"),
            Self::QuinticSpline => formatter.write_str("quintic-spline"),
            Self::WendlandC2 => formatter.write_str("wendland-c2"),
            Self::WendlandC4 => formatter.write_str("wendland-c4"),
            Self::WendlandC6 => formatter.write_str("wendland-c6"),
            Self::Gaussian(cut) => write!(formatter, "gaussian-{}", cut.get()),
        }
    }
}

impl FromStr for Kernel {
    type Err = KernelNameError;

    /// The kernel of a name: one of [`Kernel::NAMES`].
    fn from_str(name: &str) -> Result<Self, KernelNameError> {
        let gaussian = |cut: &str| Self::gaussian(cut.parse().ok()?).ok();
        let named = match name {
            "power" | "quartic" => Some(Self::QUARTIC),
            "poly6" => Some(Self::Power(Exponent(3))),
            "gaussian" => Some(Self::Gaussian(Cut::at(300))),
            _ => match name.strip_prefix("gaussian-") {
                Some(cut) => gaussian(cut),
                None => Self::all().find(|kernel| kernel.to_string() == name),
            },
        };
        named.ok_or_else(|| KernelNameError { found: name.to_owned() })
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
        /// to half its bits near the rim, but there the value is below its cube. Of a Gaussian that is cut
        /// far out the exponent's own rounding tells.
        #[test]
        fn single_precision_agrees(kernel in any_kernel(), v in 0.0f32..=1.0) {
            let s = 1.0 - f64::from(v);
            prop_assert!((f64::from(kernel.value_at_depth(v)) - kernel.value(s)).abs() < 1e-6);
            let allowed = 1e-6 * kernel.steepest().max(4.0);
            prop_assert!((f64::from(kernel.slope_at_depth(v)) + kernel.slope(s)).abs() < allowed);
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
    fn names_are_read_as_they_are_written() {
        let gaussian = Kernel::gaussian(2.25).expect("legal");
        for kernel in Kernel::all().chain([gaussian]) {
            assert_eq!(kernel.to_string().parse(), Ok(kernel));
        }
        assert_eq!(gaussian.to_string(), "gaussian-2.25");
        for (alias, name) in [("power", "power-2"), ("quartic", "power-2"), ("poly6", "power-3")] {
            assert_eq!(
                alias.parse::<Kernel>().map(|kernel| kernel.to_string()),
                Ok(name.to_owned())
            );
        }
        for name in ["gauss", "gaussian-0.5", "gaussian-1.001", "gaussian-", "power-9", ""] {
            let error = name.parse::<Kernel>().expect_err("no kernel").to_string();
            assert!(
                error.starts_with("kernel: needed power-1") && error.contains(&format!("{name:?}"))
            );
        }
        let error = Kernel::gaussian(7.0).expect_err("too far out").to_string();
        assert!(error.ends_with("in steps of 0.01, found 7"), "{error}");
    }

    /// W(0, h)·R³ of the literature, h being R, R/2 or R/3; for the power kernel with α = 3 that of Müller et
    /// al. 2003 (poly6), for a Gaussian nearly (2π)^(−3/2)·cut³ if it is cut far out.
    #[test]
    fn normalizations_are_those_of_the_literature() {
        let pi = std::f64::consts::PI;
        let gaussian = Kernel::gaussian(6.0).expect("legal");
        let known = [
            (Kernel::CubicSpline, 8.0 / pi),
            (Kernel::QuinticSpline, 27.0 * 66.0 / (120.0 * pi)),
            (Kernel::WendlandC2, 21.0 / (2.0 * pi)),
            (Kernel::WendlandC4, 495.0 / (32.0 * pi)),
            (Kernel::WendlandC6, 1365.0 / (64.0 * pi)),
            (Kernel::Power(Exponent(3)), 315.0 / (64.0 * pi)),
            (gaussian, 216.0 / (2.0 * pi).powf(1.5)),
        ];
        for (kernel, known) in known {
            approx::assert_relative_eq!(kernel.normalization(), known, max_relative = 2e-6);
        }
    }

    /// The greatest slope is where it says, and at the rim it is 0 unless there is a kink.
    #[test]
    fn slopes_are_nowhere_steeper() {
        for kernel in Kernel::all() {
            let most = (0..=10_000).map(|step| -kernel.slope(f64::from(step) * 1e-4));
            let most = most.fold(0.0, f64::max);
            assert!((most / kernel.steepest() - 1.0).abs() < 1e-6, "{kernel}: {most}");
            assert_eq!(-kernel.slope(1.0 - 1e-9) > 1e-6, kernel.has_kink(), "{kernel}");
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
