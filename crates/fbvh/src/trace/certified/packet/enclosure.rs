//! Polynomials above and below the field on an interval, lane by lane, with all rounding.

use super::super::bernstein::{inverse_binomials, right_of};
use super::super::kernel::LaneKernel;
use super::super::lanes::{Lanes, Mask, array_of};
use super::super::parabolas::{BySign, Parabolas, Sums, UNIT};
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
    pub(super) parabolas: &'a BySign,
}

impl<K: LaneKernel<N>, const N: usize> Encloses<N> for OfBalls<'_, K> {
    #[inline(always)]
    fn enclosure(&self, start: Lanes<f32>, end: Lanes<f32>) -> Enclosure<N> {
        Enclosure::new(self, start, end)
    }
}

/// Polynomials above and below what balls of one sign add or take away on an interval, lane by lane, with all
/// rounding.
struct Part<const N: usize> {
    upper: [Lanes<f32>; N],
    lower: [Lanes<f32>; N],
    /// At the interval's start at most this, and at its ends at least this.
    start: Lanes<f32>,
    ends: [Lanes<f32>; 2],
    /// How far rounding of the parabolas can move it.
    error: Lanes<f32>,
    is_exact: Mask,
    /// Where no ball's part decreases.
    rises: Mask,
    /// Values at the interval's ends of a line that its slope is nowhere below, and what rounding may be of
    /// these; where the kernel bounds slopes.
    rise: [Lanes<f32>; 2],
    rise_error: Lanes<f32>,
}

impl<const N: usize> Part<N> {
    /// Encloses the sum between `start` and `end`; `balls` are those of either sign. Rounding as for a single
    /// ray, and 32u more for sums and products here, which are f32.
    #[inline(always)]
    fn new<K: LaneKernel<N>>(
        (kernel, threshold): (K, f32),
        parabolas: &[Parabolas],
        balls: usize,
        (start, end): (Lanes<f32>, Lanes<f32>),
    ) -> Self {
        let sums = Sums::<N>::new(kernel, parabolas, start, end);
        let inverses = const { inverse_binomials::<N>() };
        let rounding = (balls + 4 * N + 48 + K::ROUNDINGS) as f32 * UNIT;
        let error = sums.error.map(|error| error * 1.0001 + 8.0 * UNIT * threshold);
        // Differences err by as much of what they are of, and so does what they are rounded by.
        let rounded = sums.magnitude * (2.0 * rounding);
        let most: [_; N] = array_of(|k| sums.most[k] * inverses[k] as f32);
        let least: [_; N] = array_of(|k| sums.least[k] * inverses[k] as f32);
        let up = |c: Lanes<f32>| c * (1.0 + rounding) + error;
        let down = |c: Lanes<f32>| c * (1.0 - rounding) - error - rounded;
        let differs = (0..N).fold(Mask::NONE, |differs, k| differs | !most[k].is_at_most(least[k]));
        Self {
            upper: array_of(|k| up(most[k])),
            lower: array_of(|k| down(least[k])),
            start: up(sums.start),
            ends: [down(sums.ends[0]), down(sums.ends[1])],
            error,
            is_exact: !differs,
            rises: !sums.decreases,
            rise: sums.rise,
            rise_error: sums.steepness * (4.0 * rounding),
        }
    }

    /// What is left where a part is taken away that was enclosed [mirrored](BySign::negative).
    #[inline(always)]
    fn less(&self, taken: &Self) -> Self {
        let last = N - 1;
        Self {
            upper: array_of(|k| self.upper[k] - taken.lower[last - k]),
            lower: array_of(|k| self.lower[k] - taken.upper[last - k]),
            start: self.start - taken.ends[1],
            ends: [self.ends[0] - taken.upper[last], self.ends[1] - taken.start],
            error: self.error + taken.error,
            is_exact: self.is_exact & taken.is_exact,
            rises: self.rises & taken.rises,
            rise: [self.rise[0] + taken.rise[1], self.rise[1] + taken.rise[0]],
            rise_error: self.rise_error + taken.rise_error,
        }
    }
}

impl<const N: usize> Enclosure<N> {
    /// Encloses the field between `start` and `end`.
    #[inline(always)]
    fn new<K: LaneKernel<N>>(balls: &OfBalls<'_, K>, start: Lanes<f32>, end: Lanes<f32>) -> Self {
        let OfBalls { kernel, query, parabolas } = *balls;
        let BySign { positive, negative } = parabolas;
        let (balls, threshold) = (parabolas.len(), query.threshold as f32);
        let of = (kernel, threshold);
        let mut field = Part::new(of, positive, balls, (start, end));
        if !negative.is_empty() {
            let zero = Lanes::splat(0.0f32);
            let mirrored = (zero - end, zero - start);
            field = field.less(&Part::new(of, negative, balls, mirrored));
        }
        let Part { upper, lower, start, ends, error, is_exact, rises, rise, rise_error } = field;
        let excess = |c: Lanes<f32>| c.map(|c| c - threshold);
        Self {
            upper: upper.map(excess),
            lower: lower.map(excess),
            start: excess(start),
            ends: ends.map(excess),
            increases: if K::BOUNDS_SLOPES {
                rise_error.is_less(rise[0]) & rise_error.is_less(rise[1])
            } else {
                rises
            },
            is_exact,
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
