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

/// What a candidate's picture was like; if there is none, why.
pub type Outcome = Result<Sketch, String>;

/// A picture, measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sketch {
    /// How far off it is.
    pub errors: Errors,
    /// Median milliseconds of a frame; infinite where it was not timed, being too far off.
    pub frame_ms: f64,
}

/// Somebody to choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Candidate<'a> {
    /// Name of the setting.
    pub name: &'a str,
    /// The candidate's place of which this is a cruder version, which gives error away for time.
    pub refines: Option<usize>,
}

/// Candidates whose whole picture is drawn at a time.
pub const FINALISTS: usize = 4;

/// A crude version is drawn only of what takes up to so many times as long as the quickest that is
/// right enough: no knob is known to save more.
const CRUDE_SLACK: f64 = 1.5;

/// Nor is the whole picture drawn of what takes longer than this many times the quickest's sparse
/// picture: costs that do not grow with a picture weigh more in a sparse one, but not so much.
const WHOLE_SLACK: f64 = 4.0;

/// What was chosen, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// Name of the setting.
    pub setting: String,
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

/// Draws candidates, at given places.
pub trait Trial {
    /// A sparse picture.
    fn sketch(&mut self, place: usize) -> Outcome;

    /// Whole pictures, timed in turn, of candidates whose sparse pictures were right enough.
    fn examine(&mut self, places: &[usize]) -> Vec<Outcome>;
}

/// Chooses by what the trial shows: sparse pictures of all, but of crude versions only where what they
/// refine is right enough and quick; then whole pictures of the quickest few of those that are right
/// enough, until one still is. `Err`: the reasons why none is.
pub fn choose(
    candidates: &[Candidate<'_>],
    max_error: f64,
    trial: &mut impl Trial,
) -> Result<Choice, Vec<(String, String)>> {
    let name = |place: usize| candidates[place].name.to_owned();
    let mut left_out = Vec::new();
    let mut sort = |place: usize, outcome: &Outcome| match outcome {
        Ok(sketch) if sketch.errors.keep(max_error) => Some((place, *sketch)),
        Ok(sketch) => {
            left_out.push((name(place), sketch.errors.text()));
            None
        }
        Err(reason) => {
            left_out.push((name(place), reason.clone()));
            None
        }
    };
    let (crude, plain): (Vec<_>, Vec<_>) =
        (0..candidates.len()).partition(|&place| candidates[place].refines.is_some());
    let mut right_enough: Vec<_> =
        plain.into_iter().filter_map(|place| sort(place, &trial.sketch(place))).collect();
    let quickest = |sketches: &[(usize, Sketch)]| {
        sketches.iter().map(|(_, sketch)| sketch.frame_ms).fold(f64::INFINITY, f64::min)
    };
    let worth_it = CRUDE_SLACK * quickest(&right_enough);
    for place in crude {
        let refined = right_enough.iter().find(|(of, _)| Some(*of) == candidates[place].refines);
        let outcome = match refined {
            Some((_, sketch)) if sketch.frame_ms <= worth_it => trial.sketch(place),
            Some((of, _)) => Err(format!("not tried: {} is too slow", name(*of))),
            None => Err("not tried: what it coarsens is left out".to_owned()),
        };
        right_enough.extend(sort(place, &outcome));
    }
    right_enough.sort_by(|a, b| a.1.frame_ms.total_cmp(&b.1.frame_ms));
    let mut waiting = &right_enough[..];
    while let Some((_, first)) = waiting.first() {
        let is_near =
            |(_, sketch): &&(usize, Sketch)| sketch.frame_ms <= WHOLE_SLACK * first.frame_ms;
        let count = waiting.iter().take(FINALISTS).take_while(is_near).count();
        // Whoever is first is no slower than itself, whatever its time.
        let (few, rest) = waiting.split_at(count.max(1));
        waiting = rest;
        let places: Vec<_> = few.iter().map(|(place, _)| *place).collect();
        let whole = trial.examine(&places);
        let mut ranking: Vec<_> = places
            .iter()
            .zip(&whole)
            .filter_map(|(&place, outcome)| sort(place, outcome))
            .collect();
        ranking.sort_by(|a, b| a.1.frame_ms.total_cmp(&b.1.frame_ms));
        if let Some((place, sketch)) = ranking.first() {
            let runner_up = ranking.get(1);
            return Ok(Choice {
                setting: name(*place),
                max_error,
                errors: sketch.errors,
                frame_ms: sketch.frame_ms,
                runner_up: runner_up.map(|(place, next)| (name(*place), next.frame_ms)),
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
            ("chosen", self.setting.clone()),
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

    fn sketch(p99: f64, wrong: usize, frame_ms: f64) -> Outcome {
        Ok(Sketch { errors: Errors { rays: 7_000, wrong, p99 }, frame_ms })
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

    /// Pictures known beforehand, and who was asked for them.
    struct Known {
        sparse: Vec<Outcome>,
        whole: Vec<Outcome>,
        sketched: Vec<usize>,
        examined: Vec<Vec<usize>>,
    }

    impl Known {
        fn new(sparse: Vec<Outcome>, whole: Vec<Outcome>) -> Self {
            Self { sparse, whole, sketched: Vec::new(), examined: Vec::new() }
        }
    }

    impl Trial for Known {
        fn sketch(&mut self, place: usize) -> Outcome {
            self.sketched.push(place);
            self.sparse[place].clone()
        }

        fn examine(&mut self, places: &[usize]) -> Vec<Outcome> {
            self.examined.push(places.to_vec());
            places.iter().map(|&place| self.whole[place].clone()).collect()
        }
    }

    /// Three that draw, from slow and right to quick and wrong, and one that refuses.
    fn outcomes() -> Vec<Outcome> {
        let refused = Err("needed a polynomial, found none".to_owned());
        vec![sketch(1e-7, 0, 9.0), sketch(0.03, 0, 4.0), sketch(1e-4, 1, 1.0), refused]
    }

    fn chosen(max_error: f64) -> Result<Choice, Vec<(String, String)>> {
        choose(&CANDIDATES, max_error, &mut Known::new(outcomes(), outcomes()))
    }

    #[test]
    fn the_cubic_is_chosen_where_it_is_good_enough() {
        let lax = chosen(0.05).expect("two will do");
        assert_eq!(lax.setting, "cubic");
        assert_eq!(lax.runner_up, Some(("exact".to_owned(), 9.0)));
        let strict = chosen(1e-3).expect("one will do");
        assert_eq!((strict.setting.as_str(), &strict.runner_up), ("exact", &None));
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
        let sparse = vec![sketch(1e-7, 0, 9.0), sketch(1e-4, 0, 4.0)];
        let whole = vec![sketch(1e-7, 0, 90.0), sketch(0.2, 0, 40.0)];
        let mut trial = Known::new(sparse, whole);
        let choice = choose(&CANDIDATES[..2], 1e-3, &mut trial).expect("one will do");
        assert_eq!((choice.setting.as_str(), choice.frame_ms), ("exact", 90.0));
        assert_eq!(trial.examined, [[1, 0]], "the quickest first");
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
            sketch(0.0, 0, 1.0),
            sketch(1e-4, 0, 0.5),
            sketch(0.0, 0, 2.5),
            sketch(0.0, 0, 0.1),
            sketch(0.0, 9, 0.1),
            sketch(0.0, 0, 0.1),
        ];
        let mut trial = Known::new(all.clone(), all);
        let choice = choose(&candidates, 1e-3, &mut trial).expect("some will do");
        assert_eq!(choice.setting, "quick, crude");
        assert_eq!(trial.sketched, [0, 2, 4, 1]);
        // Five times as slow in the sparse picture is too slow for a whole one.
        assert_eq!(trial.examined, [[1, 0]]);
        let untried = choice.left_out.iter().filter(|(_, reason)| reason.starts_with("not tried"));
        assert_eq!(untried.count(), 2);
    }

    #[test]
    fn more_are_examined_only_while_none_will_do() {
        let count = 2 * FINALISTS + 1;
        let candidates = vec![candidate("same", None); count];
        let sparse: Vec<_> = (0..count).map(|place| sketch(0.0, 0, 10.0 + place as f64)).collect();
        let is_wrong = |place: usize| if place < FINALISTS { 1.0 } else { 0.0 };
        let whole =
            (0..count).map(|place| sketch(is_wrong(place), 0, 10.0 + place as f64)).collect();
        let mut trial = Known::new(sparse, whole);
        let choice = choose(&candidates, 1e-3, &mut trial).expect("one will do");
        assert_eq!((choice.frame_ms, trial.examined.len()), (10.0 + FINALISTS as f64, 2));
    }

    #[test]
    fn nobody_is_chosen_where_nobody_will_do() {
        assert_eq!(chosen(1e-9).expect_err("too strict").len(), CANDIDATES.len());
        // No number is no small error.
        let broken = vec![sketch(f64::NAN, 0, 1.0), sketch(f64::INFINITY, 0, 1.0)];
        let mut trial = Known::new(broken, Vec::new());
        assert!(choose(&CANDIDATES[..2], 1.0, &mut trial).is_err());
        assert!(trial.examined.is_empty());
    }
}
