//! The command `tables peers`: the certified tree on the CPU against what a user would take instead, of the
//! same field, the power kernel's with α = 2: POV-Ray's `blob`, a mesh, and a gather on Embree.

mod array_job;
mod contender;
pub mod effect;
mod embree;
pub mod lamp_truth;
pub mod lit;
mod lit_table;
mod mesh;
mod page;
pub mod povray;
pub mod programs;
pub mod run;

use std::path::PathBuf;

use metaball_core::Kernel;
use serde::{Deserialize, Serialize};

use self::programs::Programs;
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

/// Resolutions of meshes: cells along the longest side of their grids.
const CELLS: [u32; 3] = [64, 128, 256];
const QUICK_CELLS: [u32; 3] = [16, 32, 64];

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
        let (scenes, size, [rounds, lit_rounds], cells): (&[&str], _, _, _) = match self.extent {
            Extent::Quick => (&["scattered:300", "pool:300"], (64, 48), [2, 1], QUICK_CELLS),
            Extent::Whole => (
                &["scattered:10000", "scattered-100k", "pool-10k", "tornado-128k", "molecule"],
                (640, 480),
                [5, 3],
                CELLS,
            ),
        };
        let size = self.size.unwrap_or(size);
        let planned = |spec| PlannedScene { spec, size, rounds, lit_rounds, cells };
        named_or(&self.scenes, scenes).into_iter().map(planned).collect()
    }
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Its format is [`SCHEMA`].
    #[serde(flatten)]
    pub heading: Heading,
    /// Threads of each tracer.
    pub threads: usize,
    /// What POV-Ray calls itself; `null` where it is not installed.
    pub peer: Option<String>,
    /// What all peers call themselves that are installed; none in records older than this.
    #[serde(default)]
    pub versions: Vec<String>,
    /// The scenes, in the order measured.
    pub scenes: Vec<SceneResult<Measured>>,
}

/// Measures, prints the table, and writes `peers.html` and `peers.json`.
///
/// # Errors
/// When a file cannot be written, or nothing could be measured.
pub fn tables(options: &Options) -> anyhow::Result<()> {
    let programs = Programs::find()?;
    programs.absent().iter().for_each(|remark| console::note(remark));
    publish(&options.out, &options.scenes, || Ok(measure(&options.plan(), &programs)))
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

fn measure(plan: &[PlannedScene], programs: &Programs) -> Measurements {
    let progress = ProgressBar::new(plan.iter().map(PlannedScene::steps).sum());
    let measured = |planned: &PlannedScene| {
        let result = run::measure(planned, programs, &progress);
        SceneResult::new(&planned.spec, planned.size, result)
    };
    let scenes: Vec<_> = plan.iter().map(measured).collect();
    drop(progress);

    let mut remarks = programs.absent();
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
        peer: programs.povray.as_ref().map(|povray| povray.version().to_owned()),
        versions: programs.versions(),
        scenes,
    }
}

fn replaced_kernel(scene: &SceneResult<Measured>) -> Option<&str> {
    let measured = scene.result.as_ref().ok()?;
    (measured.kernel != Kernel::QUARTIC.to_string()).then_some(scene.scene.as_str())
}

/// A row for each tracer of a scene, and what the oracle says; or one with a reason.
fn table(scenes: &[SceneResult<Measured>]) -> Table {
    let columns = [
        Column::text("scene"),
        Column::number("balls"),
        Column::text("tracer"),
        Column::number("prepare").of("ms"),
        Column::number("trace").of("ms"),
        Column::number("picture").of("ms"),
        Column::number("CPU").of("ms"),
        Column::number("trace").of("over ours"),
        Column::number("picture").of("over ours"),
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
    let row = |name: &str, traced: &Traced, over_ours: [String; 2]| {
        let mut row = head(&balls, name);
        row.extend(cells(traced, over_ours));
        row
    };
    let ours = &measured.ours;
    let mut rows = vec![row("fbvh-certified", ours, Default::default())];
    rows.extend(measured.peers().map(|(name, peer)| match peer {
        Ok(traced) => row(name, traced, over(traced, ours)),
        Err(reason) => head(&balls, &format!("{name}: {reason}")),
    }));
    rows.push(oracle(head(&balls, "oracle"), measured));
    rows
}

/// A peer's times over ours: for tracing, and from the arrays to the picture.
fn over(peer: &Traced, ours: &Traced) -> [String; 2] {
    let trace = peer.trace_ms.median / ours.trace_ms.median;
    [trace, peer.picture_ms() / ours.picture_ms()].map(decimal)
}

/// The oracle's row: what the others are held against.
fn oracle(mut row: Vec<String>, measured: &Measured) -> Vec<String> {
    let accuracy = &measured.ours.accuracy;
    row.extend(std::iter::repeat_n(String::new(), 6));
    row.push(grouped(accuracy.oracle_hits));
    row.push(format!("{} of {} rays ambiguous", accuracy.ambiguous, grouped(accuracy.rays)));
    row
}

/// The numbers of a tracer.
fn cells(traced: &Traced, [trace, picture]: [String; 2]) -> [String; 12] {
    let accuracy = &traced.accuracy;
    let dash = || "–".to_owned();
    [
        decimal(traced.prepare_ms.median),
        decimal(traced.trace_ms.median),
        decimal(traced.picture_ms()),
        traced.cpu_ms.map_or_else(dash, decimal),
        trace,
        picture,
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

    /// Ours is right, and so is POV-Ray on scenes as small as these: an independent program finds the
    /// same surface.
    #[test]
    fn a_quick_run_fills_every_row() {
        let programs = Programs::find().expect("they run where they are there");
        programs.absent().iter().for_each(|remark| console::note(&format!("skipped: {remark}")));
        let measurements = measure(&quick(), &programs);
        for scene in &measurements.scenes {
            let measured = scene.result.as_ref().expect("measured");
            assert_eq!(measured.ours.accuracy.wrong_verdicts(), 0, "{scene:?}");
            if programs.povray.is_some() {
                assert_povray(measured);
            }
            let others: Vec<_> = measured.others.iter().map(|peer| &peer.result).collect();
            if programs.mesh.is_some() {
                assert_meshes(&others[..3]);
            }
            if programs.embree.is_some() {
                assert_gathers(&others[3..]);
            }
            assert_eq!(others.len(), 5);
        }
        let back = read_back(&measurements);
        assert_eq!((back.heading.provenance.schema.as_str(), back.scenes.len()), (SCHEMA, 2));
        let page = page::page(&measurements);
        assert_stands_alone(&page, &["/tmp"]);
        assert_eq!(page.contains("such rows are skipped"), !programs.absent().is_empty());
        assert!(programs.versions().iter().all(|version| page.contains(version)), "{page}");
    }

    fn assert_povray(measured: &Measured) {
        let traced = measured.peer.as_ref().expect("traced");
        assert_eq!(traced.accuracy.wrong_verdicts(), 0, "{traced:?}");
        assert!(traced.hits > 100, "{traced:?}");
        // Two channels of 16 bits, the fine one wrapping 4,096 times, encode the depth to 4e-9 of
        // the range; what is left is its own error and an f32's.
        assert!(traced.accuracy.rel_rms_t.expect("hits") < 1e-5, "{traced:?}");
        assert_eq!(traced.trace_ms.samples.len(), 2);
        for pair in &measured.lit {
            assert_lit_alike(pair);
        }
        assert_eq!(measured.lit.len(), LitEffect::ALL.len());
    }

    /// A finer mesh is nearer to the surface, and the finest is still told from it.
    fn assert_meshes(meshes: &[&Result<Traced, String>]) {
        let error = |mesh: &&Result<Traced, String>| {
            let traced = mesh.as_ref().expect("traced");
            assert!(traced.hits > 100, "{traced:?}");
            traced.accuracy.rel_rms_t.expect("hits")
        };
        let errors: Vec<_> = meshes.iter().map(error).collect();
        assert!(errors[0] > 1.5 * errors[1] && errors[1] > 1.5 * errors[2], "{errors:?}");
        assert!(errors[2] > 1e-5, "{errors:?}");
    }

    /// Embree gathers the same balls, and the same search along them finds the same roots.
    fn assert_gathers(gathers: &[&Result<Traced, String>]) {
        for gather in gathers {
            let traced = gather.as_ref().expect("traced");
            assert_eq!(traced.accuracy.wrong_verdicts(), 0, "{traced:?}");
            assert!(traced.accuracy.rel_rms_t.expect("hits") < 1e-6, "{traced:?}");
            assert!(traced.accuracy.normal_degrees.is_some(), "{traced:?}");
        }
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

    /// Without peers ours and the oracle's rows remain, and it is said what is missing.
    #[test]
    fn absent_peers_are_skipped_visibly() {
        let measurements = measure(&quick()[..1], &Programs::default());
        let Table { columns, rows, .. } = table(&measurements.scenes);
        assert_eq!(rows.len(), 8);
        assert!(rows[0].len() == columns.len() && rows[0][7].is_empty(), "{rows:?}");
        assert!(rows[1..7].iter().all(|row| row[2].ends_with(": not installed")), "{rows:?}");
        assert_eq!(rows[7][2], "oracle");
        let Table { columns, rows, .. } = lit_table::table(&measurements.scenes);
        assert_eq!(rows.len(), 2 * LitEffect::ALL.len());
        for pair in rows.chunks(2) {
            assert!(pair[0].len() == columns.len() && pair[0][6].is_empty(), "{rows:?}");
            assert!(pair[1][3].contains("not installed"), "{rows:?}");
        }
        let page = page::page(&measurements);
        for command in ["apt-get install povray", "pip install numpy==", "libembree-dev"] {
            assert!(page.contains(command), "{page}");
        }
        assert!(page.contains("such rows are skipped"), "{page}");
    }

    /// What cannot be loaded is a row with a reason.
    #[test]
    fn a_scene_that_fails_is_named() {
        let planned = PlannedScene { spec: "nosuch".to_owned(), ..quick()[0].clone() };
        let rows = table(&measure(&[planned], &Programs::default()).scenes).rows;
        assert!(rows.len() == 1 && rows[0][2].contains("nosuch"), "{rows:?}");
    }
}
