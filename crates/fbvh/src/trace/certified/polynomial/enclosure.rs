//! Polynomials above and below the field on an interval, with all rounding.

use super::super::bernstein::inverse_binomials;
use super::super::lanes::{Lanes, array_of};
use super::super::parabolas::{Parabolas, Sums, UNIT};
use super::super::query::{Crossing, Query};

/// Bernstein coefficients that enclose what is to cross zero upwards: F − T for an entry, T − F for an
/// exit.
pub(super) struct Enclosure<const N: usize> {
    pub(super) upper: [f64; N],
    pub(super) lower: [f64; N],
    /// At the interval's ends at least this: there the raised parabolas are the true ones.
    pub(super) ends: [f64; 2],
    /// Whether the field is a polynomial on the interval: no support's rim is in it.
    pub(super) is_exact: bool,
}

impl<const N: usize> Enclosure<N> {
    /// Encloses the field between `start` and `end`; `None` where rounding is as large as T.
    #[inline(always)]
    pub(super) fn new(
        query: &Query,
        parabolas: &[Parabolas],
        start: f32,
        end: f32,
    ) -> Option<Self> {
        let (start, end) = (Lanes::splat(start), Lanes::splat(end));
        let Sums { most, least, error, .. } = Sums::<N>::new(query.kernel, parabolas, start, end);
        let inverses = const { inverse_binomials::<N>() };
        // Products and sums of non-negative terms: one rounding each.
        let rounding = (parabolas.len() + 4 * N + 16) as f64 * f64::from(UNIT);
        let error = f64::from(error.sum()) * 1.0001;
        // NaN where margins overflow, of balls that are tiny compared with the leaf.
        if error.is_nan() || error >= query.threshold {
            return None;
        }
        let most: [f64; N] = array_of(|k| f64::from(most[k].sum()) * inverses[k]);
        let least: [f64; N] = array_of(|k| f64::from(least[k].sum()) * inverses[k]);
        let is_exact = most == least;
        let up = |c: f64| c * (1.0 + rounding) + error - query.threshold;
        let down = |c: f64| c * (1.0 - rounding) - error - query.threshold;
        let ends = [most[0], most[N - 1]];
        Some(match query.crossing {
            Crossing::Entry => Self {
                upper: array_of(|k| up(most[k])),
                lower: array_of(|k| down(least[k])),
                ends: array_of(|k| down(ends[k])),
                is_exact,
            },
            Crossing::Exit => Self {
                upper: array_of(|k| -down(least[k])),
                lower: array_of(|k| -up(most[k])),
                ends: array_of(|k| -up(ends[k])),
                is_exact,
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
