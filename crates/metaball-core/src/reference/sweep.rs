//! The order in which the intervals of a ray are visited.

use std::ops::ControlFlow;

use super::{
    chord::{Chord, Line},
    interval::Interval,
    walk::Walk,
};
use crate::Kernel;

/// Leads the walk along the line from its start to its end, or until its first sheet has been left.
///
/// Ends of chords are the *events* of a ray. An interval between two events is halved at the event in
/// the middle until it is settled or a segment. So thousands of chords that end close together, as those of
/// nearly coincident balls do, cost no more than their number times its logarithm.
pub(super) fn sweep(chords: &[Chord], line: &Line, kernel: Kernel, walk: &mut Walk) {
    let Line { start, end, .. } = *line;
    let mut events: Vec<f64> = chords
        .iter()
        .flat_map(|chord| [chord.start().max(start), chord.end().min(end)])
        .chain([start, end])
        .collect();
    events.sort_unstable_by(f64::total_cmp);
    events.dedup();
    let mut active: Vec<usize> = (0..chords.len()).collect();
    // A walk that ends early has seen what it needs.
    let _ = Sweep { chords, kernel, walk }.visit(&events, &mut active, 0);
}

struct Sweep<'a> {
    chords: &'a [Chord],
    kernel: Kernel,
    walk: &'a mut Walk,
}

impl Sweep<'_> {
    /// Visits the interval between the first and the last event. From `base` on, `stack` holds the chords that
    /// overlap it; below are those of the intervals around it.
    fn visit(&mut self, events: &[f64], stack: &mut Vec<usize>, base: usize) -> ControlFlow<()> {
        let &[start, .., end] = events else { return ControlFlow::Continue(()) };
        let interval = Interval {
            start,
            length: end - start,
            kernel: self.kernel,
            chords: self.chords,
            active: &stack[base..],
        };
        if self.walk.skip(&interval) {
            return ControlFlow::Continue(());
        }
        if events.len() == 2 {
            return self.walk.cross(&interval);
        }
        let half = events.len() / 2;
        for (events, start, end) in
            [(&events[..=half], start, events[half]), (&events[half..], events[half], end)]
        {
            let top = stack.len();
            for index in base..top {
                let chord = &self.chords[stack[index]];
                if chord.start() < end && chord.end() > start {
                    stack.push(stack[index]);
                }
            }
            self.visit(events, stack, top)?;
            stack.truncate(top);
        }
        ControlFlow::Continue(())
    }
}
