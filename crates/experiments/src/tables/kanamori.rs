//! The command `tables kanamori`: table 1 of Kanamori et al. 2008, what each optimisation of section 5
//! brings, time against error, figure 8's split, and the scenes of section 6.

mod page;
pub mod paper;
pub mod plan;
pub mod run;
pub mod variant;

use std::time::{Duration, Instant};

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use self::plan::{Part, PlannedScene};
use self::run::{GpuRun, Measured, PartResult, VariantResult};
use crate::console::{ProgressBar, open_adapter};
use crate::extent::Extent;
use crate::table::{Column, Table};
use crate::tables::Options;
use crate::tables::heading::Heading;
use crate::tables::report::{Report, publish};
use crate::tables::scene_result::SceneResult;
use harness::numbers::{decimal, small};

/// Name and version of the format of `kanamori.json`.
pub const SCHEMA: &str = "metaball-tables-kanamori/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Its format is [`SCHEMA`].
    #[serde(flatten)]
    pub heading: Heading,
    /// All scenes, in the order measured.
    #[serde(alias = "bouts")]
    pub scenes: Vec<PartResult>,
}

/// Measures, prints the tables, and writes `kanamori.html` and `kanamori.json`. What does not fit into
/// `time` is named.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(options: &Options, time: Option<Duration>) -> anyhow::Result<()> {
    let gpu = open_adapter(&options.adapter)?;
    publish(&options.out, &[], || Ok(measure(&gpu, options, time.unwrap_or(Duration::MAX))))
}

impl Report for Measurements {
    const NAME: &'static str = "kanamori";

    fn text(&self) -> String {
        let part = |&part: &Part| {
            let table = table(part, &self.scenes);
            format!("\n{}\n{}", table.title, table.text())
        };
        Part::ALL.iter().map(part).collect::<Vec<_>>().join("\n")
    }

    fn page(&self) -> String {
        page::page(self)
    }

    fn is_empty(&self) -> bool {
        self.scenes.iter().all(|scene| scene.measured.result.is_err())
    }
}

fn measure(gpu: &Gpu, options: &Options, time: Duration) -> Measurements {
    let plan = plan::plan(options.extent, options.size);
    let mut remarks = Vec::new();
    if options.extent == Extent::Quick {
        remarks.push("Quick: small scenes and pictures instead of the paper's.".to_owned());
    }
    if gpu.report().is_software() {
        remarks.push(
            "Both sides were computed on the CPU: the ratios of GPU to CPU times say nothing of a \
             GPU."
                .to_owned(),
        );
    }
    let steps = |planned: &PlannedScene| planned.variants.len() as u64 * run::STEPS;
    let progress = ProgressBar::new(plan.iter().map(steps).sum());
    let mut clock = Clock { begun: Instant::now(), time, pace: None };
    let mut done = 0;
    let mut scenes = Vec::new();
    for planned in plan {
        let result = match clock.refusal(&planned) {
            Some(refusal) => Err(anyhow::Error::msg(refusal)),
            None => clock.measure(&planned, || run::measure(gpu, &planned, &progress)),
        };
        done += steps(&planned);
        progress.reach(done);
        scenes.push(PartResult {
            part: planned.part,
            measured: SceneResult::new(&planned.spec, planned.size, result),
            paper_gpu_ms: planned.paper_ms.map(|(gpu, _)| gpu),
            paper_cpu_ms: planned.paper_ms.and_then(|(_, cpu)| cpu),
        });
    }
    drop(progress);
    Measurements { heading: Heading::new(SCHEMA, Some(gpu), remarks), scenes }
}

/// How long scenes take, and how long they may.
struct Clock {
    begun: Instant,
    time: Duration,
    /// Seconds for each variant and pixel of the last scene.
    pace: Option<f64>,
}

impl Clock {
    /// Why a scene is not begun, if it is not: at the pace of the last one it would not end in time.
    fn refusal(&self, planned: &PlannedScene) -> Option<String> {
        let left = self.time.saturating_sub(self.begun.elapsed());
        let takes = self.pace.map_or(0.0, |pace| pace * work_of(planned));
        (left.is_zero() || takes > left.as_secs_f64()).then(|| {
            format!(
                "not run: would take about {takes:.0} s of the {} s that are left; use --full",
                left.as_secs()
            )
        })
    }

    fn measure(
        &mut self,
        planned: &PlannedScene,
        measure: impl FnOnce() -> anyhow::Result<Measured>,
    ) -> anyhow::Result<Measured> {
        let start = Instant::now();
        let result = measure();
        self.pace = Some(start.elapsed().as_secs_f64() / work_of(planned));
        result
    }
}

/// Variants times pixels.
fn work_of(planned: &PlannedScene) -> f64 {
    let (width, height) = planned.size;
    planned.variants.len() as f64 * f64::from(width) * f64::from(height)
}

/// The table of a part, a row for each variant.
fn table(part: Part, scenes: &[PartResult]) -> Table {
    let columns = [
        Column::text("scene"),
        Column::number("balls"),
        Column::number("picture"),
        Column::text("variant"),
        Column::number("frame").of("ms"),
        Column::number("paper").of("ms"),
        Column::number("× first"),
        Column::number("CPU").of("ms"),
        Column::number("paper").of("ms"),
        Column::number("GPU gain"),
        Column::number("paper"),
        Column::number("culled").of("%"),
        Column::number("layers"),
        Column::number("iterations"),
        Column::number("error of t"),
    ];
    let rows = scenes.iter().filter(|scene| scene.part == part).flat_map(rows_of).collect();
    Table { title: part.title().to_owned(), columns: columns.into(), rows }
}

fn rows_of(scene: &PartResult) -> Vec<Vec<String>> {
    let SceneResult { scene: name, size: (width, height), result } = &scene.measured;
    let head = |balls: String| vec![name.clone(), balls, format!("{width}×{height}")];
    let measured = match result {
        Ok(measured) => measured,
        Err(reason) => {
            let mut row = head(String::new());
            row.push(reason.clone());
            return vec![row];
        }
    };
    let first = measured.runs.first().and_then(|run| run.result.as_ref().ok());
    let row = |(index, run): (usize, &VariantResult)| {
        let mut row = head(measured.balls.to_string());
        row.push(run.variant.clone());
        match &run.result {
            Ok(gpu) => {
                row.extend(cells(scene, measured, gpu, first.filter(|_| index > 0), index == 0));
            }
            Err(reason) => row.push(reason.clone()),
        }
        row
    };
    measured.runs.iter().enumerate().map(row).collect()
}

/// The numbers of a variant. The paper's numbers and the CPU's are the first one's.
fn cells(
    scene: &PartResult,
    measured: &Measured,
    gpu: &GpuRun,
    first: Option<&GpuRun>,
    is_first: bool,
) -> [String; 11] {
    let frame = gpu.frame_ms.median;
    let cpu = measured.cpu.frame_ms.median;
    let if_first =
        |value: Option<f64>| value.filter(|_| is_first).map_or_else(String::new, decimal);
    let paper_gain = scene.paper_cpu_ms.zip(scene.paper_gpu_ms).map(|(cpu, gpu)| cpu / gpu);
    [
        decimal(frame),
        if_first(scene.paper_gpu_ms),
        first.map_or_else(String::new, |first| decimal(frame / first.frame_ms.median)),
        if_first(Some(cpu)),
        if_first(scene.paper_cpu_ms),
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
    use crate::testing::{assert_stands_alone, read_back};

    /// Everything is measured, the published variant errs no more than the paper's, and the page
    /// needs nothing else.
    #[test]
    fn a_quick_run_fills_every_row() {
        let Some(gpu) = Gpu::for_test() else { return };
        let (extent, adapter) = (Extent::Quick, AdapterChoice::Environment);
        let options = Options { extent, size: None, adapter, out: PathBuf::new() };
        let measurements = measure(&gpu, &options, Duration::MAX);
        for part in Part::ALL {
            let mut scenes = measurements.scenes.iter().filter(|scene| scene.part == part);
            let first = scenes.next().expect("each part has a scene");
            assert!(first.measured.result.is_ok(), "{first:?}");
            let Table { columns, rows, .. } = table(part, &measurements.scenes);
            for row in rows {
                assert_eq!(row.len(), columns.len(), "{row:?}");
            }
        }
        let published =
            measurements.scenes.iter().filter_map(|scene| scene.measured.result.as_ref().ok());
        for measured in published.filter(|measured| measured.runs[0].variant == "published") {
            let run = measured.runs[0].result.as_ref().expect("measured");
            assert!(run.rel_rms_t.expect("hits") <= paper::ERROR_OF_T, "{run:?}");
        }

        let back = read_back(&measurements);
        assert_eq!(
            (back.heading.provenance.schema.as_str(), back.scenes.len()),
            (SCHEMA, measurements.scenes.len())
        );
        let page = page::page(&measurements);
        assert_stands_alone(&page, &["not run"]);
        assert!(page.contains("Figure 8"));
    }

    #[test]
    fn what_a_method_does_without_is_a_dash() {
        assert_eq!(mean_and_most(2.5, 7), "2.50 (7)");
        assert_eq!(mean_and_most(1.25, 0), "–");
    }

    /// What does not fit is named in its row and on the page.
    #[test]
    fn what_is_left_out_is_named() {
        let planned = plan::plan(Extent::Whole, None).pop().expect("there are scenes");
        let clock = |time, pace| Clock { begun: Instant::now(), time, pace };
        assert_eq!(clock(Duration::MAX, Some(1.0)).refusal(&planned), None);
        assert_eq!(clock(TEN_MINUTES, None).refusal(&planned), None);
        let pace = Some(700.0 / work_of(&planned));
        let refusal = clock(TEN_MINUTES, pace).refusal(&planned).expect("too long");
        assert!(refusal.starts_with("not run: would take about 700 s of the 599 s"), "{refusal}");
        assert!(clock(Duration::ZERO, None).refusal(&planned).is_some());

        let result = Err(anyhow::Error::msg(refusal.clone()));
        let scene = PartResult {
            part: Part::Scenes,
            measured: SceneResult::new("far", (4, 3), result),
            paper_gpu_ms: None,
            paper_cpu_ms: None,
        };
        assert_eq!(table(Part::Scenes, &[scene]).rows, [["far", "", "4×3", refusal.as_str()]]);
    }
}
