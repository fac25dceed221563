//! The command `tables gourmel`: the tables of Gourmel et al. 2010, section 6, and the plots of a
//! later implementation.

pub mod compare;
mod page;
pub mod paper;
pub mod plan;
pub mod run;
pub mod settings;

use std::collections::BTreeSet;
use std::path::PathBuf;

use anyhow::Context;
use metaball_core::gpu::{AdapterChoice, Gpu};
use serde::{Deserialize, Serialize};

use self::compare::{Density, Row, Table, WorkRow};
use self::plan::{Extent, Quantity, Series};
use self::run::{Run, Shoot};
use self::settings::Setting;
use crate::console::{self, Progress};
use crate::machine::Provenance;
use crate::numbers::decimal;
use crate::output::{write_atomically, write_json};
use crate::record::Adapter;

/// Name and version of the format of `gourmel.json`.
pub const SCHEMA: &str = "metaball-tables-gourmel/1";

/// What to measure.
#[derive(Debug, Clone)]
pub struct Order {
    /// The paper's scenes, or small ones.
    pub extent: Extent,
    /// Pixels across and down; where it is left open the paper's 640 × 480, on an adapter that
    /// computes on the CPU 320 × 240, and 64 × 48 when quick.
    pub size: Option<(u32, u32)>,
    /// What to draw with.
    pub adapter: AdapterChoice,
    /// Folder for `gourmel.json` and `gourmel.html`.
    pub out: PathBuf,
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Where it comes from; its format is [`SCHEMA`].
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What drew.
    pub adapter: Adapter,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Cameras along each scene's path.
    pub cameras: usize,
    /// What a reader should know.
    pub remarks: Vec<String>,
    /// The paper's tables of frame rates.
    pub tables: Vec<Table>,
    /// Table 3.
    pub work_table: Vec<WorkRow>,
    /// What the gain on the molecule depends on.
    pub density: Density,
    /// Plots; their points name runs.
    pub series: Vec<Line>,
    /// Everything that was measured, once each.
    pub runs: Vec<Run>,
}

/// A line in a plot of frame time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// What it shows.
    pub title: String,
    /// Name of the horizontal axis.
    pub axis: String,
    /// Its points.
    pub points: Vec<Point>,
}

/// A point of a [`Line`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Where it stands on the horizontal axis.
    pub x: f64,
    /// Milliseconds of a frame, the mean over the cameras.
    pub frame_ms: f64,
    /// The run's scene.
    pub scene: String,
    /// The run's setting.
    pub setting: String,
}

/// Measures, prints the tables, and writes them.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(order: &Order) -> anyhow::Result<()> {
    let gpu = Gpu::new(&order.adapter)?;
    console::note(&gpu.report().to_string());
    let measurements = measure(&gpu, order.extent, shoot(&gpu, order))?;
    for table in &measurements.tables {
        console::line(&format!("\n{}: {}", table.name, table.title));
        console::line(&rows(table, &measurements.runs));
        for row in &table.rows {
            if let Some(why) = &row.why {
                console::line(&format!("  {}, {}: {why}", row.scene, row.setting));
            }
        }
    }
    console::line(&format!("\n{}", compare::DENSITY_TITLE));
    console::line(&console::table(&DENSITY_HEADINGS, &density_rows(&measurements.density)));
    if let Some(why) = &measurements.density.why {
        console::line(&format!("  {why}"));
    }
    let page = order.out.join("gourmel.html");
    write_json(&order.out.join("gourmel.json"), &measurements)?;
    write_atomically(&page, page::page(&measurements).as_bytes())?;
    console::line(&format!("\n{}", page.display()));
    anyhow::ensure!(!measurements.runs.is_empty(), "nothing could be measured; see the page");
    Ok(())
}

/// Pictures that the adapter draws in bearable time.
fn shoot(gpu: &Gpu, order: &Order) -> Shoot {
    let (size, cameras) = match order.extent {
        Extent::Quick => ((64, 48), 2),
        Extent::Whole if gpu.report().is_software() => ((320, 240), 4),
        Extent::Whole => ((640, 480), 16),
    };
    Shoot { size: order.size.unwrap_or(size), cameras }
}

fn measure(gpu: &Gpu, extent: Extent, shoot: Shoot) -> anyhow::Result<Measurements> {
    let plan = extent.measurements();
    let mut remarks = Vec::new();
    if extent == Extent::Quick {
        remarks
            .push("Quick: scenes of a few hundred balls in the place of the paper's.".to_owned());
    }
    if gpu.report().is_software() {
        remarks.push("Drawn on the CPU: these times say nothing of a GPU.".to_owned());
    }
    let settings: usize = plan.values().map(BTreeSet::len).sum();
    let progress = Progress::new(settings as u64 * shoot.steps());
    let mut done = 0;
    let mut runs = Vec::new();
    for (spec, settings) in &plan {
        let measured = run::measure(gpu, spec, settings, shoot, &progress)
            .with_context(|| format!("scene {spec}"))
            .unwrap_or_else(|error| vec![Err(error)]);
        for run in measured {
            match run {
                Ok(run) => runs.push(run),
                Err(error) => remarks.push(format!("{error:#}")),
            }
        }
        done += settings.len() as u64 * shoot.steps();
        progress.reach(done);
    }
    drop(progress);
    Ok(Measurements {
        provenance: Provenance::here(SCHEMA),
        adapter: Adapter::from(gpu.report()),
        width: shoot.size.0,
        height: shoot.size.1,
        cameras: shoot.cameras,
        remarks,
        tables: compare::tables(extent, &runs),
        work_table: compare::work_table(extent, &runs),
        density: compare::density(extent, &runs),
        series: lines(extent, &runs),
        runs,
    })
}

fn lines(extent: Extent, runs: &[Run]) -> Vec<Line> {
    let line = |series: Series| {
        let point = |(scene, setting): &(String, Setting)| {
            let run = compare::find(runs, scene, &setting.name())?;
            let x = match series.quantity {
                Quantity::Balls => run.balls as f64,
                Quantity::Depth => run.tree.depth as f64,
                Quantity::Split => run.tree.split_per_leaf,
            };
            let (scene, setting) = (run.scene.clone(), run.setting.clone());
            Some(Point { x, frame_ms: run.mean_ms(), scene, setting })
        };
        Line {
            title: series.title.to_owned(),
            axis: series.axis.to_owned(),
            points: series.points.iter().filter_map(point).collect(),
        }
    };
    extent.series().into_iter().map(line).collect()
}

/// A table for the terminal.
fn rows(table: &Table, runs: &[Run]) -> String {
    let headings =
        ["scene", "structure", "build ms", "frame ms", "times as fast", "paper", "kernels/ray"];
    let dash = || "–".to_owned();
    let row = |row: &Row| {
        let run = compare::find(runs, &row.scene, &row.setting);
        let number = |of: fn(&Run) -> f64| run.map_or_else(dash, |run| decimal(of(run)));
        vec![
            row.scene.clone(),
            row.setting.clone(),
            number(|run| run.build_ms.median),
            number(Run::mean_ms),
            row.ratio.map_or_else(dash, decimal),
            row.paper_ratio.map_or_else(dash, decimal),
            number(Run::kernels_per_ray),
        ]
    };
    console::table(&headings, &table.rows.iter().map(row).collect::<Vec<_>>())
}

/// Columns of the table of densities.
const DENSITY_HEADINGS: [&str; 5] =
    ["scene", "supports", "times as fast", "kernels/ray saved", "nodes/ray saved"];

/// Its rows, for the terminal and the page.
fn density_rows(density: &Density) -> Vec<Vec<String>> {
    let ratio = |ratio: Option<f64>| ratio.map_or_else(|| "–".to_owned(), decimal);
    let row = |row: &compare::DensityRow| {
        let ratios = [row.time, row.kernels, row.nodes].map(ratio);
        [row.scene.clone(), format!("× {}", row.supports)].into_iter().chain(ratios).collect()
    };
    density.rows.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_of_every_table_is_measured() {
        let Some(gpu) = Gpu::for_test() else { return };
        let shoot = Shoot { size: (32, 24), cameras: 2 };
        let measurements = measure(&gpu, Extent::Quick, shoot).expect("measured");
        for table in &measurements.tables {
            for row in &table.rows {
                assert_eq!(row.ratio.is_some(), row.paper_ratio.is_some(), "{row:?}");
            }
        }
        assert!(measurements.work_table.iter().all(|row| row.measured.is_some()));
        assert!(measurements.density.why.is_some(), "{:?}", measurements.density);
        assert!(measurements.series.iter().all(|line| line.points.len() >= 2));
        assert!(measurements.runs.iter().all(|run| run.frame_ms.samples.len() == 2));

        let text = serde_json::to_string(&measurements).expect("JSON");
        let back: Measurements = serde_json::from_str(&text).expect("as written");
        assert_eq!(
            (back.provenance.schema.as_str(), back.runs.len()),
            (SCHEMA, measurements.runs.len())
        );
        let page = page::page(&measurements);
        for forbidden in ["<script", "http", "url(", "no result", "{{"] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        assert!(page.contains("Table 5") && page.ends_with("</html>\n"));
    }
}
