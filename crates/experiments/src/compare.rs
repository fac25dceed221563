//! The command `compare`: scenes times methods, held against the reference, on one page.

mod page;

use std::path::PathBuf;

use anyhow::Context;
use bench_scenes::{Overrides, load};
use metaball_core::gpu::AdapterChoice;

use crate::conclusions::conclusions;
use crate::console::{self, ProgressBar, open_adapter, table};
use crate::page::software_remark;
use harness::comparison::{self, SceneComparison, compare_scene, steps};
use harness::machine::Provenance;
use harness::numbers::{decimal, grouped, small};
use harness::record::{Record, Records, SCHEMA, Status};
use harness::record_csv::write_csv;
use picture_files::write_atomically;

/// A few that differ: the real molecule first, then the smallest case with a blend, sparse and layered
/// balls, and a real fluid.
pub const DEFAULT_SCENES: &[&str] =
    &["molecule", "two-merging", "scattered-30k", "tornado-4k", "dam-break"];

/// What to compare.
#[derive(Debug, Clone)]
pub struct Options {
    /// Names, generators or files.
    pub scenes: Vec<String>,
    /// What to change about every scene.
    pub overrides: Overrides,
    /// How.
    pub comparison: comparison::Options,
    /// What to draw with.
    pub adapter: AdapterChoice,
    /// Folder for `index.html` and `records.json`.
    pub out: PathBuf,
}

/// Compares, prints a table, writes the page and the records. A scene that does not load or a method
/// that does not build is reported and left out.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing worked at all.
pub fn compare(options: &Options) -> anyhow::Result<()> {
    let gpu = open_adapter(&options.adapter)?;

    let mut scenes = Vec::new();
    let mut remarks: Vec<_> = software_remark(&gpu).into_iter().collect();
    let progress = ProgressBar::new(steps(&options.comparison) * options.scenes.len() as u64);
    for (index, spec) in options.scenes.iter().enumerate() {
        progress.stage(format!("{spec}: loading"));
        let scene = load(spec, &options.overrides)
            .map_err(anyhow::Error::from)
            .and_then(|bench| compare_scene(&gpu, &bench, &options.comparison, &progress))
            .with_context(|| format!("scene {spec}"));
        match scene {
            Ok(scene) => scenes.push(scene),
            Err(error) => {
                let remark = format!("{error:#}");
                progress.note(&remark);
                remarks.push(remark);
            }
        }
        progress.reach(steps(&options.comparison) * (index as u64 + 1));
    }
    drop(progress);

    let records = Records {
        provenance: Provenance::here(SCHEMA),
        records: scenes.iter().flat_map(|scene| scene.records.clone()).collect(),
    };
    let worked =
        records.records.iter().any(|record| matches!(record.status, Status::Ok | Status::Scored));
    if worked {
        console::line(&results(&records.records));
        let by_scene: Vec<_> = scenes.iter().map(|scene| scene.records.as_slice()).collect();
        for sentence in conclusions(&by_scene) {
            console::line(&format!("\n{sentence}"));
        }
    }
    for scene in &scenes {
        note_reasons(scene);
    }
    let page = options.out.join("index.html");
    records.write(&options.out.join("records.json"))?;
    write_csv(&options.out.join("records.csv"), &records.records)?;
    write_atomically(&page, page::page(&records, &scenes, &remarks).as_bytes())?;
    console::line(&format!("\n{}", page.display()));
    anyhow::ensure!(worked, "nothing could be compared; the reasons are above");
    Ok(())
}

/// The table of all records that have a result.
pub(crate) fn results(records: &[Record]) -> String {
    let headings = [
        "scene",
        "balls",
        "method",
        "frame ms",
        "build ms",
        "missed",
        "phantom",
        "front",
        "too close",
        "rms Δt/t",
        "|Δt|/R 99 %",
        "nodes/ray",
        "balls/ray",
    ];
    let row = |record: &Record| {
        let accuracy = record.accuracy()?;
        let measured = record.measured.as_ref();
        let work = measured.and_then(|measured| measured.work);
        let dash = || "–".to_owned();
        Some(vec![
            record.scene.clone(),
            grouped(record.balls),
            record.method.clone(),
            measured.map_or_else(dash, |measured| decimal(measured.frame_ms.median)),
            measured.map_or_else(dash, |measured| decimal(measured.build_ms)),
            accuracy.false_negative.to_string(),
            accuracy.false_positive.to_string(),
            accuracy.wrong_front.to_string(),
            accuracy.ambiguous.to_string(),
            accuracy.rel_rms_t.map_or_else(dash, small),
            accuracy.t_error_over_radius.map_or_else(dash, |error| small(error.p99)),
            work.map_or_else(dash, |work| decimal(work.nodes_per_ray)),
            work.map_or_else(dash, |work| decimal(work.balls_per_ray)),
        ])
    };
    table(&headings, &records.iter().filter_map(row).collect::<Vec<_>>())
}

/// Prints what the table leaves out.
fn note_reasons(scene: &SceneComparison) {
    for record in &scene.records {
        if let Some(reason) = &record.reason {
            console::note(&format!("{}, {}: {reason}", record.scene, record.method));
        }
    }
    for remark in &scene.remarks {
        console::note(&format!("{}: {remark}", scene.scene));
    }
}
