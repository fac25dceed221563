//! Kernels replaced by quadratics on a range of v, with what that errs by.
//!
//! The quadratic meets the kernel at the three Chebyshev nodes of the range, middle and middle ± κ·half,
//! κ = √3/2. With h half the range's length:
//! - where |k‴| ≤ M on it, k is missed by Mh³/24, the third of Chebyshev's polynomials over 3!, and k′ by
//!   9Mh²/24, its derivative (Shadrin 1995, Error bounds for Lagrange interpolation);
//! - v₊², whose second derivative jumps at 0, is missed by 0.113h² and its derivative by 0.792h, wherever
//!   the jump is; and with m the part of the range on the shorter side of 0, by m² and 2m;
//! - v₊, whose slope jumps, by h/6 and by m; its derivative by 1.
//!
//! The last two were found by a search over all places of the jump, which the tests repeat.

use metaball_core::Kernel;

use super::super::kernel::value;
use super::super::lanes::Lanes;

/// p(v) = `value` + `slope`·(v − `middle`) + `curvature`·(v − `middle`)² on a range of v.
pub(super) struct Quadratic {
    pub(super) middle: Lanes<f32>,
    pub(super) value: Lanes<f32>,
    pub(super) slope: Lanes<f32>,
    pub(super) curvature: Lanes<f32>,
    /// |p′| is nowhere more on the range.
    pub(super) steepest: Lanes<f32>,
    /// |k − p| is nowhere more, but for rounding.
    pub(super) error: Lanes<f32>,
    /// |k′ − p′| is nowhere more, but for rounding.
    pub(super) slope_error: Lanes<f32>,
}

/// Where the outer nodes are, in halves of the range from its middle.
const NODE: f32 = 0.866_025_4;

impl Quadratic {
    /// The quadratic for a kernel of this N on ranges from `low` < 1 to `high`.
    #[inline(always)]
    pub(super) fn new<const N: usize>(kernel: Kernel, low: Lanes<f32>, high: Lanes<f32>) -> Self {
        let zero = Lanes::splat(0.0f32);
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let offset = half * NODE;
        let below = value::<N>(kernel, (middle - offset).max(zero));
        let center = value::<N>(kernel, middle.max(zero));
        let above = value::<N>(kernel, (middle + offset).max(zero));
        let inverse = offset.map(f32::recip);
        let slope = (above - below) * inverse * 0.5;
        let curvature = (above + below - center * 2.0) * inverse * inverse * 0.5;
        let steepest = slope.map(f32::abs) + curvature.map(f32::abs) * half * 2.0;
        let (error, slope_error) = errors::<N>(kernel, low, high, half);
        Self { middle, value: center, slope, curvature, steepest, error, slope_error }
    }
}

/// What the quadratic and its derivative miss on ranges of this half length.
#[inline(always)]
fn errors<const N: usize>(
    kernel: Kernel,
    low: Lanes<f32>,
    high: Lanes<f32>,
    half: Lanes<f32>,
) -> (Lanes<f32>, Lanes<f32>) {
    let zero = Lanes::splat(0.0f32);
    // The shorter side of 0, where it is in the range.
    let beyond = high.min(zero - low).max(zero);
    // What a jump of the second derivative by 2 makes, and a third derivative of 1.
    let jump = ((half * half * 0.113).min(beyond * beyond), (half * 0.792).min(beyond * 2.0));
    let third = (half * half * half * (1.0 / 24.0), half * half * (9.0 / 24.0));
    match kernel {
        Kernel::Wyvill => {
            const PARTS: (f32, f32) = (5.0 / 9.0, 24.0 / 9.0);
            (jump.0 * PARTS.0 + third.0 * PARTS.1, jump.1 * PARTS.0 + third.1 * PARTS.1)
        }
        Kernel::Power(_) if N == 3 => {
            let slope = zero.is_less(beyond).select(Lanes::splat(1.0), zero);
            ((half * (1.0 / 6.0)).min(beyond), slope)
        }
        Kernel::Power(_) if N == 5 => jump,
        Kernel::Power(_) => {
            let exponent = (N - 1) / 2;
            let greatest = high.max(zero);
            let mut most = Lanes::splat((exponent * (exponent - 1) * (exponent - 2)) as f32);
            for _ in 3..exponent {
                most = most * greatest;
            }
            (third.0 * most, third.1 * most)
        }
        Kernel::Perlin => (Lanes::splat(f32::INFINITY), Lanes::splat(f32::INFINITY)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEPS: usize = 400;

    /// The greatest |k − p| and |k′ − p′| on a range over the bounds of them, in f64.
    fn excess<const N: usize>(kernel: Kernel, low: f64, high: f64) -> [f64; 2] {
        let lanes = |x: f64| Lanes::splat(x as f32);
        let quadratic = Quadratic::new::<N>(kernel, lanes(low), lanes(high));
        let one = |x: Lanes<f32>| f64::from(x.0[0]);
        let mut excess = [0.0f64; 2];
        for step in 0..=STEPS {
            let v = low + (high - low) * step as f64 / STEPS as f64;
            let away = v - one(quadratic.middle);
            let slope = one(quadratic.slope) + 2.0 * one(quadratic.curvature) * away;
            let value = one(quadratic.value)
                + (one(quadratic.slope) + one(quadratic.curvature) * away) * away;
            let s = 1.0 - v;
            let (k, dk) = if v > 0.0 { (kernel.value(s), -kernel.slope(s)) } else { (0.0, 0.0) };
            let half = 0.5 * (high - low);
            excess[0] = excess[0].max(((k - value).abs() - 1e-6) / one(quadratic.error));
            excess[1] =
                excess[1].max(((dk - slope).abs() - 1e-5 / half) / one(quadratic.slope_error));
            assert!(slope.abs() <= one(quadratic.steepest) * 1.0001 + 1e-6);
        }
        excess
    }

    fn most_excess<const N: usize>(kernel: Kernel) -> [f64; 2] {
        let mut most = [0.0f64; 2];
        for half in [0.03, 0.1, 0.3, 0.9] {
            for step in 1..240 {
                let low = 1.0 - 2.0 * half - step as f64 * 0.01;
                let found = excess::<N>(kernel, low, low + 2.0 * half);
                // Where the kernel is its quadratic the bound is 0.
                let number = |x: f64| if x.is_finite() { x } else { 0.0 };
                most = [most[0].max(number(found[0])), most[1].max(number(found[1]))];
            }
        }
        most
    }

    /// No kernel is missed by more than the bounds, and the bounds are not idle: some range comes close.
    #[test]
    fn kernels_are_missed_by_no_more() {
        let power = |exponent| Kernel::power(exponent).expect("legal");
        let all = [
            most_excess::<3>(power(1)),
            most_excess::<5>(power(2)),
            most_excess::<7>(power(3)),
            most_excess::<9>(power(4)),
            most_excess::<17>(power(8)),
            most_excess::<7>(Kernel::Wyvill),
        ];
        for (at, [value, slope]) in all.into_iter().enumerate() {
            assert!(value <= 1.0 && slope <= 1.0, "kernel {at}: {value} {slope}");
            assert!(value > 0.5 && slope > 0.5, "kernel {at}: {value} {slope}");
        }
    }
}
