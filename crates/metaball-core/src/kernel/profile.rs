//! Kernels of simulations: falloffs that are convex in v = 1 − r²/R², and mostly no polynomials of it.

use super::Exponent;
use super::real::Real;

/// A falloff k(v) on 0 ≤ v ≤ 1, from 0 at the rim to 1 at the centre.
///
/// It is convex, and so is its extension by 0 beyond the rim: on a range of v it lies below its chord and
/// above its tangents. Its second derivative rises with v, too, wherever it does not jump.
///
/// All formulas are free of cancellation: values are right to 16 units in the last place of themselves, or
/// to what four units in the last place of v do to them. They hold at 0 and below as well, where slopes and
/// second derivatives are their limits from inside, and above 1, which is 1 but for rounding.
pub trait Profile: Copy + Send + Sync {
    /// k(v), for v ≥ 0.
    fn value<R: Real>(self, v: R) -> R;

    /// dk/dv, for v ≥ 0.
    fn slope<R: Real>(self, v: R) -> R;

    /// Both.
    #[inline(always)]
    fn value_and_slope<R: Real>(self, v: R) -> (R, R) {
        (self.value(v), self.slope(v))
    }

    /// d²k/dv², for v ≥ 0; for some it is infinite at v = 1.
    fn bend<R: Real>(self, v: R) -> R;

    /// The greatest of (1 − v)·d²k/dv², and the v where it is. It rises up to there, and falls behind.
    fn peak(self) -> (f64, f64);
}

/// r/R at v.
#[inline(always)]
pub(super) fn ratio<R: Real>(v: R) -> R {
    (R::of(1.0) - v).at_least(R::of(0.0)).sqrt()
}

/// x to the power of so many.
#[inline(always)]
pub(super) fn power<R: Real, const EXPONENT: usize>(x: R) -> R {
    let square = x * x;
    match EXPONENT {
        2 => square,
        3 => square * x,
        4 => square * square,
        5 => square * square * x,
        6 => square * square * square,
        7 => square * square * square * x,
        _ => (square * square) * (square * square),
    }
}

/// v^α: the power kernels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Power(pub Exponent);

impl Power {
    /// α, and α − n factors v.
    #[inline(always)]
    fn without<R: Real>(self, v: R, factors: u8) -> (f64, R) {
        let exponent = self.0.get();
        let product = (factors..exponent).fold(R::of(1.0), |product, _| product * v);
        (exponent.into(), product)
    }
}

impl Profile for Power {
    #[inline(always)]
    fn value<R: Real>(self, v: R) -> R {
        self.without(v, 0).1
    }

    #[inline(always)]
    fn slope<R: Real>(self, v: R) -> R {
        let (exponent, product) = self.without(v, 1);
        product * R::of(exponent)
    }

    #[inline(always)]
    fn bend<R: Real>(self, v: R) -> R {
        let (exponent, product) = self.without(v, 2);
        product * R::of(exponent * (exponent - 1.0))
    }

    /// At v = (α − 2)/(α − 1).
    fn peak(self) -> (f64, f64) {
        let exponent = f64::from(self.0.get());
        let at = if exponent > 2.0 { (exponent - 2.0) / (exponent - 1.0) } else { 0.0 };
        ((1.0 - at) * self.bend(at), at)
    }
}

/// Wyvill's v²(5 + 4v)/9.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wyvill;

impl Profile for Wyvill {
    #[inline(always)]
    fn value<R: Real>(self, v: R) -> R {
        v * v * (R::of(5.0) + R::of(4.0) * v) * R::of(1.0 / 9.0)
    }

    #[inline(always)]
    fn slope<R: Real>(self, v: R) -> R {
        v * (R::of(10.0) + R::of(12.0) * v) * R::of(1.0 / 9.0)
    }

    #[inline(always)]
    fn bend<R: Real>(self, v: R) -> R {
        (R::of(10.0) + R::of(24.0) * v) * R::of(1.0 / 9.0)
    }

    fn peak(self) -> (f64, f64) {
        (289.0 / 216.0, 7.0 / 24.0)
    }
}

/// A cubic B-spline M₄ of r, of which the support radius is twice the smoothing length h (Monaghan and
/// Lattanzio 1985, A refined particle method for astrophysical problems, equation 21): with ρ = r/R,
/// 1 − 6ρ²(1 − ρ) up to ρ = ½ and 2(1 − ρ)³ behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CubicSpline;

impl Profile for CubicSpline {
    #[inline(always)]
    fn value<R: Real>(self, v: R) -> R {
        let rho = ratio(v);
        let rest = v / (R::of(1.0) + rho);
        let inner = R::of(1.0) - R::of(6.0) * (rho * rho * rest);
        let outer = R::of(2.0) * power::<_, 3>(rest);
        rho.choose(R::of(0.5), inner, outer)
    }

    #[inline(always)]
    fn slope<R: Real>(self, v: R) -> R {
        let rho = ratio(v);
        let rest = v / (R::of(1.0) + rho);
        let inner = R::of(6.0) - R::of(9.0) * rho;
        let outer = R::of(3.0) * rest * rest / rho;
        rho.choose(R::of(0.5), inner, outer)
    }

    #[inline(always)]
    fn bend<R: Real>(self, v: R) -> R {
        let rho = ratio(v);
        let inner = R::of(4.5) / rho;
        let outer = R::of(1.5) * v / (rho * rho * rho);
        rho.choose(R::of(0.5), inner, outer)
    }

    fn peak(self) -> (f64, f64) {
        (2.25, 0.75)
    }
}

/// A quintic B-spline M₆ of r, of which the support radius is three times the smoothing length h (Morris
/// 1996, Analysis of smoothed particle hydrodynamics with applications): with q = 3r/R,
/// ((3 − q)⁵ − 6(2 − q)⁵ + 15(1 − q)⁵)/66, each power as long as it is positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QuinticSpline;

impl QuinticSpline {
    /// q, 3 − q and 2 − q, which is 0 where it would be negative.
    #[inline(always)]
    fn parts<R: Real>(v: R) -> (R, R, R) {
        let rho = ratio(v);
        let outer = R::of(3.0) * v / (R::of(1.0) + rho);
        (R::of(3.0) * rho, outer, (outer - R::of(1.0)).at_least(R::of(0.0)))
    }
}

impl Profile for QuinticSpline {
    #[inline(always)]
    fn value<R: Real>(self, v: R) -> R {
        let (q, a, b) = Self::parts(v);
        let square = q * q;
        let inner = R::of(66.0) - square * (R::of(60.0) - square * (R::of(30.0) - R::of(10.0) * q));
        let outer = power::<_, 5>(a) - R::of(6.0) * power::<_, 5>(b);
        q.choose(R::of(1.0), inner, outer) * R::of(1.0 / 66.0)
    }

    #[inline(always)]
    fn slope<R: Real>(self, v: R) -> R {
        let (q, a, b) = Self::parts(v);
        let inner = R::of(60.0) - q * q * (R::of(60.0) - R::of(25.0) * q);
        let outer = (R::of(2.5) * power::<_, 4>(a) - R::of(15.0) * power::<_, 4>(b)) / q;
        q.choose(R::of(1.0), inner, outer) * R::of(9.0 / 66.0)
    }

    #[inline(always)]
    fn bend<R: Real>(self, v: R) -> R {
        let (q, a, b) = Self::parts(v);
        let inner = R::of(60.0) - R::of(37.5) * q;
        let fourth = R::of(1.25) * power::<_, 4>(a) - R::of(7.5) * power::<_, 4>(b);
        let third = R::of(5.0) * power::<_, 3>(a) - R::of(30.0) * power::<_, 3>(b);
        let outer = (third + fourth / q) / (q * q);
        q.choose(R::of(1.0), inner, outer) * R::of(81.0 / 66.0)
    }

    fn peak(self) -> (f64, f64) {
        (3.106_739, 0.870_983)
    }
}

/// Wendland's function of smoothness C² in three dimensions (Wendland 1995, Piecewise polynomial, positive
/// definite and compactly supported radial functions of minimal degree): (1 − ρ)⁴(1 + 4ρ), ρ = r/R. SPH codes
/// (Dehnen and Aly 2012) take the support radius for twice the smoothing length, or give it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WendlandC2;

impl Profile for WendlandC2 {
    #[inline(always)]
    fn value<R: Real>(self, v: R) -> R {
        let rho = ratio(v);
        power::<_, 4>(v / (R::of(1.0) + rho)) * (R::of(1.0) + R::of(4.0) * rho)
    }

    #[inline(always)]
    fn slope<R: Real>(self, v: R) -> R {
        R::of(10.0) * power::<_, 3>(v / (R::of(1.0) + ratio(v)))
    }

    #[inline(always)]
    fn bend<R: Real>(self, v: R) -> R {
        let rho = ratio(v);
        R::of(15.0) * power::<_, 2>(v / (R::of(1.0) + rho)) / rho
    }

    fn peak(self) -> (f64, f64) {
        (20.0 / 9.0, 8.0 / 9.0)
    }
}

/// Wendland's function of smoothness C⁴ in three dimensions: (1 − ρ)⁶(1 + 6ρ + 35/3 ρ²), ρ = r/R.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WendlandC4;

impl Profile for WendlandC4 {
    #[inline(always)]
    fn value<R: Real>(self, v: R) -> R {
        let rho = ratio(v);
        let factor = R::of(1.0) + rho * (R::of(6.0) + R::of(35.0 / 3.0) * rho);
        power::<_, 6>(v / (R::of(1.0) + rho)) * factor
    }

    #[inline(always)]
    fn slope<R: Real>(self, v: R) -> R {
        let rho = ratio(v);
        let factor = R::of(28.0 / 3.0) * (R::of(1.0) + R::of(5.0) * rho);
        power::<_, 5>(v / (R::of(1.0) + rho)) * factor
    }

    #[inline(always)]
    fn bend<R: Real>(self, v: R) -> R {
        R::of(140.0) * power::<_, 4>(v / (R::of(1.0) + ratio(v)))
    }

    fn peak(self) -> (f64, f64) {
        (140.0 * 16.0 / 729.0, 8.0 / 9.0)
    }
}

/// Wendland's function of smoothness C⁶ in three dimensions: (1 − ρ)⁸(1 + 8ρ + 25ρ² + 32ρ³), ρ = r/R.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WendlandC6;

impl Profile for WendlandC6 {
    #[inline(always)]
    fn value<R: Real>(self, v: R) -> R {
        let rho = ratio(v);
        let factor = R::of(1.0) + rho * (R::of(8.0) + rho * (R::of(25.0) + R::of(32.0) * rho));
        power::<_, 8>(v / (R::of(1.0) + rho)) * factor
    }

    #[inline(always)]
    fn slope<R: Real>(self, v: R) -> R {
        let rho = ratio(v);
        let factor = R::of(11.0) * (R::of(1.0) + rho * (R::of(7.0) + R::of(16.0) * rho));
        power::<_, 7>(v / (R::of(1.0) + rho)) * factor
    }

    #[inline(always)]
    fn bend<R: Real>(self, v: R) -> R {
        let rho = ratio(v);
        let factor = R::of(132.0) * (R::of(1.0) + R::of(6.0) * rho);
        power::<_, 6>(v / (R::of(1.0) + rho)) * factor
    }

    fn peak(self) -> (f64, f64) {
        (3.916_337, 0.906_267)
    }
}

/// A Gaussian of r, cut where r is `cut` times its standard deviation and lowered to reach 0 there:
/// (e^{cv} − 1)/(eᶜ − 1), c = cut²/2. Its slope jumps at the rim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaussian {
    /// c: how far down the cut is, in powers of e.
    exponent: f64,
    /// 1/(eᶜ − 1).
    scale: f64,
}

impl Gaussian {
    /// The Gaussian that is cut at so many standard deviations.
    pub(super) fn cut_at(deviations: f64) -> Self {
        let exponent = 0.5 * deviations * deviations;
        Self { exponent, scale: 1.0 / (Real::exp(exponent) - 1.0) }
    }

    /// The same, of which the scale is known.
    #[inline]
    pub(super) fn of_scale(deviations: f64, scale: f64) -> Self {
        Self { exponent: 0.5 * deviations * deviations, scale }
    }

    /// c: how far down the cut is, in powers of e.
    pub fn exponent(self) -> f64 {
        self.exponent
    }

    /// 1/(eᶜ − 1).
    pub fn scale(self) -> f64 {
        self.scale
    }
}

impl Profile for Gaussian {
    #[inline(always)]
    fn value<R: Real>(self, v: R) -> R {
        ((R::of(self.exponent) * v).exp() - R::of(1.0)) * R::of(self.scale)
    }

    #[inline(always)]
    fn slope<R: Real>(self, v: R) -> R {
        (R::of(self.exponent) * v).exp() * R::of(self.scale * self.exponent)
    }

    #[inline(always)]
    fn bend<R: Real>(self, v: R) -> R {
        (R::of(self.exponent) * v).exp() * R::of(self.scale * self.exponent * self.exponent)
    }

    /// At 1 − v = 1/c.
    fn peak(self) -> (f64, f64) {
        let away = self.exponent.recip().min(1.0);
        (away * self.bend(1.0 - away), 1.0 - away)
    }
}

/// Any of them: code for it is compiled once, and asks which one it is at each value.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "each is said at the type that it holds")]
pub enum AnyProfile {
    Power(Power),
    Wyvill(Wyvill),
    CubicSpline(CubicSpline),
    QuinticSpline(QuinticSpline),
    WendlandC2(WendlandC2),
    WendlandC4(WendlandC4),
    WendlandC6(WendlandC6),
    Gaussian(Gaussian),
}

/// What an expression gives for the profile that it is.
macro_rules! of_each {
    ($any:expr, $profile:ident => $result:expr) => {
        match $any {
            AnyProfile::Power($profile) => $result,
            AnyProfile::Wyvill($profile) => $result,
            AnyProfile::CubicSpline($profile) => $result,
            AnyProfile::QuinticSpline($profile) => $result,
            AnyProfile::WendlandC2($profile) => $result,
            AnyProfile::WendlandC4($profile) => $result,
            AnyProfile::WendlandC6($profile) => $result,
            AnyProfile::Gaussian($profile) => $result,
        }
    };
}

impl Profile for AnyProfile {
    #[inline(always)]
    fn value<R: Real>(self, v: R) -> R {
        of_each!(self, profile => profile.value(v))
    }

    #[inline(always)]
    fn slope<R: Real>(self, v: R) -> R {
        of_each!(self, profile => profile.slope(v))
    }

    #[inline(always)]
    fn value_and_slope<R: Real>(self, v: R) -> (R, R) {
        of_each!(self, profile => profile.value_and_slope(v))
    }

    #[inline(always)]
    fn bend<R: Real>(self, v: R) -> R {
        of_each!(self, profile => profile.bend(v))
    }

    fn peak(self) -> (f64, f64) {
        of_each!(self, profile => profile.peak())
    }
}

#[cfg(test)]
mod tests;
