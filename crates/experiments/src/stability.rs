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
use crate::console::{self, ProgressBar, open_adapter_if_any, table};
use crate::outputs::output_files;
use crate::shortfall::nothing_done;
use crate::unfinished;
use harness::configuration::Configuration;
use harness::configuration::variants::stability_configurations;
use harness::machine::Provenance;
use harness::numbers::tick;
use harness::record::Adapter;
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
    /// What to draw with; `None`: methods that need no adapter, and no others.
    pub adapter: Option<AdapterChoice>,
    /// Folder for `index.html` and `records.json`.
    pub out: PathBuf,
}

/// Tries every case on every configuration, prints the limits, writes the page and the records. What an
/// interrupted run of the same command has done is taken over. Methods that need an adapter where there is
/// none are reported and left out.
///
/// # Errors
/// When there is no such adapter, or none of the methods can do without one, when the device fails, or when a file cannot be written.
pub fn stability(options: &Options) -> anyhow::Result<()> {
    let chosen: Vec<_> =
        if options.cases.is_empty() { cases().iter().collect() } else { options.cases.clone() };
    let methods = if options.methods.is_empty() {
        stability_configurations()
    } else {
        options.methods.clone()
    };
    let gpu = open_adapter_if_any(options.adapter.as_ref(), &methods)?;
    let gpu = gpu.as_ref();
    let (methods, left_out): (Vec<_>, Vec<_>) =
        methods.into_iter().partition(|method| gpu.is_some() || !method.needs_adapter());
    if methods.is_empty() {
        let said = "needed a graphics adapter for all of these methods, found none";
        return Err(nothing_done(said, (options.adapter.as_ref(), gpu), &left_out));
    }

    let mut stability = Stability {
        provenance: Provenance::here(SCHEMA),
        adapter: Adapter::of(gpu),
        left_out: left_out.into_iter().map(|method| method.name).collect(),
        limits: Vec::new(),
        results: Vec::new(),
    };
    let names = ["unfinished.json", "index.html", "records.json"];
    let [unfinished_path, page, json] = output_files(&options.out, names, &[], &[])?;
    let left = stability.unfinished(&unfinished_path).unwrap_or_default();
    run_cases(gpu, options.quick, (&chosen, &methods), left, |results| {
        stability.results = results.to_vec();
        stability.write(&unfinished_path)
    })?;

    let limit_of = |case: &&Case, method: &Configuration| {
        Limit::of(case, &stability.of(case.name, &method.name).collect::<Vec<_>>())
    };
    let of_case = |case| methods.iter().filter_map(move |method| limit_of(case, method));
    stability.limits = chosen.iter().flat_map(of_case).collect();
    console::line(&summary(&stability, &chosen, &methods));
    stability.write(&json)?;
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
    gpu: Option<&Gpu>,
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

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::testing::assert_stands_alone;

    fn options(methods: &[&str], out: PathBuf) -> Options {
        let is_wanted = |method: &Configuration| methods.contains(&method.name.as_str());
        Options {
            quick: true,
            cases: cases().iter().filter(|case| case.name == "neck").collect(),
            methods: stability_configurations().into_iter().filter(is_wanted).collect(),
            adapter: None,
            out,
        }
    }

    #[test]
    fn without_an_adapter_methods_on_the_cpu_are_tried_and_the_others_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let names = ["fbvh", "fbvh-certified-cpu", "kanamori-cpu"];
        stability(&options(&names, folder.path().to_owned())).expect("tried");
        let read = |name| fs::read_to_string(folder.path().join(name)).expect("written");
        let found: Stability = serde_json::from_str(&read("records.json")).expect("records");
        assert_eq!((found.left_out, found.adapter), (vec!["fbvh".to_owned()], Adapter::cpu()));
        let case = cases().iter().find(|case| case.name == "neck").expect("known");
        assert_eq!(found.results.len(), 2 * case.quick.len());
        assert!(found.results.iter().all(|result| result.outcome == Outcome::Right));
        let page = read("index.html");
        assert_stands_alone(&page, &["NaN"]);
        assert!(
            page.contains("Left out, since they need a graphics adapter and there was none: fbvh")
        );

        let error =
            stability(&options(&["fbvh"], folder.path().join("none"))).expect_err("none left");
        assert!(error.to_string().contains("needed a graphics adapter"), "{error}");
    }
}
