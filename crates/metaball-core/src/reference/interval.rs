//! The field on an interval of a ray.

use super::{
    chord::{Bump, Chord},
    piece::Trend,
};
use crate::Kernel;

/// An interval of a ray, `start` ≤ t ≤ `start + length`, with all balls whose chord overlaps it. One
/// that each of these chords covers whole, so that no chord ends inside, is a *segment*.
pub(super) struct Interval<'a> {
    pub(super) start: f64,
    pub(super) length: f64,
    pub(super) kernel: Kernel,
    pub(super) chords: &'a [Chord],
    /// Indices of the chords that overlap the interval, those of negative balls first.
    pub(super) active: &'a [usize],
}

impl Interval<'_> {
    /// The balls, in u = t − `start`.
    pub(super) fn bumps(&self) -> impl Iterator<Item = Bump> {
        self.active.iter().map(|&index| self.chords[index].relative_to(self.start))
    }

    /// Field and its derivative by u; in a segment, at whose ends some kernels have kinks, that from inside.
    pub(super) fn field(&self, u: f64) -> (f64, f64) {
        const INSIDE: f64 = 1.0 - f64::EPSILON / 2.0;
        self.bumps().fold((0.0, 0.0), |(value, slope), bump| {
            let squared_ratio = (1.0 - bump.depth(u)).min(INSIDE);
            let turn = 2.0 * bump.steepness * (u - bump.middle);
            (
                value + bump.strength * self.kernel.value(squared_ratio),
                slope + bump.strength * self.kernel.slope(squared_ratio) * turn,
            )
        })
    }

    /// The direction, if all parts of the field rise throughout or all fall.
    pub(super) fn trend(&self) -> Option<Trend> {
        let (before, behind) =
            (|bump: &Bump| bump.middle >= self.length, |bump: &Bump| bump.middle <= 0.0);
        if self.bumps().all(|bump| if bump.adds() { before(&bump) } else { behind(&bump) }) {
            Some(Trend::Rising)
        } else if self.bumps().all(|bump| if bump.adds() { behind(&bump) } else { before(&bump) }) {
            Some(Trend::Falling)
        } else {
            None
        }
    }

    /// Bounds of the field on \[a, b\]: the sum of the exact ranges of the balls, each of which rises
    /// to the middle of its chord and falls from there, or the other way round if it is negative.
    pub(super) fn range(&self, a: f64, b: f64) -> (f64, f64) {
        self.bumps().fold((0.0, 0.0), |(low, high), bump| {
            (low + self.least(&bump, a, b), high + self.greatest(&bump, a, b))
        })
    }

    /// Whether the balls' exact ranges keep the field at or above a positive `level` on the whole interval.
    /// Stops at the first ball that settles it: from where sums are positive on they only rise.
    pub(super) fn stays_above(&self, level: f64) -> bool {
        let mut low = 0.0;
        self.bumps().any(|bump| {
            low += self.least(&bump, 0.0, self.length);
            low >= level
        })
    }

    /// Whether they keep the field at or below `level` on the whole interval.
    pub(super) fn stays_below(&self, level: f64) -> bool {
        let mut high = 0.0;
        let is_settled = self.bumps().any(|bump| {
            high += self.greatest(&bump, 0.0, self.length);
            bump.adds() && high > level
        });
        !is_settled && high <= level
    }

    /// How far rounding may move the field for what negative balls take away: twice what
    /// [`Bernstein`](super::bernstein::Bernstein) errs by.
    pub(super) fn rounding(&self) -> f64 {
        let negative = self.bumps().take_while(|bump| !bump.adds());
        let taken = negative.fold(0.0, |taken, bump| taken - self.least(&bump, 0.0, self.length));
        2.0 * f64::EPSILON * (self.active.len() as f64 + 50.0) * taken
    }

    /// The ball's least value on \[a, b\].
    fn least(&self, bump: &Bump, a: f64, b: f64) -> f64 {
        self.value(bump, if bump.adds() { bump.farthest(a, b) } else { bump.nearest(a, b) })
    }

    /// The ball's greatest value on \[a, b\].
    fn greatest(&self, bump: &Bump, a: f64, b: f64) -> f64 {
        self.value(bump, if bump.adds() { bump.nearest(a, b) } else { bump.farthest(a, b) })
    }

    fn value(&self, bump: &Bump, u: f64) -> f64 {
        bump.strength * self.kernel.value(1.0 - bump.depth(u))
    }

    /// Where the field crosses `level` between `low` and `high`, given that it is below at `low`
    /// and not below at `high` (`rising`), or the other way round. By Newton's method, halving
    /// where that does not at least halve the step ("rtsafe" of Press et al., Numerical Recipes,
    /// section 9.4).
    pub(super) fn crossing(&self, level: f64, mut low: f64, mut high: f64, rising: bool) -> f64 {
        let mut u = 0.5 * (low + high);
        let mut last_step = high - low;
        loop {
            let (value, slope) = self.field(u);
            if (value < level) == rising {
                low = u;
            } else {
                high = u;
            }
            let newton = u - (value - level) / slope;
            let is_good =
                newton > low && newton < high && (newton - u).abs() <= 0.5 * last_step.abs();
            let next = if is_good { newton } else { 0.5 * (low + high) };
            last_step = next - u;
            u = next;
            // Halving from an end of the bracket moves by half its width, so either kind of step
            // falls below the last float of t in the end.
            if last_step.abs() <= 0.5 * f64::EPSILON * u.max(f64::MIN_POSITIVE) || low >= high {
                return u;
            }
        }
    }
}

#[cfg(test)]
impl<'a> Interval<'a> {
    /// One ball alone, from rim to rim.
    pub(super) fn of(chord: &'a Chord, kernel: Kernel) -> Self {
        let (start, length) = (chord.start(), chord.end() - chord.start());
        Self { start, length, kernel, chords: std::slice::from_ref(chord), active: &[0] }
    }
}
