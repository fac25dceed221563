//! Stretches of a ray, and the order in which they are visited.

use std::ops::ControlFlow;

use super::{
    chord::{Bump, Chord},
    walk::{Trend, Walk},
};
use crate::Kernel;

/// A stretch of ray, `start` ≤ t ≤ `start + length`, with all balls whose chord overlaps it. Where
/// each chord covers all of it, no event lies inside: a *segment*.
pub(super) struct Stretch<'a> {
    pub(super) start: f64,
    pub(super) length: f64,
    pub(super) kernel: Kernel,
    chords: &'a [Chord],
    /// Indices of the chords that overlap the stretch.
    active: &'a [usize],
}

/// Leads the walk along the ray from 0 to `end`, until it has seen enough.
///
/// Stretches between two events, the ends of chords, are halved at the event in the middle until
/// they are settled or segments. So thousands of chords that end close together, as those of nearly
/// coincident balls do, cost no more than their number times its logarithm.
pub(super) fn sweep(chords: &[Chord], end: f64, kernel: Kernel, walk: &mut Walk) {
    let mut events: Vec<f64> = chords
        .iter()
        .flat_map(|chord| [chord.start().max(0.0), chord.end().min(end)])
        .chain([0.0, end])
        .collect();
    events.sort_unstable_by(f64::total_cmp);
    events.dedup();
    let mut active: Vec<usize> = (0..chords.len()).collect();
    // Whether the walk was broken off makes no difference here.
    let _ = Sweep { chords, kernel, walk }.visit(&events, &mut active, 0);
}

struct Sweep<'a> {
    chords: &'a [Chord],
    kernel: Kernel,
    walk: &'a mut Walk,
}

impl Sweep<'_> {
    /// Visits the stretch between the first and the last event. `stack` holds from `base` on the
    /// chords that overlap it; below are those of the stretches around it.
    fn visit(&mut self, events: &[f64], stack: &mut Vec<usize>, base: usize) -> ControlFlow<()> {
        let &[start, .., end] = events else { return ControlFlow::Continue(()) };
        let stretch = Stretch {
            start,
            length: end - start,
            kernel: self.kernel,
            chords: self.chords,
            active: &stack[base..],
        };
        if self.walk.skip(&stretch) {
            return ControlFlow::Continue(());
        }
        if events.len() == 2 {
            return self.walk.cross(&stretch);
        }
        let half = events.len() / 2;
        for (events, start, end) in
            [(&events[..=half], start, events[half]), (&events[half..], events[half], end)]
        {
            let top = stack.len();
            for place in base..top {
                let chord = &self.chords[stack[place]];
                if chord.start() < end && chord.end() > start {
                    stack.push(stack[place]);
                }
            }
            self.visit(events, stack, top)?;
            stack.truncate(top);
        }
        ControlFlow::Continue(())
    }
}

impl Stretch<'_> {
    /// The balls, in u = t − `start`.
    pub(super) fn bumps(&self) -> impl Iterator<Item = Bump> {
        self.active.iter().map(|&index| self.chords[index].seen_from(self.start))
    }

    /// Field and its derivative by u.
    pub(super) fn field(&self, u: f64) -> (f64, f64) {
        self.bumps().fold((0.0, 0.0), |(value, slope), bump| {
            let squared_ratio = 1.0 - bump.depth(u);
            let turn = 2.0 * bump.steepness * (u - bump.middle);
            (
                value + bump.strength * self.kernel.value(squared_ratio),
                slope + bump.strength * self.kernel.slope(squared_ratio) * turn,
            )
        })
    }

    /// The direction, if all balls rise throughout or all fall.
    pub(super) fn trend(&self) -> Option<Trend> {
        if self.bumps().all(|bump| bump.middle >= self.length) {
            Some(Trend::Rising)
        } else if self.bumps().all(|bump| bump.middle <= 0.0) {
            Some(Trend::Falling)
        } else {
            None
        }
    }

    /// Bounds of the field on \[a, b\]: the sum of the exact range of each ball, which rises to the
    /// middle of its chord and falls from there.
    pub(super) fn range(&self, a: f64, b: f64) -> (f64, f64) {
        self.bumps().fold((0.0, 0.0), |(low, high), bump| {
            (low + self.least(&bump, a, b), high + self.greatest(&bump, a, b))
        })
    }

    /// Whether these bounds keep the field at or above `level` on the whole stretch. Looks at no
    /// more balls than it takes.
    pub(super) fn stays_above(&self, level: f64) -> bool {
        let mut low = 0.0;
        self.bumps().any(|bump| {
            low += self.least(&bump, 0.0, self.length);
            low >= level
        })
    }

    /// Whether they keep it at or below `level`.
    pub(super) fn stays_below(&self, level: f64) -> bool {
        let mut high = 0.0;
        self.bumps().all(|bump| {
            high += self.greatest(&bump, 0.0, self.length);
            high <= level
        })
    }

    /// The farther from the middle of its chord, the less of a ball.
    fn least(&self, bump: &Bump, a: f64, b: f64) -> f64 {
        self.value(bump, if bump.middle - a > b - bump.middle { a } else { b })
    }

    fn greatest(&self, bump: &Bump, a: f64, b: f64) -> f64 {
        self.value(bump, bump.middle.max(a).min(b))
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
impl<'a> Stretch<'a> {
    /// One ball alone, from rim to rim.
    pub(super) fn of(chord: &'a Chord, kernel: Kernel) -> Self {
        let (start, length) = (chord.start(), chord.end() - chord.start());
        Self { start, length, kernel, chords: std::slice::from_ref(chord), active: &[0] }
    }
}
