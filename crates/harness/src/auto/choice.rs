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
    /// Median milliseconds of a frame.
    pub frame_ms: f64,
}

/// Candidates whose whole picture is drawn at a time.
pub const FINALISTS: usize = 4;

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

/// Chooses from sparse pictures, in the order of `names`, and from the whole pictures that `examine`
/// makes of the candidates at the given places: the quickest few of those that are right enough, until
/// one still is. `Err`: the reasons why none is.
pub fn choose(
    names: &[&str],
    sparse: &[Outcome],
    max_error: f64,
    mut examine: impl FnMut(&[usize]) -> Vec<Outcome>,
) -> Result<Choice, Vec<(String, String)>> {
    let mut left_out = Vec::new();
    let mut right_enough = Vec::new();
    let mut sort = |place: usize, outcome: &Outcome| match outcome {
        Ok(sketch) if sketch.errors.keep(max_error) => Some((place, *sketch)),
        Ok(sketch) => {
            left_out.push((names[place].to_owned(), sketch.errors.text()));
            None
        }
        Err(reason) => {
            left_out.push((names[place].to_owned(), reason.clone()));
            None
        }
    };
    for (place, outcome) in sparse.iter().enumerate() {
        right_enough.extend(sort(place, outcome));
    }
    right_enough.sort_by(|a, b| a.1.frame_ms.total_cmp(&b.1.frame_ms));
    for few in right_enough.chunks(FINALISTS) {
        let places: Vec<_> = few.iter().map(|(place, _)| *place).collect();
        let whole = examine(&places);
        let mut ranking: Vec<_> = places
            .iter()
            .zip(&whole)
            .filter_map(|(&place, outcome)| sort(place, outcome))
            .collect();
        ranking.sort_by(|a, b| a.1.frame_ms.total_cmp(&b.1.frame_ms));
        if let Some((place, sketch)) = ranking.first() {
            let runner_up = ranking.get(1);
            return Ok(Choice {
                setting: names[*place].to_owned(),
                max_error,
                errors: sketch.errors,
                frame_ms: sketch.frame_ms,
                runner_up: runner_up.map(|(place, next)| (names[*place].to_owned(), next.frame_ms)),
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

    const NAMES: [&str; 4] = ["exact", "cubic", "hasty", "unable"];

    /// Three that draw, from slow and right to quick and wrong, and one that refuses.
    fn outcomes() -> Vec<Outcome> {
        let refused = Err("needed a polynomial, found none".to_owned());
        vec![sketch(1e-7, 0, 9.0), sketch(0.03, 0, 4.0), sketch(1e-4, 1, 1.0), refused]
    }

    fn chosen(max_error: f64) -> Result<Choice, Vec<(String, String)>> {
        let all = outcomes();
        choose(&NAMES, &all, max_error, |places| {
            places.iter().map(|&place| all[place].clone()).collect()
        })
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
        let sparse = [sketch(1e-7, 0, 9.0), sketch(1e-4, 0, 4.0)];
        let whole = [sketch(1e-7, 0, 90.0), sketch(0.2, 0, 40.0)];
        let mut asked = Vec::new();
        let choice = choose(&NAMES[..2], &sparse, 1e-3, |places| {
            asked.extend_from_slice(places);
            places.iter().map(|&place| whole[place].clone()).collect()
        });
        let choice = choice.expect("one will do");
        assert_eq!((choice.setting.as_str(), choice.frame_ms), ("exact", 90.0));
        assert_eq!(asked, [1, 0], "the quickest first");
    }

    #[test]
    fn more_are_examined_only_while_none_will_do() {
        let count = 2 * FINALISTS + 1;
        let names = vec!["same"; count];
        let sparse: Vec<_> = (0..count).map(|place| sketch(0.0, 0, place as f64)).collect();
        let mut calls = 0;
        let choice = choose(&names, &sparse, 1e-3, |places| {
            calls += 1;
            let p99 = if calls == 1 { 1.0 } else { 0.0 };
            places.iter().map(|&place| sketch(p99, 0, place as f64)).collect()
        });
        assert_eq!((choice.expect("one will do").frame_ms, calls), (FINALISTS as f64, 2));
    }

    #[test]
    fn nobody_is_chosen_where_nobody_will_do() {
        assert_eq!(chosen(1e-9).expect_err("too strict").len(), NAMES.len());
        // No number is no small error.
        let broken = [sketch(f64::NAN, 0, 1.0), sketch(f64::INFINITY, 0, 1.0)];
        assert!(choose(&NAMES[..2], &broken, 1.0, |_| Vec::new()).is_err());
    }
}
