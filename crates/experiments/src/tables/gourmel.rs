//! The command `tables gourmel`: the tables of Gourmel et al. 2010, section 6, and the plots of a
//! later implementation. `tables gourmel-light`, in [`light`], is those of pictures with effects.

pub mod compare;
pub mod light;
mod page;
pub mod paper;
pub mod paper_scene;
mod path_heading;
pub mod plan;
pub mod run;
pub mod tree_variant;

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use self::compare::{Density, Row, WorkRow};
use self::path_heading::{PathHeading, camera_path};
use self::plan::{Quantity, Series, measurements, series};
use self::run::{CameraPath, TreeRun};
use self::tree_variant::TreeVariant;
use crate::console::{self, open_adapter};
use crate::extent::Extent;
use crate::table::{Column, Table};
use crate::tables::Options;
use crate::tables::report::{Report, publish};
use harness::numbers::decimal;

/// Name and version of the format of `gourmel.json`.
pub const SCHEMA: &str = "metaball-tables-gourmel/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Its format is [`SCHEMA`].
    #[serde(flatten)]
    pub heading: PathHeading,
    /// The paper's tables of frame rates.
    pub tables: Vec<compare::Table>,
    /// Table 3.
    pub work_table: Vec<WorkRow>,
    /// What the gain on the molecule depends on; nothing in files from before it was measured.
    #[serde(default)]
    pub density: Density,
    /// Plots; their points name runs.
    pub series: Vec<Line>,
    /// Everything that was measured, once each.
    pub runs: Vec<TreeRun>,
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
    /// Its position on the horizontal axis.
    pub x: f64,
    /// Milliseconds of a frame, the mean over the cameras.
    pub frame_ms: f64,
    /// The run's scene.
    pub scene: String,
    /// The run's tree.
    #[serde(rename = "setting")]
    pub variant: String,
}

/// Measures, prints the tables, and writes `gourmel.html` and `gourmel.json`.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(options: &Options) -> anyhow::Result<()> {
    let gpu = open_adapter(&options.adapter)?;
    let path = camera_path(options, &gpu, (320, 240));
    publish(&options.out, &[], || Ok(measure(&gpu, options.extent, path)))
}

fn measure(gpu: &Gpu, extent: Extent, path: CameraPath) -> Measurements {
    let mut heading = PathHeading::new(SCHEMA, gpu, extent, path);
    let scenes = measurements(extent).into_iter();
    let scenes = scenes.map(|(spec, variants)| (spec, variants.into_iter().collect()));
    let runs = heading.measure(scenes, path.steps(), |spec, variants, progress| {
        run::measure(gpu, spec, variants, path, progress)
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

impl Report for Measurements {
    const NAME: &'static str = "gourmel";

    fn text(&self) -> String {
        let mut lines = Vec::new();
        for table in &self.tables {
            lines.push(format!("\n{}: {}", table.name, table.title));
            lines.push(rows(table, &self.runs));
            let why = |row: &Row| {
                let why = row.why.as_ref()?;
                Some(format!("  {}, {}: {why}", row.scene, row.variant))
            };
            lines.extend(table.rows.iter().filter_map(why));
        }
        let density = density_table(&self.density);
        lines.push(format!("\n{}", density.title));
        lines.push(density.text());
        lines.extend(self.density.why.iter().map(|why| format!("  {why}")));
        lines.join("\n")
    }

    fn page(&self) -> String {
        page::page(self)
    }

    fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }
}

fn lines(extent: Extent, runs: &[TreeRun]) -> Vec<Line> {
    let line = |series: Series| {
        let point = |(scene, variant): &(String, TreeVariant)| {
            let run = compare::find(runs, scene, &variant.name())?;
            let x = match series.quantity {
                Quantity::Balls => run.balls as f64,
                Quantity::Depth => run.tree.depth as f64,
                Quantity::Split => run.tree.split_per_leaf,
            };
            let (scene, variant) = (run.scene.clone(), run.variant.clone());
            Some(Point { x, frame_ms: run.mean_ms(), scene, variant })
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
fn rows(table: &compare::Table, runs: &[TreeRun]) -> String {
    let headings =
        ["scene", "structure", "build ms", "frame ms", "times as fast", "paper", "kernels/ray"];
    let dash = || "–".to_owned();
    let row = |row: &Row| {
        let run = compare::find(runs, &row.scene, &row.variant);
        let number = |of: fn(&TreeRun) -> f64| run.map_or_else(dash, |run| decimal(of(run)));
        vec![
            row.scene.clone(),
            row.variant.clone(),
            number(|run| run.build_ms.median),
            number(TreeRun::mean_ms),
            row.ratio.map_or_else(dash, decimal),
            row.paper_ratio.map_or_else(dash, decimal),
            number(TreeRun::kernels_per_ray),
        ]
    };
    console::table(&headings, &table.rows.iter().map(row).collect::<Vec<_>>())
}

/// The table of densities.
fn density_table(density: &Density) -> Table {
    let columns = [
        Column::text("scene"),
        Column::number("supports"),
        Column::number("times as fast"),
        Column::number("kernels/ray saved"),
        Column::number("nodes/ray saved"),
    ];
    let ratio = |ratio: Option<f64>| ratio.map_or_else(|| "–".to_owned(), decimal);
    let row = |row: &compare::DensityRow| {
        let ratios = [row.time, row.kernels, row.nodes].map(ratio);
        [row.scene.clone(), format!("× {}", row.supports)].into_iter().chain(ratios).collect()
    };
    let title = "Table 1, the molecule sparser and denser (not in the paper)".to_owned();
    Table { title, columns: columns.into(), rows: density.rows.iter().map(row).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{assert_stands_alone, read_back};

    #[test]
    fn every_cell_of_every_table_is_measured() {
        let Some(gpu) = Gpu::for_test() else { return };
        let path = CameraPath { size: (32, 24), cameras: 2 };
        let measurements = measure(&gpu, Extent::Quick, path);
        for table in &measurements.tables {
            for row in &table.rows {
                assert_eq!(row.ratio.is_some(), row.paper_ratio.is_some(), "{row:?}");
            }
        }
        assert!(measurements.work_table.iter().all(|row| row.measured.is_some()));
        assert!(measurements.density.why.is_some(), "{:?}", measurements.density);
        assert!(measurements.series.iter().all(|line| line.points.len() >= 2));
        assert!(measurements.runs.iter().all(|run| run.frame_ms.samples.len() == 2));

        let back = read_back(&measurements);
        assert_eq!(
            (back.heading.heading.provenance.schema.as_str(), back.runs.len()),
            (SCHEMA, measurements.runs.len())
        );
        let page = page::page(&measurements);
        assert_stands_alone(&page, &["no result"]);
        assert!(page.contains("Table 5"));
    }
}
