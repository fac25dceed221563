//! The command `tables gourmel-light`: Gourmel et al. 2010, table 2, what effects cost; and table 1
//! under each scene's own effects.

pub mod compare;
pub mod effect;
mod page;
pub mod paper;
pub mod run;

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use self::compare::{CostRow, GainRow};
use self::run::EffectRun;
use super::path_heading::{PathHeading, camera_path};
use super::run::CameraPath;
use crate::console::open_adapter;
use crate::extent::Extent;
use crate::table::{Column, Table};
use crate::tables::Options;
use crate::tables::report::{Report, publish};
use harness::numbers::decimal;

/// Name and version of the format of `gourmel-light.json`.
pub const SCHEMA: &str = "metaball-tables-gourmel-light/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Its format is [`SCHEMA`].
    #[serde(flatten)]
    pub heading: PathHeading,
    /// Table 2.
    pub costs: Vec<CostRow>,
    /// Table 1.
    pub gains: Vec<GainRow>,
    /// Everything that was measured, once each.
    pub runs: Vec<EffectRun>,
}

/// Measures, prints the tables, and writes `gourmel-light.html` and `gourmel-light.json`.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(options: &Options) -> anyhow::Result<()> {
    let gpu = open_adapter(&options.adapter)?;
    let path = camera_path(options, &gpu, (160, 120));
    publish(&options.out, &[], || Ok(measure(&gpu, options.extent, path)))
}

fn measure(gpu: &Gpu, extent: Extent, path: CameraPath) -> Measurements {
    let mut heading = PathHeading::new(SCHEMA, gpu, extent, path);
    let scenes = compare::measurements(extent);
    let runs = heading.measure(scenes, run::steps(path), |spec, wanted, progress| {
        run::measure(gpu, spec, wanted, path, progress)
    });
    Measurements {
        heading,
        costs: compare::costs(extent, &runs),
        gains: compare::gains(extent, &runs),
        runs,
    }
}

impl Report for Measurements {
    const NAME: &'static str = "gourmel-light";

    fn text(&self) -> String {
        let (costs, gains) = (cost_table(&self.costs), gain_table(&self.gains));
        let mut lines = vec![format!("\n{}", costs.title), costs.text()];
        let why =
            |row: &CostRow| Some(format!("  {}, {}: {}", row.scene, row.effect, row.why.as_ref()?));
        lines.extend(self.costs.iter().filter_map(why));
        lines.push(format!("\n{}", gains.title));
        lines.push(self.heading.heading.text_with_remarks(&gains));
        lines.join("\n")
    }

    fn page(&self) -> String {
        page::page(self)
    }

    fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }
}

fn cost_table(rows: &[CostRow]) -> Table {
    let row = |row: &CostRow| {
        cells([&row.scene, &row.effect], [Some(row.paper), row.fitted, row.certified])
    };
    table("Table 2: times as long as a ray cast", rows.iter().map(row).collect())
}

fn gain_table(rows: &[GainRow]) -> Table {
    let row = |row: &GainRow| {
        cells([&row.scene, &row.effect], [Some(row.paper), row.fitted, row.certified])
    };
    let title = "Table 1: times as fast as the modified BVH, with each scene's effects";
    table(title, rows.iter().map(row).collect())
}

/// A table of ratios: the paper's, and ours by tree.
fn table(title: &str, rows: Vec<Vec<String>>) -> Table {
    let columns = [
        Column::text("scene"),
        Column::text("effects"),
        Column::number("paper"),
        Column::number("fbvh"),
        Column::number("fbvh-certified"),
    ];
    Table { title: title.to_owned(), columns: columns.into(), rows }
}

fn cells(texts: [&String; 2], ratios: [Option<f64>; 3]) -> Vec<String> {
    let ratios = ratios.map(|ratio| ratio.map_or_else(|| "–".to_owned(), decimal));
    texts.into_iter().cloned().chain(ratios).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{assert_stands_alone, read_back};

    #[test]
    fn every_cell_of_every_table_is_measured() {
        let Some(gpu) = Gpu::for_test() else { return };
        let path = CameraPath { size: (24, 16), cameras: 2 };
        let measurements = measure(&gpu, Extent::Quick, path);
        let costs = &measurements.costs;
        assert!(costs.iter().all(|row| row.fitted.is_some() && row.certified.is_some()));
        let gains = &measurements.gains;
        assert!(gains.iter().all(|row| row.fitted.is_some() && row.certified.is_some()));
        assert!(measurements.runs.iter().all(|run| run.frame_ms.samples.len() == 2));
        // Shadow and occlusion rays are sent where there are such effects, and nowhere else.
        let has_shadow_rays = |run: &EffectRun| run.passes.contains_key("any hits");
        for run in &measurements.runs {
            let wanted = run.effect.contains("shadow") || run.effect.contains("occlusion");
            assert_eq!(has_shadow_rays(run), wanted, "{run:?}");
        }

        let back = read_back(&measurements);
        assert_eq!(
            (back.heading.heading.provenance.schema.as_str(), back.runs.len()),
            (SCHEMA, measurements.runs.len())
        );
        let page = page::page(&measurements);
        assert_stands_alone(&page, &[]);
        assert!(page.contains("Table 2"));
    }
}
