//! The frames of what moves.

use std::ops::Range;
use std::time::Duration;

use web_time::Instant;

use crate::subject::{Content, Subject};

/// The time between frames that are played, if building keeps up: 24 a second.
const INTERVAL: Duration = Duration::from_micros(1_000_000 / 24);

/// Which frame is shown, and whether the next ones follow.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Timeline {
    frames: Range<u32>,
    frame: u32,
    /// When the frame was shown, while it plays.
    shown: Option<Instant>,
}

impl Timeline {
    /// That of a subject, at its first frame.
    pub(crate) fn of(subject: &Subject) -> Self {
        match &subject.content {
            Content::Still(_) => Self::default(),
            Content::Moving(moving) => {
                let frames = moving.frames();
                Self { frame: frames.start, frames, shown: None }
            }
        }
    }

    /// Whether there are frames.
    pub fn is_moving(&self) -> bool {
        !self.frames.is_empty()
    }

    /// The frames that there are.
    pub fn frames(&self) -> Range<u32> {
        self.frames.clone()
    }

    /// The frame that is shown.
    pub fn frame(&self) -> u32 {
        self.frame
    }

    /// Whether it plays.
    pub fn is_playing(&self) -> bool {
        self.shown.is_some()
    }

    /// At another frame, or the nearest that there is.
    #[must_use]
    pub fn at(&self, frame: u32, now: Instant) -> Self {
        let last = self.frames.end.saturating_sub(1).max(self.frames.start);
        let frame = frame.clamp(self.frames.start, last);
        Self { frame, shown: self.shown.map(|_| now), ..self.clone() }
    }

    /// So many frames on, or back; after the last comes the first.
    #[must_use]
    pub fn stepped(&self, by: i64, now: Instant) -> Self {
        let count = (self.frames.len() as i64).max(1);
        let index = i64::from(self.frame) - i64::from(self.frames.start);
        let index = (index + by).rem_euclid(count) as u32;
        self.at(self.frames.start + index, now)
    }

    /// Playing, or not.
    #[must_use]
    pub fn playing(&self, plays: bool, now: Instant) -> Self {
        Self { shown: (plays && self.is_moving()).then_some(now), ..self.clone() }
    }

    /// The frame that comes next, if it plays.
    pub(crate) fn next(&self) -> Option<u32> {
        let now = self.shown?;
        Some(self.stepped(1, now).frame)
    }

    /// The next frame, when it is time for it.
    pub(crate) fn due(&self, now: Instant) -> Option<u32> {
        let is_due = now.duration_since(self.shown?) >= INTERVAL;
        self.next().filter(|_| is_due)
    }

    /// How long it is until then.
    pub(crate) fn wait(&self, now: Instant) -> Option<Duration> {
        Some(INTERVAL.saturating_sub(now.duration_since(self.shown?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timeline() -> Timeline {
        Timeline { frames: 3..6, frame: 3, shown: None }
    }

    #[test]
    fn steps_go_round_and_jumps_stop_at_the_ends() {
        let now = Instant::now();
        assert_eq!(timeline().stepped(-1, now).frame(), 5);
        assert_eq!(timeline().stepped(4, now).frame(), 4);
        assert_eq!(timeline().at(99, now).frame(), 5);
        assert_eq!(timeline().at(0, now).frame(), 3);
        let still = Timeline::default();
        assert!(!still.is_moving() && !still.playing(true, now).is_playing());
        assert_eq!(still.stepped(1, now).frame(), 0);
    }

    #[test]
    fn frames_are_due_in_their_time() {
        let start = Instant::now();
        assert_eq!(timeline().due(start + INTERVAL), None, "it does not play");
        let playing = timeline().playing(true, start);
        assert_eq!(playing.due(start + INTERVAL / 2), None);
        assert_eq!(playing.wait(start + INTERVAL / 2), Some(INTERVAL - INTERVAL / 2));
        assert_eq!(playing.due(start + INTERVAL), Some(4));
        assert_eq!(playing.next(), Some(4));
    }
}
