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

use super::super::kernel::LaneKernel;
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
    /// The quadratic for a kernel on ranges from `low` < 1 to `high`.
    #[inline(always)]
    pub(super) fn new<K: LaneKernel<N>, const N: usize>(
        kernel: K,
        low: Lanes<f32>,
        high: Lanes<f32>,
    ) -> Self {
        let zero = Lanes::splat(0.0f32);
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let offset = half * NODE;
        let below = kernel.value((middle - offset).max(zero));
        let center = kernel.value(middle.max(zero));
        let above = kernel.value((middle + offset).max(zero));
        let inverse = offset.map(f32::recip);
        let slope = (above - below) * inverse * 0.5;
        let curvature = (above + below - center * 2.0) * inverse * inverse * 0.5;
        let steepest = slope.map(f32::abs) + curvature.map(f32::abs) * half * 2.0;
        let (error, slope_error) = kernel.quadratic_errors(low, high);
        Self { middle, value: center, slope, curvature, steepest, error, slope_error }
    }
}

#[cfg(test)]
mod tests {
    use metaball_core::Kernel;

    use super::*;
    use crate::trace::certified::kernel::{ByKernel, by_kernel};

    const STEPS: usize = 400;

    /// The quadratic on a range of v.
    struct Range {
        low: f64,
        high: f64,
    }

    impl ByKernel for Range {
        type Output = Quadratic;

        fn run<K: LaneKernel<N>, const N: usize>(self, kernel: K) -> Quadratic {
            let lanes = |x: f64| Lanes::splat(x as f32);
            Quadratic::new(kernel, lanes(self.low), lanes(self.high))
        }
    }

    /// The greatest |k − p| and |k′ − p′| on a range over the bounds of them, in f64.
    fn excess(kernel: Kernel, low: f64, high: f64) -> [f64; 2] {
        let quadratic = by_kernel(kernel, Range { low, high }).expect("lanes have it");
        let one = |x: Lanes<f32>| f64::from(x.0[0]);
        let mut excess = [0.0f64; 2];
        for step in 0..=STEPS {
            let v = low + (high - low) * step as f64 / STEPS as f64;
            // At the rim itself some have two slopes.
            if v.abs() < 1e-9 {
                continue;
            }
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

    fn most_excess(kernel: Kernel) -> [f64; 2] {
        let mut most = [0.0f64; 2];
        for half in [0.03, 0.1, 0.3, 0.9] {
            for step in 1..240 {
                let low = 1.0 - 2.0 * half - step as f64 * 0.01;
                let found = excess(kernel, low, low + 2.0 * half);
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
        for kernel in Kernel::all().filter(|&kernel| kernel != Kernel::Perlin) {
            let [value, slope] = most_excess(kernel);
            assert!(value <= 1.0 && slope <= 1.0, "{kernel}: {value} {slope}");
            assert!(value > 0.2 && slope > 0.2, "{kernel}: {value} {slope}");
        }
    }
}
