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
use self::run::Run;
use super::heading::{self, Heading};
use super::run::Shoot;
use crate::console;
use crate::tables::{Extent, Order};
use harness::numbers::decimal;

/// Name and version of the format of `gourmel-light.json`.
pub const SCHEMA: &str = "metaball-tables-gourmel-light/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Its format is [`SCHEMA`].
    #[serde(flatten)]
    pub heading: Heading,
    /// Table 2.
    pub costs: Vec<CostRow>,
    /// Table 1.
    pub gains: Vec<GainRow>,
    /// Everything that was measured, once each.
    pub runs: Vec<Run>,
}

/// Measures, prints the tables, and writes them.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(order: &Order) -> anyhow::Result<()> {
    let gpu = Gpu::new(&order.adapter)?;
    console::note(&gpu.report().to_string());
    let measurements = measure(&gpu, order.extent, heading::shoot(order, &gpu, (160, 120)));
    console::line(&format!("\n{COSTS_TITLE}"));
    console::line(&console::table(&COST_HEADINGS, &cost_rows(&measurements.costs)));
    for row in &measurements.costs {
        if let Some(why) = &row.why {
            console::line(&format!("  {}, {}: {why}", row.scene, row.effect));
        }
    }
    console::line(&format!("\n{GAINS_TITLE}"));
    console::line(&console::table(&GAIN_HEADINGS, &gain_rows(&measurements.gains)));
    for remark in &measurements.heading.remarks {
        console::line(&format!("  {remark}"));
    }
    let page = page::page(&measurements);
    heading::write(order, "gourmel-light", &measurements, &page, measurements.runs.len())
}

fn measure(gpu: &Gpu, extent: Extent, shoot: Shoot) -> Measurements {
    let mut heading = Heading::new(SCHEMA, gpu, extent, shoot);
    let scenes = compare::measurements(extent);
    let runs = heading.measure(scenes, run::steps(shoot), |spec, wanted, progress| {
        run::measure(gpu, spec, wanted, shoot, progress)
    });
    Measurements {
        heading,
        costs: compare::costs(extent, &runs),
        gains: compare::gains(extent, &runs),
        runs,
    }
}

/// Headings of the tables, for the terminal and the page.
const COSTS_TITLE: &str = "Table 2: times as long as a ray cast";
const COST_HEADINGS: [&str; 5] = ["scene", "effects", "paper", "fbvh", "fbvh-certified"];
const GAINS_TITLE: &str = "Table 1: times as fast as the modified BVH, with each scene's effects";
const GAIN_HEADINGS: [&str; 5] = ["scene", "effects", "paper", "fbvh", "fbvh-certified"];

fn cost_rows(rows: &[CostRow]) -> Vec<Vec<String>> {
    let row = |row: &CostRow| {
        let ratios = [Some(row.paper), row.fitted, row.certified];
        cells([&row.scene, &row.effect], ratios)
    };
    rows.iter().map(row).collect()
}

fn gain_rows(rows: &[GainRow]) -> Vec<Vec<String>> {
    let row = |row: &GainRow| {
        let ratios = [Some(row.paper), row.fitted, row.certified];
        cells([&row.scene, &row.effect], ratios)
    };
    rows.iter().map(row).collect()
}

fn cells(texts: [&String; 2], ratios: [Option<f64>; 3]) -> Vec<String> {
    let ratios = ratios.map(|ratio| ratio.map_or_else(|| "–".to_owned(), decimal));
    texts.into_iter().cloned().chain(ratios).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_of_every_table_is_measured() {
        let Some(gpu) = Gpu::for_test() else { return };
        let shoot = Shoot { size: (24, 16), cameras: 2 };
        let measurements = measure(&gpu, Extent::Quick, shoot);
        let costs = &measurements.costs;
        assert!(costs.iter().all(|row| row.fitted.is_some() && row.certified.is_some()));
        let gains = &measurements.gains;
        assert!(gains.iter().all(|row| row.fitted.is_some() && row.certified.is_some()));
        assert!(measurements.runs.iter().all(|run| run.frame_ms.samples.len() == 2));
        // Shadow and occlusion rays are sent where there are such effects, and nowhere else.
        let sends_them = |run: &Run| run.passes.contains_key("any hits");
        for run in &measurements.runs {
            let wanted = run.effect.contains("shadow") || run.effect.contains("occlusion");
            assert_eq!(sends_them(run), wanted, "{run:?}");
        }

        let text = serde_json::to_string(&measurements).expect("JSON");
        let back: Measurements = serde_json::from_str(&text).expect("as written");
        assert_eq!(
            (back.heading.provenance.schema.as_str(), back.runs.len()),
            (SCHEMA, measurements.runs.len())
        );
        let page = page::page(&measurements);
        for forbidden in ["<script", "http", "url(", "{{"] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        assert!(page.contains("Table 2") && page.ends_with("</html>\n"));
    }
}
