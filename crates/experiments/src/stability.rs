//! The command `stability`: cases with a parameter that is turned until a method breaks, and whether
//! the method says so.

pub mod cell;
pub mod limits;
mod page;
mod patience;
pub mod record;
pub mod stand;

use std::fs;
use std::path::{Path, PathBuf};

use bench_scenes::{Case, cases};
use metaball_core::gpu::{AdapterChoice, Gpu};

use self::cell::{Cell, Outcome};
use self::patience::rests;
use self::record::{Limit, SCHEMA, Stability};
use self::stand::Stand;
use crate::console::{self, ProgressBar, open_adapter, table};
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
        cells: Vec::new(),
    };
    let unfinished = options.out.join("unfinished.json");
    let left = stability.unfinished(&unfinished).unwrap_or_default();
    climb(&gpu, options.quick, (&chosen, &methods), left, |cells| {
        stability.cells = cells.to_vec();
        stability.write(&unfinished)
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
    remove(&unfinished);
    console::line(&format!("\n{}", page.display()));
    Ok(())
}

/// The values of a case that are tried.
fn values(case: &Case, quick: bool) -> &'static [f64] {
    if quick { case.quick } else { case.values }
}

/// Tries all values of all cases; `keep` is told of all cells after every value.
fn climb(
    gpu: &Gpu,
    quick: bool,
    (cases, methods): (&[&'static Case], &[Configuration]),
    mut cells: Vec<Cell>,
    mut keep: impl FnMut(&[Cell]) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let steps: usize = cases.iter().map(|case| values(case, quick).len()).sum();
    let progress = ProgressBar::new(steps as u64);
    if !cells.is_empty() {
        progress.note("Going on where an interrupted run has stopped.");
    }
    let mut stand = Stand::new(gpu, methods.iter().cloned());
    let mut done = 0;
    for case in cases {
        progress.stage(case.name.to_owned());
        for &value in values(case, quick) {
            done += 1;
            let is_here = |cell: &Cell| cell.case == case.name && cell.value == value;
            if cells.iter().any(is_here) {
                progress.skip(done);
            } else {
                let easier = || cells.iter().filter(|cell| cell.case == case.name);
                let tried =
                    stand.attempt(case, value, |configuration| rests(easier(), configuration))?;
                cells.extend(tried);
                keep(&cells)?;
                progress.reach(done);
            }
        }
    }
    Ok(())
}

/// A file that may well be gone already.
fn remove(path: &Path) {
    if let Err(error) = fs::remove_file(path) {
        console::note(&format!("{}: {error}", path.display()));
    }
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
                format!("{}{value}", limit.first.word())
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
            let cell = stability.of(&limit.case, &limit.method).find(|cell| cell.value == *value);
            let found = cell.map_or(Outcome::Right, |cell| cell.outcome);
            let note = cell.and_then(|cell| cell.note.clone()).unwrap_or_default();
            unexpected += &format!(
                "\n  {}, {} = {}: {} {note}",
                limit.method,
                limit.case,
                tick(*value),
                found.word()
            );
            count += 1;
        }
    }
    let tried = stability.tried();
    text += &format!("\n\n{} of {tried} outcomes are as stated", tried - count);
    text += &unexpected;
    for cell in stability.of_outcome(Outcome::Untried) {
        let reason = cell.note.as_deref().unwrap_or_default();
        text += &format!("\n  {}, {} = {}: {reason}", cell.method, cell.case, tick(cell.value));
    }
    text
}
