//! Which times differ between two runs of one chart.

use super::record::{Chart, Move, Moved};
use harness::configuration::label;
use harness::record::{Record, Samples};

/// Compares two runs point by point.
pub(super) fn moved(before: &Chart, after: &Chart) -> Moved {
    let mut compared = Moved { points: 0, moved: Vec::new() };
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

fn is_moved(then: &Samples, now: &Samples) -> bool {
    let spread = |samples: &Samples| samples.p75 - samples.p25;
    (now.median - then.median).abs() > spread(then).max(spread(now))
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
