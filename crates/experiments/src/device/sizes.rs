//! The part `sizes`: frame times by number of balls and size of the picture.

use std::path::Path;

use bench_scenes::{Overrides, load};
use harness::comparison::{self, compare_scene};
use harness::configuration::sweeps::presets;
use harness::machine::Provenance;
use harness::measure::Sampling;
use harness::record::{Records, SCHEMA, Status};
use metaball_core::gpu::Gpu;

use super::Scale;
use crate::compare::results;
use crate::console::{self, note_reasons};

/// A scene, and what draws it in which sizes.
struct Row {
    spec: &'static str,
    sizes: &'static [(u32, u32)],
    methods: &'static [&'static str],
}

const PICTURES: &[(u32, u32)] = &[(640, 480), (1920, 1080), (3840, 2160)];
const FAMILIES: &[&str] =
    &["fbvh-certified", "fbvh", "kanamori-robust", "illes-compute", "fbvh-certified-cpu"];
const CERTIFIED: &[&str] = &["fbvh-certified", "fbvh-certified-cpu"];

const WHOLE: &[Row] = &[
    Row { spec: "scattered:10000", sizes: PICTURES, methods: FAMILIES },
    Row { spec: "scattered:100000", sizes: PICTURES, methods: FAMILIES },
    Row { spec: "scattered:1000000", sizes: PICTURES, methods: CERTIFIED },
    Row { spec: "scattered:10000000", sizes: PICTURES, methods: CERTIFIED },
];

const REHEARSAL: &[Row] = &[
    Row { spec: "scattered:100", sizes: &[(16, 12), (32, 24)], methods: CERTIFIED },
    Row { spec: "scattered:300", sizes: &[(16, 12)], methods: CERTIFIED },
];

/// Measures scene by scene and size by size, and writes `records.json` after each size.
///
/// # Errors
/// When nothing could be measured, or the file cannot be written.
pub(super) fn measure(gpu: Option<&Gpu>, scale: Scale, out: &Path) -> anyhow::Result<()> {
    let (rows, frames) = match scale {
        Scale::Whole => (WHOLE, 20),
        Scale::Rehearsal => (REHEARSAL, 2),
    };
    let mut records = Records { provenance: Provenance::here(SCHEMA), records: Vec::new() };
    for Row { spec, sizes, methods } in rows {
        let bench = load(spec, &Overrides::default())?;
        for &size in *sizes {
            let options = comparison::Options {
                configurations: presets(methods),
                size,
                sampling: Sampling { most: frames, ..Sampling::QUICK },
                along_path: false,
                every_pixel: false,
                imported: Vec::new(),
                counts_work: false,
            };
            match compare_scene(gpu, &bench, &options, &()) {
                Ok(compared) => {
                    let (width, height) = size;
                    console::line(&format!("{width} × {height}\n{}", results(&compared.records)));
                    note_reasons(&compared.records);
                    records.records.extend(compared.records);
                }
                Err(error) => console::note(&format!("{spec}, {size:?}: {error:#}")),
            }
            records.write(&out.join("records.json"))?;
        }
    }
    let is_measured = records.records.iter().any(|record| record.status == Status::Ok);
    anyhow::ensure!(is_measured, "nothing could be measured");
    Ok(())
}
