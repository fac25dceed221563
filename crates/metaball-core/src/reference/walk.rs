//! The walk along a ray: where it enters and exits the first sheet of the solid, and how clearly.

use std::ops::ControlFlow;

use super::{
    bernstein::Bernstein,
    curved::Curved,
    interval::Interval,
    piece::{Piece, Trend},
};
use crate::Verdict;

/// Share of T to which maxima are found: what [`Truth::margin`](super::Truth) promises.
const MAXIMUM_TOLERANCE: f64 = 1e-9;

/// Share of T below which a piece that touches T is flat: a few tens of roundings, the error of the
/// field itself.
const CROSSING_TOLERANCE: f64 = 1e-14;

/// What has been seen of a ray so far.
pub(super) struct Walk {
    threshold: f64,
    state: State,
    /// Where the solid begins and ends, in t.
    entry: f64,
    exit: f64,
    /// The field at the start, or the greatest local maximum before the solid if that is higher.
    /// Below T unless the start is inside.
    highest_before: f64,
    /// The greatest field within the first sheet, as far as it matters to the margin.
    highest_inside: f64,
}

enum State {
    Before,
    Inside,
    After,
}

impl Walk {
    /// Begins at `t` with the field there.
    pub(super) fn new(threshold: f64, t: f64, at_start: f64) -> Self {
        let is_inside = at_start >= threshold;
        Self {
            threshold,
            state: if is_inside { State::Inside } else { State::Before },
            entry: if is_inside { t } else { f64::INFINITY },
            exit: f64::INFINITY,
            highest_before: at_start,
            highest_inside: at_start,
        }
    }

    /// Passes over the next interval if bounds of its balls show that nothing in it decides;
    /// otherwise does nothing and returns false.
    pub(super) fn skip(&mut self, interval: &Interval<'_>) -> bool {
        if let Some(trend) = interval.trend() {
            let (first, last) = (interval.field(0.0).0, interval.field(interval.length).0);
            match self.state {
                State::Before if first.max(last) < self.threshold => {
                    if trend == Trend::Falling {
                        self.highest_before = self.highest_before.max(first);
                    }
                    return true;
                }
                State::Inside if first.min(last) >= self.threshold => {
                    self.highest_inside = self.highest_inside.max(first).max(last);
                    return true;
                }
                _ => {}
            }
        }
        match self.state {
            State::Before => interval.stays_below(self.highest_before),
            State::Inside => {
                interval.stays_above(self.threshold)
                    && (self.is_inside_clear() || interval.stays_below(self.highest_inside))
            }
            State::After => true,
        }
    }

    /// Crosses the next segment, an interval without an event inside. Breaks where the first sheet
    /// has been left.
    pub(super) fn cross(&mut self, segment: &Interval<'_>) -> ControlFlow<()> {
        match segment.kernel.coefficients() {
            Some(kernel) => self.follow(segment, Bernstein::new(segment, kernel)),
            None => self.follow(segment, Curved::new(segment)),
        }
    }

    /// Ends the ray at `t`, with the field there.
    pub(super) fn end(&mut self, t: f64, field: f64) {
        match self.state {
            State::Before => self.highest_before = self.highest_before.max(field),
            State::Inside => self.exit = t,
            State::After => {}
        }
    }

    /// The verdict so far, and where the solid begins.
    pub(super) fn first_hit(&self) -> (Verdict, f64) {
        let verdict = match self.state {
            State::Before => Verdict::Miss,
            _ if self.highest_before >= self.threshold => Verdict::Inside,
            _ => Verdict::Hit,
        };
        (verdict, self.entry)
    }

    /// Where the first sheet ends, in t.
    pub(super) fn exit(&self) -> f64 {
        self.exit
    }

    /// The least distance of the field from T, in shares of T, over the points that decide.
    pub(super) fn margin(&self) -> f64 {
        let before = (self.threshold - self.highest_before).abs();
        let inside = match self.first_hit().0 {
            Verdict::Hit => self.highest_inside - self.threshold,
            _ => f64::INFINITY,
        };
        before.min(inside.max(0.0)) / self.threshold
    }

    /// Visits pieces front to back, halving those that are not settled.
    fn follow<P: Piece>(&mut self, segment: &Interval<'_>, whole: P) -> ControlFlow<()> {
        let (mut pending, rounding) = (vec![whole], segment.rounding());
        while let Some(piece) = pending.pop() {
            let (from, to) = piece.span();
            let (first, last) = piece.ends();
            // A step between neighbouring pieces is rounding: the crossing is where they meet.
            if matches!(self.state, State::Before) && first >= self.threshold {
                self.enter(segment.start + from);
            }
            if matches!(self.state, State::Inside) && first < self.threshold {
                return self.leave(segment.start + from);
            }

            let (low, high) = piece.range();
            if self.is_settled(low, high) {
                continue;
            }
            let middle = 0.5 * (from + to);
            let trend = piece.trend();
            if trend.is_none() && !self.is_flat(low, high, rounding) && from < middle && middle < to
            {
                let [first, second] = piece.split_at(middle);
                pending.extend([second, first]);
                continue;
            }

            match self.state {
                State::Before if last >= self.threshold => {
                    self.enter(segment.start + segment.crossing(self.threshold, from, to, true));
                    self.highest_inside = last;
                }
                // What rises is no maximum yet: the next piece, or the end of the ray, has it.
                State::Before if trend == Some(Trend::Rising) => {}
                State::Before => self.highest_before = self.highest_before.max(first).max(last),
                State::Inside if last < self.threshold => {
                    self.highest_inside = self.highest_inside.max(first);
                    let u = segment.crossing(self.threshold, from, to, false);
                    return self.leave(segment.start + u);
                }
                State::Inside => self.highest_inside = self.highest_inside.max(first).max(last),
                State::After => return ControlFlow::Break(()),
            }
        }
        ControlFlow::Continue(())
    }

    /// Whether a piece with these bounds can change neither the verdict nor the margin.
    fn is_settled(&self, low: f64, high: f64) -> bool {
        match self.state {
            State::Before => high < self.threshold && high <= self.highest_before,
            State::Inside => {
                low >= self.threshold && (self.is_inside_clear() || high <= self.highest_inside)
            }
            State::After => true,
        }
    }

    /// Whether the maximum inside no longer matters to the margin, which is the lesser of two
    /// distances from T: the one before the hit is less.
    fn is_inside_clear(&self) -> bool {
        self.highest_inside - self.threshold >= self.threshold - self.highest_before
    }

    /// Whether all values of a piece with these bounds are the same within the tolerances, and what
    /// `rounding` may be.
    fn is_flat(&self, low: f64, high: f64, rounding: f64) -> bool {
        let touches = low < self.threshold && high >= self.threshold;
        let tolerance = if touches { CROSSING_TOLERANCE } else { MAXIMUM_TOLERANCE };
        high - low <= (tolerance * self.threshold).max(rounding)
    }

    fn enter(&mut self, t: f64) {
        self.state = State::Inside;
        self.entry = t;
        self.highest_inside = self.threshold;
    }

    fn leave(&mut self, t: f64) -> ControlFlow<()> {
        self.state = State::After;
        self.exit = t;
        ControlFlow::Break(())
    }
}
