//! `records.json` of stability: every result, and the limits that follow from them.

use std::path::Path;

use bench_scenes::Case;
use serde::{Deserialize, Serialize};

use super::case_result::CaseResult;
use super::limits::expected;
use super::outcome::Outcome;
use crate::unfinished;
use harness::machine::Provenance;
use harness::output::write_json_lines;
use harness::record::Adapter;

/// Name and version of the format of [`Stability`].
pub const SCHEMA: &str = "metaball-stability/3";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// Where it comes from; its format is [`SCHEMA`].
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What drew.
    pub adapter: Adapter,
    /// Configurations that were not tried, since they need an adapter and there is none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
    /// Where each method's limits are, by case and method.
    pub limits: Vec<Limit>,
    /// Everything that was tried.
    #[serde(alias = "cells")]
    pub results: Vec<CaseResult>,
}

/// Where a method leaves its tolerance in a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Name of the case.
    pub case: String,
    /// What its number means.
    pub parameter: String,
    /// Name of the configuration.
    pub method: String,
    /// The last value up to which every one is right; `None`: not even the first is.
    pub holds_to: Option<f64>,
    /// The first value that is not right, as far as is known; `None`: all are.
    pub fails_at: Option<f64>,
    /// The outcome there.
    pub first: Outcome,
    /// The worst outcome at any value.
    pub worst: Outcome,
    /// Whether the method reported it itself, at every value whose verdicts it gets wrong; `None` where
    /// it gets none wrong.
    pub says_so: Option<bool>,
    /// The values at which it is not what the table of stated limits expects.
    pub unexpected: Vec<f64>,
}

impl Limit {
    /// The limit that follows from the results of a case and a method, in the order of values; `None` of no
    /// results.
    pub fn of(case: &Case, results: &[&CaseResult]) -> Option<Self> {
        let first_result = results.first()?;
        let fails = results.iter().position(|result| result.outcome != Outcome::Right);
        let worst = results.iter().map(|result| result.outcome).max()?;
        let holds =
            fails.map_or(results.last(), |index| index.checked_sub(1).map(|last| &results[last]));
        let is_unexpected = |result: &&&CaseResult| {
            result.outcome != Outcome::Untried
                && result.outcome != expected(&result.method, case, result.value)
        };
        Some(Self {
            case: case.name.to_owned(),
            parameter: case.parameter.to_owned(),
            method: first_result.method.clone(),
            holds_to: holds.map(|result| result.value),
            fails_at: fails.map(|index| results[index].value),
            first: fails.map_or(Outcome::Right, |index| results[index].outcome),
            worst,
            says_so: (worst >= Outcome::Reported).then_some(worst == Outcome::Reported),
            unexpected: results.iter().filter(is_unexpected).map(|result| result.value).collect(),
        })
    }
}

impl Stability {
    /// Results of a case and a method, in the order that they were tried.
    pub fn of<'a>(
        &'a self,
        case: &'a str,
        method: &'a str,
    ) -> impl Iterator<Item = &'a CaseResult> {
        self.results.iter().filter(move |result| result.case == case && result.method == method)
    }

    /// Results with this outcome.
    pub fn of_outcome(&self, outcome: Outcome) -> impl Iterator<Item = &CaseResult> {
        self.results.iter().filter(move |result| result.outcome == outcome)
    }

    /// How many were run.
    pub fn tried(&self) -> usize {
        self.results.len() - self.of_outcome(Outcome::Untried).count()
    }

    /// The limit of a method in a case.
    pub fn limit(&self, case: &str, method: &str) -> Option<&Limit> {
        self.limits.iter().find(|limit| limit.case == case && limit.method == method)
    }

    /// Writes the file.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: &Path) -> anyhow::Result<()> {
        write_json_lines(path, self)
    }

    /// Reads what an interrupted run has left, if it is of the same program, command and adapter.
    pub fn unfinished(&self, path: &Path) -> Option<Vec<CaseResult>> {
        let left: Self = unfinished::read(path)?;
        let is_same = left.provenance == self.provenance && left.adapter == self.adapter;
        is_same.then_some(left.results)
    }
}

#[cfg(test)]
mod tests {
    use bench_scenes::cases;

    use super::*;

    fn result(value: f64, outcome: Outcome) -> CaseResult {
        let refused = CaseResult::refused("distance", value, "fbvh-certified", "why".to_owned());
        CaseResult { outcome, ..refused }
    }

    fn limit(outcomes: [Outcome; 3]) -> Limit {
        let case = cases().iter().find(|case| case.name == "distance").expect("known");
        let results: Vec<_> = case
            .values
            .iter()
            .zip(outcomes)
            .map(|(&value, outcome)| result(value, outcome))
            .collect();
        Limit::of(case, &results.iter().collect::<Vec<_>>()).expect("results")
    }

    #[test]
    fn a_limit_is_where_the_first_value_fails() {
        use Outcome::{Coarse, Reported, Right, SilentlyWrong, Untried};
        let all = limit([Right; 3]);
        assert_eq!((all.holds_to, all.fails_at, all.says_so), (Some(100.0), None, None));
        let none = limit([Coarse, Right, Right]);
        assert_eq!((none.holds_to, none.fails_at, none.says_so), (None, Some(10.0), None));
        let reported = limit([Right, Reported, Coarse]);
        assert_eq!(
            (reported.holds_to, reported.fails_at, reported.says_so),
            (Some(10.0), Some(30.0), Some(true))
        );
        let wrong = limit([Right, Reported, SilentlyWrong]);
        let found = (wrong.first, wrong.worst, wrong.says_so);
        assert_eq!(found, (Reported, SilentlyWrong, Some(false)));
        // What was not run is neither right nor wrong, and nothing is expected of it.
        let rested = limit([Right, Untried, Untried]);
        assert_eq!((rested.first, rested.worst, rested.says_so), (Untried, Untried, None));
        assert_eq!((rested.holds_to, rested.fails_at), (Some(10.0), Some(30.0)));
        assert!(rested.unexpected.is_empty());
    }

    #[test]
    fn only_the_same_command_goes_on() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("unfinished.json");
        let run = Stability {
            provenance: Provenance::here(SCHEMA),
            adapter: Adapter::none(),
            left_out: Vec::new(),
            limits: Vec::new(),
            results: vec![result(10.0, Outcome::Right)],
        };
        assert_eq!(run.unfinished(&path), None);
        run.write(&path).expect("written");
        assert_eq!(run.unfinished(&path), Some(run.results.clone()));
        let provenance = Provenance { commit: "d".to_owned(), ..run.provenance.clone() };
        let other = Stability { provenance, ..run };
        assert_eq!(other.unfinished(&path), None);
    }
}
