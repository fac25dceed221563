//! Whether a second run says the same as the first.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::Chart;
use harness::configuration::label;
use harness::record::{Record, Samples};

/// How the times of two runs compare.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Moved {
    /// Points that both runs have.
    pub points: usize,
    /// Those whose median moved by more than the spread of either run, the distance between its
    /// quartiles.
    pub moved: Vec<Move>,
}

/// A point that moved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Move {
    /// The scene.
    pub scene: String,
    /// The method, with its options.
    pub configuration: String,
    /// Median of the earlier run, milliseconds.
    pub before_ms: f64,
    /// Median of the later run, milliseconds.
    pub after_ms: f64,
}

impl Moved {
    /// Compares two runs point by point.
    pub fn between(before: &Chart, after: &Chart) -> Self {
        let mut compared = Self { points: 0, moved: Vec::new() };
        for group in &after.groups {
            let earlier = before
                .groups
                .iter()
                .find(|other| (&other.purpose, &other.spec) == (&group.purpose, &group.spec));
            for record in &group.records {
                let same = |other: &&Record| {
                    (&other.method, &other.options) == (&record.method, &record.options)
                };
                let Some(other) = earlier.and_then(|group| group.records.iter().find(same)) else {
                    continue;
                };
                if let (Some(now), Some(then)) = (&record.measured, &other.measured) {
                    compared.points += 1;
                    if is_moved(&then.frame_ms, &now.frame_ms) {
                        compared.moved.push(Move {
                            scene: record.scene.clone(),
                            configuration: label(&record.method, &record.options),
                            before_ms: then.frame_ms.median,
                            after_ms: now.frame_ms.median,
                        });
                    }
                }
            }
        }
        compared
    }
}

fn is_moved(then: &Samples, now: &Samples) -> bool {
    let spread = |samples: &Samples| samples.p75 - samples.p25;
    (now.median - then.median).abs() > spread(then).max(spread(now))
}

/// One sentence.
impl fmt::Display for Moved {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{} of {} points moved by more than their spread since the run before.",
            self.moved.len(),
            self.points
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_moves_when_it_leaves_the_spread() {
        let at = |middle: f64| Samples::new(vec![middle - 1.0, middle, middle + 1.0]);
        assert!(!is_moved(&at(10.0), &at(10.9)));
        assert!(is_moved(&at(10.0), &at(11.1)));
        assert!(is_moved(&at(10.0), &at(8.9)));
        let moved = Moved { points: 7, moved: Vec::new() };
        assert!(moved.to_string().starts_with("0 of 7 points"));
    }
}
