//! The command `tables gourmel`: the tables of Gourmel et al. 2010, section 6, and the plots of a
//! later implementation. `tables gourmel-light`, in [`light`], is those of pictures with effects.

pub mod compare;
mod heading;
pub mod light;
mod page;
pub mod paper;
pub mod paper_scene;
pub mod plan;
pub mod run;
pub mod settings;

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use self::compare::{Density, Row, Table, WorkRow};
pub use self::heading::Heading;
use self::plan::{Quantity, Series, measurements, series};
use self::run::{Run, Shoot};
use self::settings::Setting;
use crate::console;
use crate::tables::{Extent, Order};
use harness::numbers::decimal;

/// Name and version of the format of `gourmel.json`.
pub const SCHEMA: &str = "metaball-tables-gourmel/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Its format is [`SCHEMA`].
    #[serde(flatten)]
    pub heading: Heading,
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
    let measurements = measure(&gpu, order.extent, heading::shoot(order, &gpu, (320, 240)));
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
    let page = page::page(&measurements);
    heading::write(order, "gourmel", &measurements, &page, measurements.runs.len())
}

fn measure(gpu: &Gpu, extent: Extent, shoot: Shoot) -> Measurements {
    let mut heading = Heading::new(SCHEMA, gpu, extent, shoot);
    let scenes = measurements(extent).into_iter();
    let scenes = scenes.map(|(spec, settings)| (spec, settings.into_iter().collect()));
    let runs = heading.measure(scenes, shoot.steps(), |spec, settings, progress| {
        run::measure(gpu, spec, settings, shoot, progress)
    });
    Measurements {
        heading,
        tables: compare::tables(extent, &runs),
        work_table: compare::work_table(extent, &runs),
        density: compare::density(extent, &runs),
        series: lines(extent, &runs),
        runs,
    }
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
    series(extent).into_iter().map(line).collect()
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
        let measurements = measure(&gpu, Extent::Quick, shoot);
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
            (back.heading.provenance.schema.as_str(), back.runs.len()),
            (SCHEMA, measurements.runs.len())
        );
        let page = page::page(&measurements);
        for forbidden in ["<script", "http", "url(", "no result", "{{"] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        assert!(page.contains("Table 5") && page.ends_with("</html>\n"));
    }
}
