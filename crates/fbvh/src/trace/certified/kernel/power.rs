//! v^α, α = (N − 1)/2.

use super::super::lanes::{Lanes, Mask, array_of};
use super::{Bounds, LaneKernel, Missed, Stretch, multiply, of_polynomial};

/// The power kernel of N coefficients along a ray.
#[derive(Debug, Clone, Copy)]
pub(super) struct Power;

impl<const N: usize> LaneKernel<N> for Power {
    const BOUNDS_SLOPES: bool = false;
    const ROUNDINGS: usize = 0;

    #[inline(always)]
    fn value(self, v: Lanes<f32>) -> Lanes<f32> {
        (1..(N - 1) / 2).fold(v, |product, _| product * v)
    }

    #[inline(always)]
    fn slope(self, v: Lanes<f32>) -> Lanes<f32> {
        let exponent = (N - 1) / 2;
        (1..exponent).fold(Lanes::splat(exponent as f32), |product, _| product * v)
    }

    #[inline(always)]
    fn value_and_slope(self, v: Lanes<f64>) -> (Lanes<f64>, Lanes<f64>) {
        let exponent = (N - 1) / 2;
        // Outside the support the slope is zero, of α = 1 too.
        let inside = v.map(|v| if v > 0.0 { 1.0 } else { 0.0 });
        let power = (1..exponent).fold(inside, |product, _| product * v);
        (power * v, power * exponent as f64)
    }

    #[inline(always)]
    fn bounds(self, v: &Stretch, strength: Lanes<f32>, _: Mask) -> Bounds<N> {
        let zero = Lanes::splat(0.0f32);
        let raised: [_; 3] = array_of(|k| v.v[k].max(zero));
        let factor = [raised[0], raised[1] * 2.0, raised[2]];
        let mut product = [zero; N];
        for k in 0..3 {
            product[k] = factor[k] * strength;
        }
        for degree in 1..(N - 1) / 2 {
            multiply(&mut product, &factor, 2 * degree);
        }
        let top = (v.top() + v.margin).max(zero);
        of_polynomial(product, LaneKernel::<N>::slope(self, top), v, strength)
    }

    #[inline(always)]
    fn quadratic_errors(self, low: Lanes<f32>, high: Lanes<f32>) -> (Lanes<f32>, Lanes<f32>) {
        let Missed { kink, jump, third, .. } = Missed::on(low, high);
        let exponent = (N - 1) / 2;
        match exponent {
            1 => kink,
            2 => jump,
            _ => {
                let greatest = high.max(Lanes::splat(0.0));
                let mut most = Lanes::splat((exponent * (exponent - 1) * (exponent - 2)) as f32);
                for _ in 3..exponent {
                    most = most * greatest;
                }
                (third.0 * most, third.1 * most)
            }
        }
    }

    #[inline(always)]
    fn has_kink(self) -> bool {
        N == 3
    }
}
