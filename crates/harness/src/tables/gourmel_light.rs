//! The command `tables gourmel-light`: Gourmel et al. 2010, table 2, what effects cost; and table 1
//! under each scene's own effects.

pub mod compare;
pub mod effect;
mod page;
pub mod paper;
pub mod run;

use std::path::PathBuf;

use anyhow::Context;
use metaball_core::gpu::{AdapterChoice, Gpu};
use serde::{Deserialize, Serialize};

use self::compare::{CostRow, GainRow};
use self::run::Run;
use crate::console::{self, Progress};
use crate::machine::Provenance;
use crate::numbers::decimal;
use crate::output::{write_atomically, write_json};
use crate::record::Adapter;
use crate::tables::gourmel::plan::Extent;
use crate::tables::gourmel::run::Shoot;

/// Name and version of the format of `gourmel-light.json`.
pub const SCHEMA: &str = "metaball-tables-gourmel-light/1";

/// What to measure.
#[derive(Debug, Clone)]
pub struct Order {
    /// The paper's scenes, or small ones.
    pub extent: Extent,
    /// Pixels across and down; where it is left open the paper's 640 × 480, on an adapter that
    /// computes on the CPU 160 × 120, and 64 × 48 when quick.
    pub size: Option<(u32, u32)>,
    /// What to draw with.
    pub adapter: AdapterChoice,
    /// Folder for `gourmel-light.json` and `gourmel-light.html`.
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
    let measurements = measure(&gpu, order.extent, shoot(&gpu, order));
    console::line(&format!("\n{COSTS_TITLE}"));
    console::line(&console::table(&COST_HEADINGS, &cost_rows(&measurements.costs)));
    for row in &measurements.costs {
        if let Some(why) = &row.why {
            console::line(&format!("  {}, {}: {why}", row.scene, row.effect));
        }
    }
    console::line(&format!("\n{GAINS_TITLE}"));
    console::line(&console::table(&GAIN_HEADINGS, &gain_rows(&measurements.gains)));
    for remark in &measurements.remarks {
        console::line(&format!("  {remark}"));
    }
    let page = order.out.join("gourmel-light.html");
    write_json(&order.out.join("gourmel-light.json"), &measurements)?;
    write_atomically(&page, page::page(&measurements).as_bytes())?;
    console::line(&format!("\n{}", page.display()));
    anyhow::ensure!(!measurements.runs.is_empty(), "nothing could be measured; see the page");
    Ok(())
}

/// Pictures that the adapter draws in bearable time.
fn shoot(gpu: &Gpu, order: &Order) -> Shoot {
    let (size, cameras) = match order.extent {
        Extent::Quick => ((64, 48), 2),
        Extent::Whole if gpu.report().is_software() => ((160, 120), 4),
        Extent::Whole => ((640, 480), 16),
    };
    Shoot { size: order.size.unwrap_or(size), cameras }
}

fn measure(gpu: &Gpu, extent: Extent, shoot: Shoot) -> Measurements {
    let plan = compare::measurements(extent);
    let mut remarks = Vec::new();
    if extent == Extent::Quick {
        remarks
            .push("Quick: scenes of a few hundred balls in the place of the paper's.".to_owned());
    }
    if gpu.report().is_software() {
        remarks.push("Drawn on the CPU: these times say nothing of a GPU.".to_owned());
    }
    let pairs: usize = plan.iter().map(|(_, wanted)| wanted.len()).sum();
    let progress = Progress::new(pairs as u64 * run::steps(shoot));
    let mut done = 0;
    let mut runs = Vec::new();
    for (spec, wanted) in &plan {
        let measured = run::measure(gpu, spec, wanted, shoot, &progress)
            .with_context(|| format!("scene {spec}"))
            .unwrap_or_else(|error| vec![Err(error)]);
        for run in measured {
            match run {
                Ok(run) => runs.push(run),
                Err(error) => remarks.push(format!("{error:#}")),
            }
        }
        done += wanted.len() as u64 * run::steps(shoot);
        progress.reach(done);
    }
    drop(progress);
    Measurements {
        provenance: Provenance::here(SCHEMA),
        adapter: Adapter::from(gpu.report()),
        width: shoot.size.0,
        height: shoot.size.1,
        cameras: shoot.cameras,
        remarks,
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
        // Feelers are sent where there are shadows, and nowhere else.
        let feels = |run: &Run| run.passes.contains_key("any hits");
        for run in &measurements.runs {
            let wanted = run.effect.contains("shadow") || run.effect.contains("occlusion");
            assert_eq!(feels(run), wanted, "{run:?}");
        }

        let text = serde_json::to_string(&measurements).expect("JSON");
        let back: Measurements = serde_json::from_str(&text).expect("as written");
        assert_eq!(
            (back.provenance.schema.as_str(), back.runs.len()),
            (SCHEMA, measurements.runs.len())
        );
        let page = page::page(&measurements);
        for forbidden in ["<script", "http", "url(", "{{"] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        assert!(page.contains("Table 2") && page.ends_with("</html>\n"));
    }
}
