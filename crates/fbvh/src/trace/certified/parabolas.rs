//! Balls along rays, and sums over them that enclose the field on an interval, lane by lane: eight
//! balls on one ray, or one ball on eight rays.

use super::kernel::{LaneKernel, Stretch};
use super::lanes::{Lanes, Mask};

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

/// The balls that reach an interval, those of either sign for themselves.
#[derive(Debug, Default)]
pub(super) struct BySign {
    pub(super) positive: Vec<Parabolas>,
    /// With strengths above 0 and mirrored at the origin, so that their parts of the field fall where what they
    /// leave of it rises: bounds of these are bounds of what is taken away, at −t.
    pub(super) negative: Vec<Parabolas>,
}

impl BySign {
    pub(super) fn clear(&mut self) {
        self.positive.clear();
        self.negative.clear();
    }

    pub(super) fn len(&self) -> usize {
        self.positive.len() + self.negative.len()
    }

    #[inline(always)]
    pub(super) fn push(&mut self, parabolas: Parabolas, is_negative: bool) {
        if is_negative {
            let zero = Lanes::splat(0.0f32);
            let (linear, strength) = (zero - parabolas.linear, zero - parabolas.strength);
            self.negative.push(Parabolas { linear, strength, ..parabolas });
        } else {
            self.positive.push(parabolas);
        }
    }
}

/// Sums over balls on an interval, each lane by itself.
pub(super) struct Sums<const N: usize> {
    /// Coefficients, times their binomials, of a polynomial nowhere below the field but for rounding.
    pub(super) most: [Lanes<f32>; N],
    /// The same nowhere above it.
    pub(super) least: [Lanes<f32>; N],
    /// At the interval's start the field is no more, and at its ends no less, but for rounding.
    pub(super) start: Lanes<f32>,
    pub(super) ends: [Lanes<f32>; 2],
    /// How far rounding of the parabolas can move the field.
    pub(super) error: Lanes<f32>,
    /// Of what size the numbers are whose differences the coefficients are; 0 where these are sums.
    pub(super) magnitude: Lanes<f32>,
    /// Where some ball's part of the field may decrease before the interval's end.
    pub(super) decreases: Mask,
    /// Values at the interval's ends of a line that the field's slope is nowhere below, and the size of the
    /// numbers that they are made of; where the kernel bounds slopes.
    pub(super) rise: [Lanes<f32>; 2],
    pub(super) steepness: Lanes<f32>,
}

impl<const N: usize> Sums<N> {
    /// The sums over all parabolas between `start` and `end`.
    #[inline(always)]
    pub(super) fn new<K: LaneKernel<N>>(
        kernel: K,
        parabolas: &[Parabolas],
        start: Lanes<f32>,
        end: Lanes<f32>,
    ) -> Self {
        let zero = Lanes::splat(0.0f32);
        let (mut most, mut least) = ([zero; N], [zero; N]);
        let (mut error, mut magnitude, mut decreases) = (zero, zero, Mask::NONE);
        let (mut at_start, mut ends) = (zero, [zero; 2]);
        let (mut rise, mut steepness) = ([zero; 2], zero);
        let (start_square, product, end_square) = (start * start, start * end, end * end);
        let middle = (start + end) * 0.5;
        for ball in parabolas {
            let at = |t: Lanes<f32>, square| ball.constant + ball.linear * t - ball.square * square;
            let slope_at = |t: Lanes<f32>| ball.linear - ball.square * t * 2.0;
            let at_peak = ball.linear * (ball.square * 2.0).map(f32::recip);
            let stretch = Stretch {
                peak: ball.constant + ball.linear * at_peak * 0.5,
                has_peak: start.is_less(at_peak) & at_peak.is_less(end),
                v: [at(start, start_square), at(middle, product), at(end, end_square)],
                slopes: [slope_at(start), slope_at(end)],
                margin: ball.margin,
                slope_margin: ball.slope_margin,
            };
            let reaches = !(stretch.top() + ball.margin).is_at_most(zero);
            if !reaches.any() {
                continue;
            }
            let bounds = kernel.bounds(&stretch, ball.strength, reaches);
            for k in 0..N {
                most[k] += bounds.most[k];
                least[k] += bounds.least[k];
            }
            at_start += bounds.start;
            error += bounds.error;
            magnitude += bounds.magnitude;
            decreases = decreases | reaches & !bounds.rises;
            for end in 0..2 {
                ends[end] += bounds.ends[end];
                rise[end] += bounds.rise[end];
            }
            steepness += bounds.steepness;
        }
        let start = at_start;
        Self { most, least, start, ends, error, magnitude, decreases, rise, steepness }
    }
}
