//! v²(5 + 4v)/9.

use super::super::lanes::{Lanes, Mask, array_of};
use super::{Bounds, LaneKernel, Missed, Stretch, multiply, of_polynomial};

/// Wyvill's kernel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wyvill;

impl LaneKernel<7> for Wyvill {
    const BOUNDS_SLOPES: bool = false;
    const ROUNDINGS: usize = 0;

    #[inline(always)]
    fn value(self, v: Lanes<f32>) -> Lanes<f32> {
        v.map(|v| v * v * (5.0 + 4.0 * v) * (1.0 / 9.0))
    }

    #[inline(always)]
    fn slope(self, v: Lanes<f32>) -> Lanes<f32> {
        v.map(|v| v * (10.0 + 12.0 * v) * (1.0 / 9.0))
    }

    #[inline(always)]
    fn value_and_slope(self, v: Lanes<f64>) -> (Lanes<f64>, Lanes<f64>) {
        (
            v.map(|v| v * v * (5.0 + 4.0 * v) * (1.0 / 9.0)),
            v.map(|v| v * (10.0 + 12.0 * v) * (1.0 / 9.0)),
        )
    }

    #[inline(always)]
    fn bounds(self, v: &Stretch, strength: Lanes<f32>, _: Mask) -> Bounds<7> {
        let zero = Lanes::splat(0.0f32);
        let raised: [_; 3] = array_of(|k| v.v[k].max(zero));
        let factor = [raised[0], raised[1] * 2.0, raised[2]];
        let mut product = [zero; 7];
        for k in 0..3 {
            product[k] = factor[k] * strength;
        }
        multiply(&mut product, &factor, 2);
        let last = |v: Lanes<f32>, one: f32| v.map(|v| (5.0 * one + 4.0 * v) * (1.0 / 9.0));
        multiply(
            &mut product,
            &[last(factor[0], 1.0), last(factor[1], 2.0), last(factor[2], 1.0)],
            4,
        );
        let top = (v.top() + v.margin).max(zero);
        of_polynomial(product, self.slope(top), v, strength)
    }

    #[inline(always)]
    fn quadratic_errors(self, low: Lanes<f32>, high: Lanes<f32>) -> (Lanes<f32>, Lanes<f32>) {
        const PARTS: (f32, f32) = (5.0 / 9.0, 24.0 / 9.0);
        let Missed { jump, third, .. } = Missed::on(low, high);
        (jump.0 * PARTS.0 + third.0 * PARTS.1, jump.1 * PARTS.0 + third.1 * PARTS.1)
    }

    #[inline(always)]
    fn has_kink(self) -> bool {
        false
    }
}
