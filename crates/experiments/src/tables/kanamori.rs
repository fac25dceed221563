//! The command `tables kanamori`: table 1 of Kanamori et al. 2008, what each optimisation of section 5
//! brings, time against error, figure 8's split, and the scenes of section 6.

mod page;
pub mod paper;
pub mod plan;
pub mod run;
pub mod settings;

use std::time::{Duration, Instant};

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use self::plan::{Bout, Part};
use self::run::{GpuRun, Measured, Outcome, Run};
use crate::console::{self, ProgressBar};
use crate::tables::{Extent, Order};
use harness::machine::Provenance;
use harness::numbers::{decimal, small};
use harness::output::write_json;
use harness::record::Adapter;
use picture_files::write_atomically;

/// Name and version of the format of `kanamori.json`.
pub const SCHEMA: &str = "metaball-tables-kanamori/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Where it comes from; its format is [`SCHEMA`].
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What drew.
    pub adapter: Adapter,
    /// What a reader should know.
    pub remarks: Vec<String>,
    /// All bouts, in the order measured.
    pub bouts: Vec<Outcome>,
}

/// Measures, prints the tables, and writes `kanamori.html` and `kanamori.json`. What does not fit into
/// `time` is named.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(order: &Order, time: Option<Duration>) -> anyhow::Result<()> {
    let gpu = Gpu::new(&order.adapter)?;
    console::note(&gpu.report().to_string());
    let measurements = measure(&gpu, order, time.unwrap_or(Duration::MAX));
    for part in Part::ALL {
        console::line(&format!("\n{}", part.title()));
        console::line(&console::table(&HEADINGS, &rows(part, &measurements.bouts)));
    }
    let page = order.out.join("kanamori.html");
    write_json(&order.out.join("kanamori.json"), &measurements)?;
    write_atomically(&page, page::page(&measurements).as_bytes())?;
    console::line(&format!("\n{}", page.display()));
    let measured = measurements.bouts.iter().any(|bout| bout.result.is_ok());
    anyhow::ensure!(measured, "nothing could be measured; see the page");
    Ok(())
}

fn measure(gpu: &Gpu, order: &Order, room: Duration) -> Measurements {
    let bouts = plan::bouts(order.extent, order.size);
    let mut remarks = Vec::new();
    if order.extent == Extent::Quick {
        remarks.push("Quick: small scenes and pictures in the place of the paper's.".to_owned());
    }
    if gpu.report().is_software() {
        remarks.push(
            "Both sides were computed on the CPU: the ratios of GPU to CPU times say nothing of a \
             GPU."
                .to_owned(),
        );
    }
    let steps = |bout: &Bout| bout.settings.len() as u64 * run::STEPS;
    let progress = ProgressBar::new(bouts.iter().map(steps).sum());
    let mut clock = Clock { begun: Instant::now(), room, pace: None };
    let mut done = 0;
    let mut outcomes = Vec::new();
    for bout in bouts {
        let result = match clock.refusal(&bout) {
            Some(refusal) => Err(refusal),
            None => clock.time(&bout, || run::measure(gpu, &bout, &progress)),
        };
        done += steps(&bout);
        progress.reach(done);
        outcomes.push(Outcome {
            part: bout.part,
            scene: bout.spec,
            size: bout.size,
            paper_gpu_ms: bout.paper_ms.map(|(gpu, _)| gpu),
            paper_cpu_ms: bout.paper_ms.and_then(|(_, cpu)| cpu),
            result,
        });
    }
    drop(progress);
    Measurements {
        provenance: Provenance::here(SCHEMA),
        adapter: Adapter::from(gpu.report()),
        remarks,
        bouts: outcomes,
    }
}

/// How long bouts take, and how long they may.
struct Clock {
    begun: Instant,
    room: Duration,
    /// Seconds for each variant and pixel of the last bout.
    pace: Option<f64>,
}

impl Clock {
    /// Why a bout is not begun, if it is not: at the pace of the last one it would not end in time.
    fn refusal(&self, bout: &Bout) -> Option<String> {
        let left = self.room.saturating_sub(self.begun.elapsed());
        let takes = self.pace.map_or(0.0, |pace| pace * work_of(bout));
        (left.is_zero() || takes > left.as_secs_f64()).then(|| {
            format!(
                "not run: would take about {takes:.0} s of the {} s that are left; use --full",
                left.as_secs()
            )
        })
    }

    fn time(
        &mut self,
        bout: &Bout,
        measure: impl FnOnce() -> anyhow::Result<Measured>,
    ) -> Result<Measured, String> {
        let start = Instant::now();
        let result = measure();
        self.pace = Some(start.elapsed().as_secs_f64() / work_of(bout));
        result.map_err(|error| format!("{error:#}"))
    }
}

/// Variants times pixels.
fn work_of(bout: &Bout) -> f64 {
    let (width, height) = bout.size;
    bout.settings.len() as f64 * f64::from(width) * f64::from(height)
}

/// Columns of every table; those of the first group name a row.
const HEADINGS: [&str; 15] = [
    "scene",
    "balls",
    "picture",
    "setting",
    "frame ms",
    "paper ms",
    "× first",
    "CPU ms",
    "paper ms",
    "GPU gain",
    "paper",
    "culled %",
    "layers",
    "iterations",
    "error of t",
];

/// The rows of a part, a variant each.
fn rows(part: Part, bouts: &[Outcome]) -> Vec<Vec<String>> {
    bouts.iter().filter(|bout| bout.part == part).flat_map(rows_of).collect()
}

fn rows_of(bout: &Outcome) -> Vec<Vec<String>> {
    let (width, height) = bout.size;
    let head = |balls: String| vec![bout.scene.clone(), balls, format!("{width}×{height}")];
    let measured = match &bout.result {
        Ok(measured) => measured,
        Err(reason) => {
            let mut row = head(String::new());
            row.push(reason.clone());
            return vec![row];
        }
    };
    let first = measured.runs.first().and_then(|run| run.result.as_ref().ok());
    let row = |(index, run): (usize, &Run)| {
        let mut row = head(measured.balls.to_string());
        row.push(run.setting.clone());
        match &run.result {
            Ok(gpu) => {
                row.extend(cells(bout, measured, gpu, first.filter(|_| index > 0), index == 0));
            }
            Err(reason) => row.push(reason.clone()),
        }
        row
    };
    measured.runs.iter().enumerate().map(row).collect()
}

/// What stands beside the name of a variant. The paper's numbers and the CPU's are the first one's.
fn cells(
    bout: &Outcome,
    measured: &Measured,
    gpu: &GpuRun,
    first: Option<&GpuRun>,
    is_first: bool,
) -> [String; 11] {
    let frame = gpu.frame_ms.median;
    let cpu = measured.cpu.frame_ms.median;
    let if_first =
        |value: Option<f64>| value.filter(|_| is_first).map_or_else(String::new, decimal);
    let paper_gain = bout.paper_cpu_ms.zip(bout.paper_gpu_ms).map(|(cpu, gpu)| cpu / gpu);
    [
        decimal(frame),
        if_first(bout.paper_gpu_ms),
        first.map_or_else(String::new, |first| decimal(frame / first.frame_ms.median)),
        if_first(Some(cpu)),
        if_first(bout.paper_cpu_ms),
        if_first(Some(cpu / frame)),
        if_first(paper_gain),
        gpu.facts.get("culled").map_or_else(String::new, |culled| decimal(100.0 * culled)),
        mean_and_most(gpu.layers.1, gpu.layers.0),
        mean_and_most(gpu.iterations.0, gpu.iterations.1),
        gpu.rel_rms_t.map_or_else(|| "–".to_owned(), small),
    ]
}

/// A counter of rays: the mean, and the most in brackets. A method that does without has none: the search
/// of tiles' lists peels no layers and clips nothing.
fn mean_and_most(mean: f64, most: u32) -> String {
    if most == 0 { "–".to_owned() } else { format!("{} ({most})", decimal(mean)) }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use metaball_core::gpu::AdapterChoice;

    use super::*;
    use crate::tables::TEN_MINUTES;

    /// Everything is measured, the published variant errs no more than the paper's, and the page
    /// stands alone.
    #[test]
    fn a_quick_run_fills_every_row() {
        let Some(gpu) = Gpu::for_test() else { return };
        let (extent, adapter) = (Extent::Quick, AdapterChoice::Environment);
        let order = Order { extent, size: None, adapter, out: PathBuf::new() };
        let measurements = measure(&gpu, &order, Duration::MAX);
        for part in Part::ALL {
            let mut bouts = measurements.bouts.iter().filter(|bout| bout.part == part);
            let first = bouts.next().expect("each part has a bout");
            assert!(first.result.is_ok(), "{first:?}");
            for row in rows(part, &measurements.bouts) {
                assert_eq!(row.len(), HEADINGS.len(), "{row:?}");
            }
        }
        let published = measurements.bouts.iter().filter_map(|bout| bout.result.as_ref().ok());
        for measured in published.filter(|measured| measured.runs[0].setting == "published") {
            let run = measured.runs[0].result.as_ref().expect("measured");
            assert!(run.rel_rms_t.expect("hits") <= paper::ERROR_OF_T, "{run:?}");
        }

        let text = serde_json::to_string(&measurements).expect("JSON");
        let back: Measurements = serde_json::from_str(&text).expect("as written");
        assert_eq!(
            (back.provenance.schema.as_str(), back.bouts.len()),
            (SCHEMA, measurements.bouts.len())
        );
        let page = page::page(&measurements);
        for forbidden in ["<script", "http", "url(", "not run", "{{"] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        assert!(page.contains("Figure 8") && page.ends_with("</html>\n"));
    }

    #[test]
    fn what_a_method_does_without_is_a_dash() {
        assert_eq!(mean_and_most(2.5, 7), "2.50 (7)");
        assert_eq!(mean_and_most(1.25, 0), "–");
    }

    /// What does not fit says so, in its row and on the page.
    #[test]
    fn what_is_left_out_is_named() {
        let bout = plan::bouts(Extent::Whole, None).pop().expect("there are bouts");
        let clock = |room, pace| Clock { begun: Instant::now(), room, pace };
        assert_eq!(clock(Duration::MAX, Some(1.0)).refusal(&bout), None);
        assert_eq!(clock(TEN_MINUTES, None).refusal(&bout), None);
        let pace = Some(700.0 / work_of(&bout));
        let refusal = clock(TEN_MINUTES, pace).refusal(&bout).expect("too long");
        assert!(refusal.starts_with("not run: would take about 700 s of the 599 s"), "{refusal}");
        assert!(clock(Duration::ZERO, None).refusal(&bout).is_some());

        let outcome = Outcome {
            part: Part::Scenes,
            scene: "far".to_owned(),
            size: (4, 3),
            paper_gpu_ms: None,
            paper_cpu_ms: None,
            result: Err(refusal.clone()),
        };
        assert_eq!(rows(Part::Scenes, &[outcome]), [["far", "", "4×3", refusal.as_str()]]);
    }
}
