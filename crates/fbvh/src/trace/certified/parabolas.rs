//! Balls along rays, and sums over them that enclose the field on an interval, lane by lane: eight
//! balls on one ray, or one ball on eight rays.

use metaball_core::Kernel;

use super::kernel::{coefficients, slope};
use super::lanes::{Lanes, Mask, array_of};

/// u: half a unit in the last place of 1.
pub(super) const UNIT: f32 = f32::EPSILON / 2.0;

/// v = 1 − r²/R² = `constant` + `linear`·t − `square`·t² in every lane, with t from a nearby origin.
#[derive(Debug, Clone)]
pub(super) struct Parabolas {
    pub(super) constant: Lanes<f32>,
    pub(super) linear: Lanes<f32>,
    pub(super) square: Lanes<f32>,
    /// How far rounding can move v on the ray's interval in the leaf.
    pub(super) margin: Lanes<f32>,
    /// The same for dv/dt.
    pub(super) slope_margin: Lanes<f32>,
    pub(super) strength: Lanes<f32>,
}

/// Sums over balls on an interval, each lane by itself.
pub(super) struct Sums<const N: usize> {
    /// Coefficients, times their binomials, of a polynomial nowhere below the field but for rounding.
    pub(super) most: [Lanes<f32>; N],
    /// The same nowhere above it.
    pub(super) least: [Lanes<f32>; N],
    /// How far rounding of the parabolas can move the field.
    pub(super) error: Lanes<f32>,
    /// Where some ball's part of the field may decrease before the interval's end.
    pub(super) decreases: Mask,
}

impl<const N: usize> Sums<N> {
    /// The sums over all parabolas between `start` and `end`.
    #[inline(always)]
    pub(super) fn new(
        kernel: Kernel,
        parabolas: &[Parabolas],
        start: Lanes<f32>,
        end: Lanes<f32>,
    ) -> Self {
        let zero = Lanes::splat(0.0f32);
        let (mut most, mut least) = ([zero; N], [zero; N]);
        let (mut error, mut decreases) = (zero, Mask::NONE);
        let (start_square, product, end_square) = (start * start, start * end, end * end);
        let middle = (start + end) * 0.5;
        for ball in parabolas {
            let at = |t: Lanes<f32>, square| ball.constant + ball.linear * t - ball.square * square;
            // The Bernstein coefficients of v: its values at the ends and, between them, its polar form.
            let v = [at(start, start_square), at(middle, product), at(end, end_square)];
            let top = v[0].max(v[1]).max(v[2]) + ball.margin;
            let reaches = !top.is_at_most(zero);
            if !reaches.any() {
                continue;
            }
            let covers = ball.margin.is_at_most(v[0].min(v[2]));
            let terms = coefficients::<N>(kernel, array_of(|k| v[k].max(zero)), ball.strength);
            for k in 0..N {
                most[k] += terms[k];
                least[k] += covers.select(terms[k], zero);
            }
            error += ball.strength * ball.margin * slope::<N>(kernel, top.max(zero));
            let end_slope = ball.linear - ball.square * end * 2.0;
            decreases = decreases | reaches & !ball.slope_margin.is_at_most(end_slope);
        }
        Self { most, least, error, decreases }
    }
}
