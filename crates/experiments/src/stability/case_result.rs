//! The result of one method at one value of one case.

use metaball_core::reference::Truth;
use metaball_core::{Hit, Verdict};
use serde::{Deserialize, Serialize};

use super::outcome::Outcome;
use harness::judge::{Judge, Ruling, Terms};
use harness::score::{Finding, Judgement, RadiusError};
use harness::stats::{quantile, sorted};

/// A method's result at a value of a case's parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseResult {
    /// Name of the case.
    pub case: String,
    /// Value of its parameter.
    pub value: f64,
    /// Name of the configuration.
    pub method: String,
    /// What the rest amounts to.
    pub outcome: Outcome,
    /// What building and drawing took, in seconds.
    pub seconds: f64,
    /// Rays that are clear to the oracle; the counts below are of these.
    pub clear: usize,
    /// Rays that are not.
    pub ambiguous: usize,
    /// Rays marked as a fallback or as undecided.
    #[serde(alias = "told")]
    pub reported: usize,
    /// Rays wrong and not marked, where nothing is promised.
    #[serde(alias = "lost")]
    pub silently_wrong: usize,
    /// Rays wrong and not marked, where the answer is promised.
    pub broken: usize,
    /// |Δt|/R of the hits that are right and not marked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<RadiusError>,
    /// Pixels that differ in any bit from the frame drawn before, where one was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub differing: Option<usize>,
    /// Why there is no picture, or the first thing that is wrong with it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

impl CaseResult {
    /// A method that draws nothing and reports why.
    pub(super) fn refused(case: &str, value: f64, configuration: &str, reason: String) -> Self {
        Self {
            case: case.to_owned(),
            value,
            method: configuration.to_owned(),
            outcome: Outcome::Reported,
            seconds: 0.0,
            clear: 0,
            ambiguous: 0,
            reported: 0,
            silently_wrong: 0,
            broken: 0,
            error: None,
            differing: None,
            note: Some(reason),
        }
    }

    /// A method that is not run, and why.
    pub(super) fn untried(case: &str, value: f64, configuration: &str, reason: String) -> Self {
        Self { outcome: Outcome::Untried, ..Self::refused(case, value, configuration, reason) }
    }

    /// Judges a picture. `differing` counts pixels that are not as in the frame drawn before;
    /// where `must_repeat`, there may be none.
    pub(super) fn judged(
        (case, value): (&str, f64),
        (configuration, terms): (&str, &Terms),
        (judge, hits): (&Judge<'_>, &[Hit]),
        differing: Option<usize>,
        must_repeat: bool,
    ) -> Self {
        let mut result = Self {
            note: None,
            outcome: Outcome::Right,
            differing,
            ..Self::refused(case, value, configuration, String::new())
        };
        let mut errors = Vec::new();
        for (ray, (truth, hit)) in judge.truths().iter().zip(hits).enumerate() {
            result.count((judge, ray), (truth, hit), terms, &mut errors);
        }
        let errors = sorted(errors);
        result.error = quantile(&errors, 1.0).map(|max| RadiusError {
            p50: quantile(&errors, 0.5).unwrap_or(max),
            p99: quantile(&errors, 0.99).unwrap_or(max),
            max,
        });
        let is_repeated = !must_repeat || differing.unwrap_or(0) == 0;
        if !is_repeated {
            let text = format!("{} pixels differ", differing.unwrap_or(0));
            result.note.get_or_insert(text);
        }
        result.outcome = if result.broken > 0 || !is_repeated {
            Outcome::Broken
        } else if result.silently_wrong > 0 {
            Outcome::SilentlyWrong
        } else if result.reported > 0 {
            Outcome::Reported
        } else if result.error.is_some_and(|error| error.p99 > terms.tolerance()) {
            Outcome::Coarse
        } else {
            Outcome::Right
        };
        result
    }

    fn count(
        &mut self,
        (judge, ray): (&Judge<'_>, usize),
        (truth, hit): (&Truth, &Hit),
        terms: &Terms,
        errors: &mut Vec<f64>,
    ) {
        if truth.is_ambiguous() {
            self.ambiguous += 1;
            return;
        }
        self.clear += 1;
        if hit.fallback || hit.verdict == Verdict::Undecided {
            self.reported += 1;
            return;
        }
        let judgement = Judgement::new(truth, hit);
        match judge.rule(ray, hit, terms) {
            Err(violation) => {
                self.broken += 1;
                self.note.get_or_insert(violation);
            }
            Ok(Ruling::Excused) => self.silently_wrong += 1,
            Ok(_) if judgement.is_wrong() => self.silently_wrong += 1,
            Ok(_) => {
                if let Finding::Hit { error } = judgement.finding {
                    errors.push(error);
                }
            }
        }
    }
}
