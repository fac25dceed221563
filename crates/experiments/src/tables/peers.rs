//! The command `tables peers`: the certified tree on the CPU against what a user would take instead,
//! POV-Ray's `blob`, whose field is the power kernel's with α = 2.

pub mod effect;
pub mod lamp_truth;
pub mod lit;
mod lit_table;
mod page;
pub mod povray;
pub mod run;

use std::path::PathBuf;

use metaball_core::Kernel;
use serde::{Deserialize, Serialize};

use self::povray::{INSTALL, Povray};
use self::run::{Measured, PlannedScene, Traced};
use crate::console::{self, ProgressBar};
use crate::extent::Extent;
use crate::table::{Column, Table};
use crate::tables::heading::Heading;
use crate::tables::named_or;
use crate::tables::report::{Report, publish};
use crate::tables::scene_result::SceneResult;
use harness::numbers::{decimal, grouped, small};

/// Name and version of the format of `peers.json`.
pub const SCHEMA: &str = "metaball-tables-peers/1";

/// What to measure.
#[derive(Debug, Clone)]
pub struct Options {
    /// What [`bench_scenes::load`] takes; the extent's own where empty.
    pub scenes: Vec<String>,
    /// How much.
    pub extent: Extent,
    /// Pixels across and down; the extent's own where left open.
    pub size: Option<(u32, u32)>,
    /// Folder for `peers.json` and `peers.html`.
    pub out: PathBuf,
}

impl Options {
    fn plan(&self) -> Vec<PlannedScene> {
        let (scenes, size, [rounds, lit_rounds]): (&[&str], _, _) = match self.extent {
            Extent::Quick => (&["scattered:300", "pool:300"], (64, 48), [2, 1]),
            Extent::Whole => (
                &["scattered:10000", "scattered-100k", "pool-10k", "tornado-128k", "molecule"],
                (640, 480),
                [5, 3],
            ),
        };
        let size = self.size.unwrap_or(size);
        let specs = named_or(&self.scenes, scenes);
        specs.into_iter().map(|spec| PlannedScene { spec, size, rounds, lit_rounds }).collect()
    }
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Its format is [`SCHEMA`].
    #[serde(flatten)]
    pub heading: Heading,
    /// Threads of either tracer.
    pub threads: usize,
    /// What the peer calls itself; `null` where it is not installed.
    pub peer: Option<String>,
    /// The scenes, in the order measured.
    pub scenes: Vec<SceneResult<Measured>>,
}

/// Measures, prints the table, and writes `peers.html` and `peers.json`.
///
/// # Errors
/// When a file cannot be written, or nothing could be measured.
pub fn tables(options: &Options) -> anyhow::Result<()> {
    let peer = Povray::find()?;
    if peer.is_none() {
        console::note(&absent());
    }
    publish(&options.out, &options.scenes, || Ok(measure(&options.plan(), peer.as_ref())))
}

impl Report for Measurements {
    const NAME: &'static str = "peers";

    fn text(&self) -> String {
        let lit = lit_table::table(&self.scenes);
        let primary = table(&self.scenes);
        let head = format!("\n{}\n{}\n\n{}", primary.title, primary.text(), lit.title);
        format!("{head}\n{}", self.heading.text_with_remarks(&lit))
    }

    fn page(&self) -> String {
        page::page(self)
    }

    fn is_empty(&self) -> bool {
        self.scenes.iter().all(|scene| scene.result.is_err())
    }
}

fn absent() -> String {
    format!("POV-Ray is not installed: its rows are skipped. {INSTALL}")
}

fn measure(plan: &[PlannedScene], peer: Option<&Povray>) -> Measurements {
    let progress = ProgressBar::new(plan.iter().map(PlannedScene::steps).sum());
    let measured = |planned: &PlannedScene| {
        let result = run::measure(planned, peer, &progress);
        SceneResult::new(&planned.spec, planned.size, result)
    };
    let scenes: Vec<_> = plan.iter().map(measured).collect();
    drop(progress);

    let mut remarks = Vec::new();
    if peer.is_none() {
        remarks.push(absent());
    }
    let replaced: Vec<_> = scenes.iter().filter_map(replaced_kernel).collect();
    if !replaced.is_empty() {
        remarks.push(format!(
            "Drawn with the power kernel of α = 2 instead of their own: {}.",
            replaced.join(", ")
        ));
    }
    Measurements {
        heading: Heading::new(SCHEMA, None, remarks),
        threads: run::THREADS,
        peer: peer.map(|peer| peer.version().to_owned()),
        scenes,
    }
}

fn replaced_kernel(scene: &SceneResult<Measured>) -> Option<&str> {
    let measured = scene.result.as_ref().ok()?;
    (measured.kernel != Kernel::QUARTIC.to_string()).then_some(scene.scene.as_str())
}

/// Three rows a scene: ours, the peer's, and what the oracle says; or one with a reason.
fn table(scenes: &[SceneResult<Measured>]) -> Table {
    let columns = [
        Column::text("scene"),
        Column::number("balls"),
        Column::text("tracer"),
        Column::number("prepare").of("ms"),
        Column::number("trace").of("ms"),
        Column::number("CPU").of("ms"),
        Column::number("times as fast"),
        Column::number("hits"),
        Column::number("missed"),
        Column::number("phantom"),
        Column::number("wrong front"),
        Column::number("error of t"),
        Column::number("worst").of("radii"),
    ];
    let rows = scenes.iter().flat_map(rows_of).collect();
    Table { title: "Primary rays on the CPU".to_owned(), columns: columns.into(), rows }
}

fn rows_of(scene: &SceneResult<Measured>) -> Vec<Vec<String>> {
    let head =
        |balls: &str, tracer: &str| vec![scene.scene.clone(), balls.to_owned(), tracer.to_owned()];
    let measured = match &scene.result {
        Ok(measured) => measured,
        Err(reason) => return vec![head("", reason)],
    };
    let balls = grouped(measured.balls);
    let ratio = measured.times_as_fast().map_or_else(String::new, decimal);
    let mut ours = head(&balls, "fbvh-certified");
    ours.extend(cells(&measured.ours, ratio));
    let peer = match &measured.peer {
        Ok(traced) => {
            let mut row = head(&balls, "POV-Ray blob");
            row.extend(cells(traced, String::new()));
            row
        }
        Err(reason) => head(&balls, &format!("POV-Ray blob: {reason}")),
    };
    vec![ours, peer, oracle(head(&balls, "oracle"), measured)]
}

/// The oracle's row: what the others are held against.
fn oracle(mut row: Vec<String>, measured: &Measured) -> Vec<String> {
    let accuracy = &measured.ours.accuracy;
    row.extend(std::iter::repeat_n(String::new(), 4));
    row.push(grouped(accuracy.oracle_hits));
    row.push(format!("{} of {} rays ambiguous", accuracy.ambiguous, grouped(accuracy.rays)));
    row
}

/// The numbers of a tracer.
fn cells(traced: &Traced, ratio: String) -> [String; 10] {
    let accuracy = &traced.accuracy;
    let dash = || "–".to_owned();
    [
        decimal(traced.prepare_ms.median),
        decimal(traced.trace_ms.median),
        traced.cpu_ms.map_or_else(dash, decimal),
        ratio,
        grouped(traced.hits),
        grouped(accuracy.false_negative),
        grouped(accuracy.false_positive),
        grouped(accuracy.wrong_front),
        accuracy.rel_rms_t.map_or_else(dash, small),
        accuracy.t_error_over_radius.map_or_else(dash, |error| small(error.max)),
    ]
}

#[cfg(test)]
mod tests {
    use super::effect::LitEffect;
    use super::lit::LitPair;
    use super::*;
    use crate::testing::{assert_stands_alone, read_back};

    fn quick() -> Vec<PlannedScene> {
        let extent = Extent::Quick;
        Options { scenes: Vec::new(), extent, size: None, out: PathBuf::new() }.plan()
    }

    /// Ours is right, and so is the peer on scenes as small as these: an independent program finds
    /// the same surface.
    #[test]
    fn a_quick_run_fills_every_row() {
        let Some(peer) = Povray::find().expect("it runs where it is there") else {
            console::note(&format!("skipped: {}", absent()));
            return;
        };
        let measurements = measure(&quick(), Some(&peer));
        for scene in &measurements.scenes {
            let measured = scene.result.as_ref().expect("measured");
            let traced = measured.peer.as_ref().expect("traced");
            assert_eq!(measured.ours.accuracy.wrong_verdicts(), 0, "{scene:?}");
            assert_eq!(traced.accuracy.wrong_verdicts(), 0, "{scene:?}");
            assert!(traced.hits > 100, "{scene:?}");
            // Two channels of 16 bits, the fine one wrapping 4,096 times, encode the depth to 4e-9 of
            // the range; what is left is its own error and an f32's.
            assert!(traced.accuracy.rel_rms_t.expect("hits") < 1e-5, "{scene:?}");
            assert_eq!(traced.trace_ms.samples.len(), 2);
            for pair in &measured.lit {
                assert_lit_alike(pair);
            }
            assert_eq!(measured.lit.len(), LitEffect::ALL.len());
        }
        let back = read_back(&measurements);
        assert_eq!((back.heading.provenance.schema.as_str(), back.scenes.len()), (SCHEMA, 2));
        let page = page::page(&measurements);
        assert_stands_alone(&page, &["skipped", "/tmp"]);
        assert!(page.contains("POV-Ray 3"));
    }

    /// Shadows fall on the same pixels, and mirrors nearly so: POV-Ray's scatter as much light at
    /// grazing angles as head on.
    fn assert_lit_alike(pair: &LitPair) {
        let peer = pair.peer.as_ref().expect("drawn");
        assert!(peer.process_ms.samples.len() == 1 && pair.ours.process_ms.samples.len() == 1);
        let limit = if pair.effect == LitEffect::Shadows.name() { 0.01 } else { 0.5 };
        assert!(pair.differing.is_none_or(|share| share < limit), "{pair:?}");
        let work = peer.work_ms.as_ref().expect("its own clock");
        assert!(work.median < peer.process_ms.median, "{pair:?}");
        let is_occlusion = pair.effect == LitEffect::Occlusion.name();
        for run in [&pair.ours, peer] {
            assert_eq!(run.occlusion_rays > 0, is_occlusion, "{pair:?}");
        }
        for wrong in [pair.ours.wrong, peer.wrong].into_iter().flatten() {
            assert_eq!((wrong.pixels, wrong.lit, wrong.dark), (16 * 12, 0, 0), "{pair:?}");
        }
    }

    /// Without the peer ours and the oracle's rows remain, and it is said what is missing.
    #[test]
    fn an_absent_peer_is_skipped_visibly() {
        let measurements = measure(&quick()[..1], None);
        let Table { columns, rows, .. } = table(&measurements.scenes);
        assert_eq!(rows.len(), 3);
        assert!(rows[0].len() == columns.len() && rows[0][6].is_empty(), "{rows:?}");
        assert!(rows[1][2].contains("not installed") && rows[2][2] == "oracle", "{rows:?}");
        let Table { columns, rows, .. } = lit_table::table(&measurements.scenes);
        assert_eq!(rows.len(), 2 * LitEffect::ALL.len());
        for pair in rows.chunks(2) {
            assert!(pair[0].len() == columns.len() && pair[0][6].is_empty(), "{rows:?}");
            assert!(pair[1][3].contains("not installed"), "{rows:?}");
        }
        let page = page::page(&measurements);
        assert!(page.contains("apt-get install povray") && page.contains("skipped"), "{page}");
    }

    /// What cannot be loaded is a row with a reason.
    #[test]
    fn a_scene_that_fails_is_named() {
        let planned =
            PlannedScene { spec: "nosuch".to_owned(), size: (4, 3), rounds: 1, lit_rounds: 1 };
        let rows = table(&measure(&[planned], None).scenes).rows;
        assert!(rows.len() == 1 && rows[0][2].contains("nosuch"), "{rows:?}");
    }
}
