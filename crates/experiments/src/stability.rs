//! The command `stability`: cases with a parameter that is turned until a method breaks, and whether
//! the method reports it.

pub mod case_result;
pub mod fixture;
pub mod limits;
pub mod outcome;
mod page;
pub mod record;
mod skipping;

use std::path::PathBuf;

use bench_scenes::{Case, cases};
use metaball_core::gpu::{AdapterChoice, Gpu};

use self::case_result::CaseResult;
use self::fixture::Fixture;
use self::outcome::Outcome;
use self::record::{Limit, SCHEMA, Stability};
use self::skipping::reason_to_skip;
use crate::console::{self, ProgressBar, open_adapter, table};
use crate::unfinished;
use harness::configuration::Configuration;
use harness::configuration::variants::stability_configurations;
use harness::machine::Provenance;
use harness::numbers::tick;
use picture_files::write_atomically;

/// What to try.
#[derive(Debug, Clone)]
pub struct Options {
    /// A few values of each case only.
    pub quick: bool,
    /// Names of cases; all when empty.
    pub cases: Vec<&'static Case>,
    /// Methods with their options; all when empty.
    pub methods: Vec<Configuration>,
    /// What to draw with.
    pub adapter: AdapterChoice,
    /// Folder for `index.html` and `records.json`.
    pub out: PathBuf,
}

/// Tries every case on every configuration, prints the limits, writes the page and the records. What an
/// interrupted run of the same command has done is taken over.
///
/// # Errors
/// Without an adapter, when the device fails, or when a file cannot be written.
pub fn stability(options: &Options) -> anyhow::Result<()> {
    let gpu = open_adapter(&options.adapter)?;
    let chosen: Vec<_> =
        if options.cases.is_empty() { cases().iter().collect() } else { options.cases.clone() };
    let methods = if options.methods.is_empty() {
        stability_configurations()
    } else {
        options.methods.clone()
    };

    let mut stability = Stability {
        provenance: Provenance::here(SCHEMA),
        adapter: gpu.report().into(),
        limits: Vec::new(),
        results: Vec::new(),
    };
    let unfinished_path = options.out.join("unfinished.json");
    let left = stability.unfinished(&unfinished_path).unwrap_or_default();
    run_cases(&gpu, options.quick, (&chosen, &methods), left, |results| {
        stability.results = results.to_vec();
        stability.write(&unfinished_path)
    })?;

    let limit_of = |case: &&Case, method: &Configuration| {
        Limit::of(case, &stability.of(case.name, &method.name).collect::<Vec<_>>())
    };
    let of_case = |case| methods.iter().filter_map(move |method| limit_of(case, method));
    stability.limits = chosen.iter().flat_map(of_case).collect();
    console::line(&summary(&stability, &chosen, &methods));
    let page = options.out.join("index.html");
    stability.write(&options.out.join("records.json"))?;
    write_atomically(&page, page::page(&stability, &chosen, &methods).as_bytes())?;
    unfinished::remove(&unfinished_path);
    console::line(&format!("\n{}", page.display()));
    Ok(())
}

/// The values of a case that are tried.
fn values(case: &Case, quick: bool) -> &'static [f64] {
    if quick { case.quick } else { case.values }
}

/// Runs all values of all cases; calls `keep` with all results after every value.
fn run_cases(
    gpu: &Gpu,
    quick: bool,
    (cases, methods): (&[&'static Case], &[Configuration]),
    mut results: Vec<CaseResult>,
    mut keep: impl FnMut(&[CaseResult]) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let steps: usize = cases.iter().map(|case| values(case, quick).len()).sum();
    let progress = ProgressBar::new(steps as u64);
    if !results.is_empty() {
        progress.note("Continuing an interrupted run.");
    }
    let mut fixture = Fixture::new(gpu, methods.iter().cloned());
    let mut done = 0;
    for case in cases {
        progress.stage(case.name.to_owned());
        for &value in values(case, quick) {
            done += 1;
            let is_here = |result: &CaseResult| result.case == case.name && result.value == value;
            if results.iter().any(is_here) {
                progress.skip(done);
            } else {
                let easier = || results.iter().filter(|result| result.case == case.name);
                let found = fixture
                    .run(case, value, |configuration| reason_to_skip(easier(), configuration))?;
                results.extend(found);
                keep(&results)?;
                progress.reach(done);
            }
        }
    }
    Ok(())
}

/// The limits as text: one line a case, one column a method.
fn summary(stability: &Stability, cases: &[&Case], methods: &[Configuration]) -> String {
    let mut headings = vec!["first value that is not right"];
    headings.extend(methods.iter().map(|method| method.name.as_str()));
    let row = |case: &&Case| {
        let limit = |method: &Configuration| {
            stability.limit(case.name, &method.name).map_or_else(String::new, |limit| {
                let value =
                    limit.fails_at.map_or_else(String::new, |value| format!(" {}", tick(value)));
                format!("{}{value}", limit.first.name())
            })
        };
        let cells = methods.iter().map(limit);
        std::iter::once(case.name.to_owned()).chain(cells).collect::<Vec<_>>()
    };
    let rows: Vec<_> = cases.iter().map(row).collect();
    let mut text = table(&headings, &rows);
    let (mut unexpected, mut count) = (String::new(), 0);
    for limit in &stability.limits {
        for value in &limit.unexpected {
            let result =
                stability.of(&limit.case, &limit.method).find(|result| result.value == *value);
            let found = result.map_or(Outcome::Right, |result| result.outcome);
            let note = result.and_then(|result| result.note.clone()).unwrap_or_default();
            unexpected += &format!(
                "\n  {}, {} = {}: {} {note}",
                limit.method,
                limit.case,
                tick(*value),
                found.name()
            );
            count += 1;
        }
    }
    let tried = stability.tried();
    text += &format!("\n\n{} of {tried} outcomes are as stated", tried - count);
    text += &unexpected;
    for result in stability.of_outcome(Outcome::Untried) {
        let reason = result.note.as_deref().unwrap_or_default();
        text +=
            &format!("\n  {}, {} = {}: {reason}", result.method, result.case, tick(result.value));
    }
    text
}
