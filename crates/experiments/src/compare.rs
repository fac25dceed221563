//! The command `compare`: scenes times methods, held against the reference, on one page.

mod page;

use std::path::PathBuf;

use anyhow::Context;
use bench_scenes::{Overrides, ReadOptions, load_as};
use metaball_core::gpu::AdapterChoice;

use crate::conclusions::conclusions;
use crate::console::{self, ProgressBar, note_reasons, open_adapter_if_any, table};
use crate::outputs::output_files;
use crate::page::cpu_remark;
use crate::shortfall::nothing_done;
use harness::comparison::{self, compare_scene, steps};
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
    /// How files are read.
    pub reading: ReadOptions,
    /// What to change about every scene.
    pub overrides: Overrides,
    /// How.
    pub comparison: comparison::Options,
    /// What to draw with; `None`: methods that need no adapter, and no others.
    pub adapter: Option<AdapterChoice>,
    /// Folder for `index.html`, `records.json` and `records.csv`.
    pub out: PathBuf,
}

/// Compares, prints a table, writes the page and the records. A scene that does not load or a method
/// that does not build is reported and left out; so is one that needs an adapter where there is none.
///
/// # Errors
/// When there is no such adapter, when a file cannot be written or is an input, or when nothing worked at
/// all.
pub fn compare(options: &Options) -> anyhow::Result<()> {
    let hits: Vec<_> =
        options.comparison.imported.iter().map(|imported| imported.file.clone()).collect();
    let names = ["index.html", "records.json", "records.csv"];
    let [page, json, csv] = output_files(&options.out, names, &options.scenes, &hits)?;
    let gpu = open_adapter_if_any(options.adapter.as_ref(), &options.comparison.configurations)?;
    let gpu = gpu.as_ref();

    let mut records = Records { provenance: Provenance::here(SCHEMA), records: Vec::new() };
    let mut scenes = Vec::new();
    let mut remarks: Vec<_> = cpu_remark(gpu).into_iter().collect();
    let progress = ProgressBar::new(steps(&options.comparison) * options.scenes.len() as u64);
    for (index, spec) in options.scenes.iter().enumerate() {
        progress.stage(format!("{spec}: loading"));
        let scene = load_as(spec, &options.reading, &options.overrides)
            .map_err(anyhow::Error::from)
            .and_then(|bench| {
                let notes = bench.file.iter().flat_map(|file| &file.notes);
                notes.for_each(|note| progress.note(&format!("{spec}: {note}")));
                compare_scene(gpu, &bench, &options.comparison, &progress)
            })
            .with_context(|| format!("scene {spec}"));
        match scene {
            Ok(scene) => {
                // Of a run that is cut short this is left.
                records.records.extend(scene.records.iter().cloned());
                records.write(&json)?;
                scenes.push(scene);
            }
            Err(error) => {
                let remark = format!("{error:#}");
                progress.note(&remark);
                remarks.push(remark);
            }
        }
        progress.reach(steps(&options.comparison) * (index as u64 + 1));
    }
    drop(progress);

    let worked =
        records.records.iter().any(|record| matches!(record.status, Status::Ok | Status::Scored));
    if worked {
        console::line(&results(&records.records));
        let by_scene: Vec<_> = scenes.iter().map(|scene| scene.records.as_slice()).collect();
        for sentence in conclusions(&by_scene) {
            console::line(&format!("\n{sentence}"));
        }
    }
    note_reasons(&records.records);
    for scene in &scenes {
        for remark in &scene.remarks {
            console::note(&format!("{}: {remark}", scene.scene));
        }
    }
    records.write(&json)?;
    write_csv(&csv, &records.records)?;
    write_atomically(&page, page::page(&records, &scenes, &remarks).as_bytes())?;
    console::line(&format!("\n{}", page.display()));
    if !worked {
        let said = "nothing could be compared; the reasons are above";
        let configurations = &options.comparison.configurations;
        return Err(nothing_done(said, (options.adapter.as_ref(), gpu), configurations));
    }
    Ok(())
}

/// The table of all records that have a result.
pub(crate) fn results(records: &[Record]) -> String {
    let headings = [
        "scene",
        "balls",
        "method",
        "on",
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
            measured.map_or_else(dash, |_| record.adapter.short()),
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

#[cfg(test)]
mod tests {
    use harness::configuration::sweeps::presets;
    use harness::measure::Sampling;
    use harness::record::Processor;

    use super::*;
    use crate::testing::assert_stands_alone;

    #[test]
    fn without_an_adapter_methods_on_the_cpu_are_compared_and_the_others_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let comparison = comparison::Options {
            configurations: presets(&["fbvh", "fbvh-certified-cpu", "kanamori-cpu", "illes"]),
            size: (32, 24),
            sampling: Sampling::exactly(2),
            along_path: false,
            every_pixel: false,
            imported: Vec::new(),
            counts_work: true,
        };
        let options = Options {
            scenes: vec!["two-merging".to_owned()],
            reading: ReadOptions::default(),
            overrides: Overrides::default(),
            comparison,
            adapter: None,
            out: folder.path().to_owned(),
        };
        compare(&options).expect("compared");
        let read = |name| std::fs::read_to_string(folder.path().join(name)).expect("written");
        let records: Records = serde_json::from_str(&read("records.json")).expect("records");
        let drawn = |record: &&Record| record.status == Status::Ok;
        let (drawn, left_out): (Vec<_>, Vec<_>) = records.records.iter().partition(drawn);
        let names = |records: &[&Record]| -> Vec<_> {
            records.iter().map(|record| record.method.clone()).collect()
        };
        assert_eq!(names(&drawn), ["fbvh-certified-cpu", "kanamori-cpu"]);
        assert!(drawn.iter().all(|record| record.adapter.processor == Some(Processor::Cpu)));
        assert_eq!(names(&left_out), ["fbvh", "illes"]);
        let page = read("index.html");
        assert_stands_alone(&page, &["NaN"]);
        assert_eq!(page.matches("needed a graphics adapter, found none").count(), 2);
        assert!(page.contains("threads, no graphics interface: fbvh-certified-cpu, kanamori-cpu"));
        assert!(page.contains("Without a graphics adapter"));

        // Where all of them need one there is nothing to compare.
        let configurations = presets(&["fbvh"]);
        let comparison = comparison::Options { configurations, ..options.comparison.clone() };
        assert!(compare(&Options { comparison, ..options }).is_err());
    }
}
