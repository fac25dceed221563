//! Which candidate is chosen: from measurements alone.

use metaball_core::Hit;
use metaball_core::reference::Truth;
use serde::{Deserialize, Serialize};

use crate::numbers::{decimal, grouped, small};
use crate::score::{Finding, Judgement};
use crate::stats::{quantile, sorted};

/// How far off a picture is along some rays.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Rays held against the oracle.
    pub rays: usize,
    /// Clear rays that are called a miss or a hit and are not, or hit a wrong front, or have no
    /// answer.
    pub wrong: usize,
    /// |Δt| over the scene's mean support radius that one hit in a hundred exceeds; 0 of no hits.
    pub p99: f64,
}

/// Rays for each of which one verdict may be wrong: with fewer, none.
const RAYS_A_WRONG_VERDICT: usize = 100_000;

impl Errors {
    /// Compares hits with the truth along the same rays.
    pub fn of<'a>(pairs: impl Iterator<Item = (&'a Truth, &'a Hit)>, mean_radius: f64) -> Self {
        let (mut rays, mut wrong, mut distances) = (0, 0, Vec::new());
        for (truth, hit) in pairs {
            let judgement = Judgement::new(truth, hit);
            let is_open = judgement.finding == Finding::Undecided && !judgement.ambiguous;
            rays += 1;
            wrong += usize::from(judgement.is_wrong() || is_open);
            if let Finding::Hit { error } = judgement.finding {
                distances.push(error * f64::from(truth.smallest_radius) / mean_radius);
            }
        }
        let p99 = quantile(&sorted(distances), 0.99).unwrap_or(0.0);
        Self { rays, wrong, p99 }
    }

    /// Whether this is right enough.
    pub fn keep(&self, max_error: f64) -> bool {
        self.p99 <= max_error && self.wrong * RAYS_A_WRONG_VERDICT <= self.rays
    }

    fn text(&self) -> String {
        format!(
            "99 of 100 hits within {} of the mean radius, {} of {} rays wrong",
            small(self.p99),
            grouped(self.wrong),
            grouped(self.rays)
        )
    }
}

/// What was measured of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// How far off it is.
    pub errors: Errors,
    /// Median milliseconds of a frame; infinite where it was not timed, being too far off.
    pub frame_ms: f64,
}

/// A configuration that can be chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Candidate<'a> {
    /// Name of the configuration.
    pub name: &'a str,
    /// Index of the candidate of which this is a cruder version, which gives error away for time.
    pub refines: Option<usize>,
}

/// Candidates whose whole pictures are drawn at a time.
pub const WHOLE_AT_A_TIME: usize = 4;

/// A crude version is drawn only of what takes at most so many times as long as the quickest that is
/// right enough: no knob is known to save more.
const CRUDE_SLACK: f64 = 1.5;

/// Nor is the whole picture drawn of what takes longer than this many times the quickest's sparse
/// picture: costs that do not grow with a picture weigh more in a sparse one, but not so much.
const WHOLE_SLACK: f64 = 4.0;

/// What was chosen, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// Name of the configuration.
    #[serde(rename = "setting")]
    pub configuration: String,
    /// The error that was allowed, mean support radii.
    pub max_error: f64,
    /// How far off the whole picture is, along rays that the sparse picture did not have.
    pub errors: Errors,
    /// Median milliseconds of a whole frame.
    pub frame_ms: f64,
    /// The next quicker that would do, and its milliseconds.
    pub runner_up: Option<(String, f64)>,
    /// Candidates that were not right enough or drew nothing, with the reason.
    pub left_out: Vec<(String, String)>,
}

/// Draws candidates, given by their indices, and measures their pictures; an error says why there is none.
pub trait Measure {
    /// A sparse picture.
    fn sparse(&mut self, candidate: usize) -> Result<Measurement, String>;

    /// Whole pictures, timed in turn, of candidates whose sparse pictures were right enough.
    fn whole(&mut self, candidates: &[usize]) -> Vec<Result<Measurement, String>>;
}

/// Chooses by what is measured: sparse pictures of all, but of crude versions only where what they
/// refine is right enough and quick; then whole pictures of the quickest few of those that are right
/// enough, until one still is. `Err`: the reasons why none is.
pub fn choose(
    candidates: &[Candidate<'_>],
    max_error: f64,
    measure: &mut impl Measure,
) -> Result<Choice, Vec<(String, String)>> {
    let name = |index: usize| candidates[index].name.to_owned();
    let mut left_out = Vec::new();
    let mut sort = |index: usize, outcome: &Result<Measurement, String>| match outcome {
        Ok(measurement) if measurement.errors.keep(max_error) => Some((index, *measurement)),
        Ok(measurement) => {
            left_out.push((name(index), measurement.errors.text()));
            None
        }
        Err(reason) => {
            left_out.push((name(index), reason.clone()));
            None
        }
    };
    let (crude, plain): (Vec<_>, Vec<_>) =
        (0..candidates.len()).partition(|&index| candidates[index].refines.is_some());
    let mut right_enough: Vec<_> =
        plain.into_iter().filter_map(|index| sort(index, &measure.sparse(index))).collect();
    let quickest = |measured: &[(usize, Measurement)]| {
        measured.iter().map(|(_, measurement)| measurement.frame_ms).fold(f64::INFINITY, f64::min)
    };
    let worth_it = CRUDE_SLACK * quickest(&right_enough);
    for index in crude {
        let refined = right_enough.iter().find(|(of, _)| Some(*of) == candidates[index].refines);
        let outcome = match refined {
            Some((_, measurement)) if measurement.frame_ms <= worth_it => measure.sparse(index),
            Some((of, _)) => Err(format!("not tried: {} is too slow", name(*of))),
            None => Err("not tried: what it coarsens is left out".to_owned()),
        };
        right_enough.extend(sort(index, &outcome));
    }
    right_enough.sort_by(|a, b| a.1.frame_ms.total_cmp(&b.1.frame_ms));
    let mut waiting = &right_enough[..];
    while let Some((_, first)) = waiting.first() {
        let is_near = |(_, measurement): &&(usize, Measurement)| {
            measurement.frame_ms <= WHOLE_SLACK * first.frame_ms
        };
        let count = waiting.iter().take(WHOLE_AT_A_TIME).take_while(is_near).count();
        // The first is no slower than itself, whatever its time.
        let (few, rest) = waiting.split_at(count.max(1));
        waiting = rest;
        let indices: Vec<_> = few.iter().map(|(index, _)| *index).collect();
        let whole = measure.whole(&indices);
        let mut ranking: Vec<_> = indices
            .iter()
            .zip(&whole)
            .filter_map(|(&index, outcome)| sort(index, outcome))
            .collect();
        ranking.sort_by(|a, b| a.1.frame_ms.total_cmp(&b.1.frame_ms));
        if let Some((index, measurement)) = ranking.first() {
            let runner_up = ranking.get(1);
            return Ok(Choice {
                configuration: name(*index),
                max_error,
                errors: measurement.errors,
                frame_ms: measurement.frame_ms,
                runner_up: runner_up.map(|(index, next)| (name(*index), next.frame_ms)),
                left_out,
            });
        }
    }
    Err(left_out)
}

impl Choice {
    /// What was chosen, why, and what it expects, as names and texts.
    pub fn account(&self) -> Vec<(&'static str, String)> {
        let next = self.runner_up.as_ref().map_or_else(
            || "the only one".to_owned(),
            |(name, ms)| format!("the quickest; next {name} at {} ms", decimal(*ms)),
        );
        let mut lines = vec![
            ("chosen", self.configuration.clone()),
            ("because", format!("{next}, of those within {}", small(self.max_error))),
            ("expects", format!("{} ms a frame; {}", decimal(self.frame_ms), self.errors.text())),
        ];
        let left_out = self.left_out.iter();
        lines.extend(left_out.map(|(name, reason)| ("left out", format!("{name}: {reason}"))));
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measurement(p99: f64, wrong: usize, frame_ms: f64) -> Result<Measurement, String> {
        Ok(Measurement { errors: Errors { rays: 7_000, wrong, p99 }, frame_ms })
    }

    const fn candidate(name: &str, refines: Option<usize>) -> Candidate<'_> {
        Candidate { name, refines }
    }

    const CANDIDATES: [Candidate<'_>; 4] = [
        candidate("exact", None),
        candidate("cubic", None),
        candidate("hasty", None),
        candidate("unable", None),
    ];

    /// Pictures known beforehand, and which were drawn.
    struct Known {
        sparse: Vec<Result<Measurement, String>>,
        whole: Vec<Result<Measurement, String>>,
        drawn_sparsely: Vec<usize>,
        drawn_whole: Vec<Vec<usize>>,
    }

    impl Known {
        fn new(
            sparse: Vec<Result<Measurement, String>>,
            whole: Vec<Result<Measurement, String>>,
        ) -> Self {
            Self { sparse, whole, drawn_sparsely: Vec::new(), drawn_whole: Vec::new() }
        }
    }

    impl Measure for Known {
        fn sparse(&mut self, candidate: usize) -> Result<Measurement, String> {
            self.drawn_sparsely.push(candidate);
            self.sparse[candidate].clone()
        }

        fn whole(&mut self, candidates: &[usize]) -> Vec<Result<Measurement, String>> {
            self.drawn_whole.push(candidates.to_vec());
            candidates.iter().map(|&index| self.whole[index].clone()).collect()
        }
    }

    /// Three that draw, from slow and right to quick and wrong, and one that refuses.
    fn outcomes() -> Vec<Result<Measurement, String>> {
        let refused = Err("needed a polynomial, found none".to_owned());
        vec![
            measurement(1e-7, 0, 9.0),
            measurement(0.03, 0, 4.0),
            measurement(1e-4, 1, 1.0),
            refused,
        ]
    }

    fn chosen(max_error: f64) -> Result<Choice, Vec<(String, String)>> {
        choose(&CANDIDATES, max_error, &mut Known::new(outcomes(), outcomes()))
    }

    #[test]
    fn the_cubic_is_chosen_where_it_is_good_enough() {
        let lax = chosen(0.05).expect("two will do");
        assert_eq!(lax.configuration, "cubic");
        assert_eq!(lax.runner_up, Some(("exact".to_owned(), 9.0)));
        let strict = chosen(1e-3).expect("one will do");
        assert_eq!((strict.configuration.as_str(), &strict.runner_up), ("exact", &None));
        // A single wrong verdict of 7,000 is one too many, however quick; refusals keep their words.
        let reason = |choice: &Choice, of: &str| {
            choice.left_out.iter().find(|(name, _)| name == of).map(|(_, reason)| reason.clone())
        };
        assert!(reason(&lax, "hasty").expect("left out").contains("1 of 7\u{202f}000 rays wrong"));
        assert!(reason(&lax, "unable").expect("left out").contains("polynomial"));
        assert!(reason(&lax, "cubic").is_none() && reason(&strict, "cubic").is_some());
        let names: Vec<_> = strict.account().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names[..3], ["chosen", "because", "expects"]);
    }

    #[test]
    fn held_out_rays_have_the_last_word() {
        // The cubic looks right in the sparse picture and is not in the whole one.
        let sparse = vec![measurement(1e-7, 0, 9.0), measurement(1e-4, 0, 4.0)];
        let whole = vec![measurement(1e-7, 0, 90.0), measurement(0.2, 0, 40.0)];
        let mut known = Known::new(sparse, whole);
        let choice = choose(&CANDIDATES[..2], 1e-3, &mut known).expect("one will do");
        assert_eq!((choice.configuration.as_str(), choice.frame_ms), ("exact", 90.0));
        assert_eq!(known.drawn_whole, [[1, 0]], "the quickest first");
    }

    #[test]
    fn crude_versions_are_drawn_only_of_what_is_right_and_quick() {
        let candidates = [
            candidate("quick", None),
            candidate("quick, crude", Some(0)),
            candidate("slow", None),
            candidate("slow, crude", Some(2)),
            candidate("wrong", None),
            candidate("wrong, crude", Some(4)),
        ];
        let all = vec![
            measurement(0.0, 0, 1.0),
            measurement(1e-4, 0, 0.5),
            measurement(0.0, 0, 2.5),
            measurement(0.0, 0, 0.1),
            measurement(0.0, 9, 0.1),
            measurement(0.0, 0, 0.1),
        ];
        let mut known = Known::new(all.clone(), all);
        let choice = choose(&candidates, 1e-3, &mut known).expect("some will do");
        assert_eq!(choice.configuration, "quick, crude");
        assert_eq!(known.drawn_sparsely, [0, 2, 4, 1]);
        // Five times as slow in the sparse picture is too slow for a whole one.
        assert_eq!(known.drawn_whole, [[1, 0]]);
        let untried = choice.left_out.iter().filter(|(_, reason)| reason.starts_with("not tried"));
        assert_eq!(untried.count(), 2);
    }

    #[test]
    fn more_are_examined_only_while_none_will_do() {
        let count = 2 * WHOLE_AT_A_TIME + 1;
        let candidates = vec![candidate("same", None); count];
        let sparse: Vec<_> =
            (0..count).map(|index| measurement(0.0, 0, 10.0 + index as f64)).collect();
        let is_wrong = |index: usize| if index < WHOLE_AT_A_TIME { 1.0 } else { 0.0 };
        let whole =
            (0..count).map(|index| measurement(is_wrong(index), 0, 10.0 + index as f64)).collect();
        let mut known = Known::new(sparse, whole);
        let choice = choose(&candidates, 1e-3, &mut known).expect("one will do");
        assert_eq!((choice.frame_ms, known.drawn_whole.len()), (10.0 + WHOLE_AT_A_TIME as f64, 2));
    }

    #[test]
    fn none_is_chosen_where_none_will_do() {
        assert_eq!(chosen(1e-9).expect_err("too strict").len(), CANDIDATES.len());
        // No number is no small error.
        let broken = vec![measurement(f64::NAN, 0, 1.0), measurement(f64::INFINITY, 0, 1.0)];
        let mut known = Known::new(broken, Vec::new());
        assert!(choose(&CANDIDATES[..2], 1.0, &mut known).is_err());
        assert!(known.drawn_whole.is_empty());
    }
}
