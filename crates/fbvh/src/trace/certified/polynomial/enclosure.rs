//! Polynomials above and below the field on an interval, with all rounding.

use super::super::bernstein::inverse_binomials;
use super::super::kernel::LaneKernel;
use super::super::lanes::{Lanes, array_of};
use super::super::parabolas::{Parabolas, Sums, UNIT};
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

impl<const N: usize> Enclosure<N> {
    /// Encloses the field between `start` and `end`; `None` where rounding is as large as T.
    #[inline(always)]
    pub(super) fn new<K: LaneKernel<N>>(
        kernel: K,
        query: &Query,
        parabolas: &[Parabolas],
        (start, end): (f32, f32),
    ) -> Option<Self> {
        let (start, end) = (Lanes::splat(start), Lanes::splat(end));
        let Sums { most, least, start: at_start, ends, error, magnitude, rise, steepness, .. } =
            Sums::<N>::new(kernel, parabolas, start, end);
        let inverses = const { inverse_binomials::<N>() };
        // Products and sums of non-negative terms: one rounding each. Differences err by as much of what they
        // are of, and so does what they are rounded by.
        let rounding = (parabolas.len() + 4 * N + 16 + K::ROUNDINGS) as f64 * f64::from(UNIT);
        let error = f64::from(error.sum()) * 1.0001;
        let rounded = f64::from(magnitude.sum()) * (2.0 * rounding);
        // NaN where margins overflow, of balls that are tiny compared with the leaf.
        if error.is_nan() || error >= query.threshold {
            return None;
        }
        let most: [f64; N] = array_of(|k| f64::from(most[k].sum()) * inverses[k]);
        let least: [f64; N] = array_of(|k| f64::from(least[k].sum()) * inverses[k]);
        let is_exact = most == least;
        let up = |c: f64| c * (1.0 + rounding) + error - query.threshold;
        let down = |c: f64| c * (1.0 - rounding) - error - rounded - query.threshold;
        let least_slope = f64::from(steepness.sum()) * 4.0 * rounding;
        let rise = rise.map(|rise| f64::from(rise.sum()));
        Some(match query.crossing {
            Crossing::Entry => Self {
                upper: array_of(|k| up(most[k])),
                lower: array_of(|k| down(least[k])),
                start: up(at_start.sum().into()),
                ends: array_of(|k| down(ends[k].sum().into())),
                is_exact,
                increases: K::BOUNDS_SLOPES && rise.iter().all(|&rise| rise > least_slope),
            },
            Crossing::Exit => Self {
                upper: array_of(|k| -down(least[k])),
                lower: array_of(|k| -up(most[k])),
                start: -down(least[0]),
                ends: [-up(most[0]), -up(most[N - 1])],
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
