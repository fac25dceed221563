//! Polynomials above and below the field on an interval, with all rounding.

use super::super::bernstein::inverse_binomials;
use super::super::kernel::LaneKernel;
use super::super::lanes::{Lanes, array_of};
use super::super::parabolas::{BySign, Parabolas, Sums, UNIT};
use super::super::query::{Crossing, Query};

/// Bernstein coefficients that enclose what is to cross zero upwards: F − T for an entry, T − F for an
/// exit.
pub(super) struct Enclosure<const N: usize> {
    pub(super) upper: [f64; N],
    pub(super) lower: [f64; N],
    /// At the interval's start at most this, and at its ends at least this.
    pub(super) start: f64,
    pub(super) ends: [f64; 2],
    /// Whether the field is a polynomial on the interval: no support's rim is in it.
    pub(super) is_exact: bool,
    /// Whether it rises on the interval; where the kernel bounds slopes, and for an entry.
    pub(super) increases: bool,
}

/// Polynomials above and below what balls of one sign add or take away on an interval, with all rounding.
struct Part<const N: usize> {
    upper: [f64; N],
    lower: [f64; N],
    /// At the interval's start at most this, and at its ends at least this.
    start: f64,
    ends: [f64; 2],
    /// How far rounding of the parabolas can move it.
    error: f64,
    is_exact: bool,
    /// Values at the interval's ends of a line that its slope is nowhere below, where the kernel bounds slopes.
    rise: [f64; 2],
}

impl<const N: usize> Part<N> {
    /// Encloses the sum between `start` and `end`; `balls` are those of either sign, eight each.
    #[inline(always)]
    fn new<K: LaneKernel<N>>(
        kernel: K,
        parabolas: &[Parabolas],
        balls: usize,
        (start, end): (f32, f32),
    ) -> Self {
        let (start, end) = (Lanes::splat(start), Lanes::splat(end));
        let Sums { most, least, start: at_start, ends, error, magnitude, rise, steepness, .. } =
            Sums::<N>::new(kernel, parabolas, start, end);
        let inverses = const { inverse_binomials::<N>() };
        // Products and sums of non-negative terms: one rounding each. Differences err by as much of what they
        // are of, and so does what they are rounded by.
        let rounding = (balls + 4 * N + 16 + K::ROUNDINGS) as f64 * f64::from(UNIT);
        let error = f64::from(error.sum()) * 1.0001;
        let rounded = f64::from(magnitude.sum()) * (2.0 * rounding);
        let most: [f64; N] = array_of(|k| f64::from(most[k].sum()) * inverses[k]);
        let least: [f64; N] = array_of(|k| f64::from(least[k].sum()) * inverses[k]);
        let up = |c: f64| c * (1.0 + rounding) + error;
        let down = |c: f64| c * (1.0 - rounding) - error - rounded;
        let least_slope = f64::from(steepness.sum()) * 4.0 * rounding;
        Self {
            upper: array_of(|k| up(most[k])),
            lower: array_of(|k| down(least[k])),
            start: up(at_start.sum().into()),
            ends: array_of(|k| down(ends[k].sum().into())),
            error,
            is_exact: most == least,
            rise: array_of(|k| f64::from(rise[k].sum()) - least_slope),
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
            is_exact: self.is_exact && taken.is_exact,
            rise: [self.rise[0] + taken.rise[1], self.rise[1] + taken.rise[0]],
        }
    }
}

impl<const N: usize> Enclosure<N> {
    /// Encloses the field between `start` and `end`; `None` where rounding is as large as T.
    #[inline(always)]
    pub(super) fn new<K: LaneKernel<N>>(
        kernel: K,
        query: &Query,
        parabolas: &BySign,
        (start, end): (f32, f32),
    ) -> Option<Self> {
        let BySign { positive, negative } = parabolas;
        let balls = parabolas.len();
        let mut field = Part::new(kernel, positive, balls, (start, end));
        if !negative.is_empty() {
            field = field.less(&Part::new(kernel, negative, balls, (-end, -start)));
        }
        // NaN where margins overflow, of balls that are tiny compared with the leaf.
        if field.error.is_nan() || field.error >= query.threshold {
            return None;
        }
        let Part { upper, lower, start, ends, is_exact, rise, .. } = field;
        let excess = |c: f64| c - query.threshold;
        let (upper, lower) = (upper.map(excess), lower.map(excess));
        Some(match query.crossing {
            Crossing::Entry => Self {
                upper,
                lower,
                start: excess(start),
                ends: ends.map(excess),
                is_exact,
                increases: K::BOUNDS_SLOPES && rise.iter().all(|&rise| rise > 0.0),
            },
            Crossing::Exit => Self {
                upper: lower.map(|c| -c),
                lower: upper.map(|c| -c),
                start: -lower[0],
                ends: [-upper[0], -upper[N - 1]],
                is_exact,
                increases: false,
            },
        })
    }

    /// Whether the signs of the true coefficients, wherever between the two they lie, change once,
    /// from below to above.
    #[inline(always)]
    pub(super) fn changes_sign_once(&self) -> bool {
        let below = self.upper.iter().take_while(|&&c| c < 0.0).count();
        let above = self.lower.iter().rev().take_while(|&&c| c > 0.0).count();
        below >= 1 && above >= 1 && below + above + 1 >= N
    }

    /// Coefficients midway between the bounds.
    #[inline(always)]
    pub(super) fn middle(&self) -> [f64; N] {
        array_of(|k| 0.5 * (self.upper[k] + self.lower[k]))
    }
}
