//! Polynomials above and below the field on an interval, lane by lane, with all rounding.

use super::super::bernstein::{inverse_binomials, right_of};
use super::super::kernel::LaneKernel;
use super::super::lanes::{Lanes, Mask, array_of};
use super::super::parabolas::{Parabolas, Sums, UNIT};
use super::super::query::Query;

/// Bernstein coefficients that enclose F − T, lane by lane.
pub(super) struct Enclosure<const N: usize> {
    pub(super) upper: [Lanes<f32>; N],
    pub(super) lower: [Lanes<f32>; N],
    /// At the interval's start at most this, and at its ends at least this.
    pub(super) start: Lanes<f32>,
    pub(super) ends: [Lanes<f32>; 2],
    /// Where the field rises on the interval.
    pub(super) increases: Mask,
    /// Where the field is a polynomial on the interval.
    pub(super) is_exact: Mask,
    /// Where rounding is less than T.
    pub(super) is_known: Mask,
}

/// What encloses the field along the rays.
pub(super) trait Encloses<const N: usize> {
    /// The field between `start` and `end`.
    fn enclosure(&self, start: Lanes<f32>, end: Lanes<f32>) -> Enclosure<N>;
}

/// The balls of a list, along the rays.
pub(super) struct OfBalls<'a, K> {
    pub(super) kernel: K,
    pub(super) query: &'a Query,
    pub(super) parabolas: &'a [Parabolas],
}

impl<K: LaneKernel<N>, const N: usize> Encloses<N> for OfBalls<'_, K> {
    #[inline(always)]
    fn enclosure(&self, start: Lanes<f32>, end: Lanes<f32>) -> Enclosure<N> {
        Enclosure::new(self, start, end)
    }
}

impl<const N: usize> Enclosure<N> {
    /// Encloses the field between `start` and `end`. Rounding as for a single ray, and 32u more for sums
    /// and products here, which are f32.
    #[inline(always)]
    fn new<K: LaneKernel<N>>(balls: &OfBalls<'_, K>, start: Lanes<f32>, end: Lanes<f32>) -> Self {
        let OfBalls { kernel, query, parabolas } = *balls;
        let sums = Sums::<N>::new(kernel, parabolas, start, end);
        let inverses = const { inverse_binomials::<N>() };
        let threshold = query.threshold as f32;
        let rounding = (parabolas.len() + 4 * N + 48 + K::ROUNDINGS) as f32 * UNIT;
        let error = sums.error.map(|error| error * 1.0001 + 8.0 * UNIT * threshold);
        // Differences err by as much of what they are of, and so does what they are rounded by.
        let rounded = sums.magnitude * (2.0 * rounding);
        let most: [_; N] = array_of(|k| sums.most[k] * inverses[k] as f32);
        let least: [_; N] = array_of(|k| sums.least[k] * inverses[k] as f32);
        let up = |c: Lanes<f32>| (c * (1.0 + rounding) + error).map(|c| c - threshold);
        let down = |c: Lanes<f32>| (c * (1.0 - rounding) - error - rounded).map(|c| c - threshold);
        let differs = (0..N).fold(Mask::NONE, |differs, k| differs | !most[k].is_at_most(least[k]));
        Self {
            upper: array_of(|k| up(most[k])),
            lower: array_of(|k| down(least[k])),
            start: up(sums.start),
            ends: [down(sums.ends[0]), down(sums.ends[1])],
            increases: if K::BOUNDS_SLOPES {
                let least = sums.steepness * (4.0 * rounding);
                least.is_less(sums.rise[0]) & least.is_less(sums.rise[1])
            } else {
                !sums.decreases
            },
            is_exact: !differs,
            is_known: error.is_less(Lanes::splat(threshold)),
        }
    }

    /// Where the signs of the true coefficients, wherever between the two they lie, change once, from
    /// below to above.
    #[inline(always)]
    pub(super) fn changes_sign_once(&self) -> Mask {
        let zero = Lanes::splat(0.0f32);
        let one = Lanes::splat(1u32);
        let count = |mut run: Mask, lanes: &mut dyn Iterator<Item = Mask>| {
            let mut count = Lanes::splat(0u32);
            for mask in lanes {
                run = run & mask;
                count += run & one;
            }
            count
        };
        let all = !Mask::NONE;
        let below = count(all, &mut self.upper.iter().map(|c| c.is_less(zero)));
        let above = count(all, &mut self.lower.iter().rev().map(|c| zero.is_less(*c)));
        let none = Lanes::splat(0u32);
        none.is_less(below)
            & none.is_less(above)
            & Lanes::splat(N as u32).is_at_most(below + above + one)
    }

    /// Where the control polygon of the upper polynomial first crosses zero upwards; 1 where nowhere.
    #[inline(always)]
    pub(super) fn polygon_crossing(&self) -> Lanes<f32> {
        let zero = Lanes::splat(0.0f32);
        let mut x = Lanes::splat(1.0f32);
        for k in (1..N).rev() {
            let (below, above) = (self.upper[k - 1], self.upper[k]);
            let share = below.zip(above, |below, above| below / (below - above));
            let at = share.map(|share| ((k - 1) as f32 + share) * (1.0 / (N - 1) as f32));
            x = (below.is_less(zero) & zero.is_at_most(above)).select(at, x);
        }
        x
    }

    /// Where the upper polynomials may first reach 0, never after the first root; 1 where they reach it nowhere,
    /// and 0 where they begin above it. As [`negative_until`](super::super::bernstein::negative_until).
    #[inline(always)]
    pub(super) fn negative_until(&self) -> Lanes<f32> {
        const CLIPS: usize = 2;
        let upper = &self.upper;
        let (zero, one) = (Lanes::splat(0.0f32), Lanes::splat(1.0f32));
        // Interpolations err by 3u of the largest coefficient, N − 1 of them in a restriction.
        let largest = upper.iter().fold(zero, |largest, c| largest.max(c.map(f32::abs)));
        let guard = largest * (8.0 * N as f32 * UNIT);
        let mut coefficients: [_; N] = array_of(|k| upper[k] + guard);
        let mut start = zero;
        for clip in 0..CLIPS {
            let first = coefficients[0];
            let steepest = (2..N).fold(coefficients[1] - first, |steepest, k| {
                ((coefficients[k] - first) * (1.0 / k as f32)).max(steepest)
            });
            let x = first.zip(steepest, |first, steepest| {
                let x = -first / ((N - 1) as f32 * steepest) * (1.0 - 1e-6);
                if steepest > 0.0 && x < 1.0 { x } else { 1.0 }
            });
            let x = x.max(zero);
            start = start + (one - start) * x;
            if clip + 1 < CLIPS {
                right_of(&mut coefficients, x);
            }
        }
        upper[0].is_less(zero).select(start, zero)
    }
}
