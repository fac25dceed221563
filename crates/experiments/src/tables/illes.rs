//! The command `tables illes`: table 1 of Illés and Szécsi, how its phases grow, the lists behind it,
//! figure 7, the cubic's own error, and memory.

pub mod growth;
pub mod kernels;
mod page;
pub mod paper;
pub mod run;
mod tables;

use std::time::{Duration, Instant};

use bench_scenes::{BenchScene, Overrides, load};
use metaball_core::Kernel;
use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use self::growth::{Growth, growth};
use self::kernels::{KernelRow, kernels};
use self::paper::{FIGURE_7, Printed, TABLE};
use self::run::{ListRun, Phases, VARIANTS};
use self::tables::Annotated;
use crate::console::{self, open_adapter};
use crate::extent::Extent;
use crate::page::cpu_remark;
use crate::tables::Options;
use crate::tables::heading::Heading;
use crate::tables::report::{Report, publish};
use harness::numbers::{decimal, grouped};

/// Name and version of the format of `illes.json`.
pub const SCHEMA: &str = "metaball-tables-illes/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Its format is [`SCHEMA`].
    #[serde(flatten)]
    pub heading: Heading,
    /// Pixels across and down of table 1.
    pub size: (u32, u32),
    /// Table 1.
    pub table: Vec<Row>,
    /// Exponents over the number of particles.
    pub growth: Vec<Growth>,
    /// Figure 7: the mud from nearer and nearer.
    pub views: Vec<Row>,
    /// Errors by kernel, and what was drawn for them.
    pub kernels: Vec<KernelRow>,
    /// Scene of the kernels, and pixels across and down.
    pub kernel_scene: (String, (u32, u32)),
    /// 200,000 particles at 640 × 480, to be held against [`SMALL_ADAPTER`].
    pub memory: Vec<Row>,
}

/// Bytes of an adapter on which 200,000 particles at 640 × 480 have to fit: 2 GiB.
pub const SMALL_ADAPTER: u64 = 2 << 30;

/// A variant on a scene, with what the paper prints of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The scene, as it was named.
    pub scene: String,
    /// The variant.
    #[serde(rename = "setting")]
    pub variant: String,
    /// The paper's milliseconds, where printed.
    pub paper: Option<Phases>,
    /// The paper's frames a second, where printed.
    pub paper_fps: Option<f64>,
    /// Ours.
    pub run: Option<ListRun>,
    /// Why there is no run, or why its phases weigh otherwise than the paper's.
    pub why: Option<String>,
}

/// The numbers of an extent.
struct Plan {
    particles: Vec<usize>,
    size: (u32, u32),
    frames: usize,
    kernels: Vec<Kernel>,
    kernel_scene: String,
    kernel_size: (u32, u32),
    mud: usize,
    view_size: (u32, u32),
}

impl Plan {
    fn new(options: &Options) -> Self {
        let of_paper = || TABLE.iter().map(|row| row.particles).collect();
        match options.extent {
            Extent::Quick => Self {
                particles: vec![200, 800],
                size: options.size.unwrap_or((64, 48)),
                frames: 2,
                kernels: vec![Kernel::Wyvill, Kernel::Perlin, Kernel::QUARTIC],
                kernel_scene: "mud:60".to_owned(),
                kernel_size: (24, 18),
                mud: 800,
                view_size: (40, 30),
            },
            Extent::Whole => Self {
                particles: of_paper(),
                size: options.size.unwrap_or((1024, 768)),
                frames: 3,
                kernels: kernels(),
                kernel_scene: "mud:5000".to_owned(),
                kernel_size: (160, 120),
                mud: 200_000,
                view_size: (640, 480),
            },
        }
    }
}

/// Measures, prints the tables, and writes `illes.html` and `illes.json`. Rows of table 1 that do not fit
/// into `time` are named.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(options: &Options, time: Option<Duration>) -> anyhow::Result<()> {
    let gpu = open_adapter(&options.adapter)?;
    publish(&options.out, &[], || measure(&gpu, &Plan::new(options), time))
}

impl Report for Measurements {
    const NAME: &'static str = "illes";

    fn text(&self) -> String {
        let text = |Annotated { table, notes }: &Annotated| {
            let notes: String = notes.iter().map(|note| format!("\n  {note}")).collect();
            format!("\n{}\n{}{notes}", table.title, table.text())
        };
        tables::tables(self).iter().map(text).collect::<Vec<_>>().join("\n")
    }

    fn page(&self) -> String {
        page::page(self)
    }

    fn is_empty(&self) -> bool {
        self.table.iter().all(|row| row.run.is_none())
    }
}

fn measure(gpu: &Gpu, plan: &Plan, time: Option<Duration>) -> anyhow::Result<Measurements> {
    let software = gpu.report().is_software();
    let mut measurer =
        Measurer { gpu, software, time, begun: Instant::now(), spent: Spent::default() };

    let mut rows = Vec::new();
    for &kernel in &plan.kernels {
        console::note(&format!("kernel {kernel}: cubic and exact polynomial"));
        rows.push(kernels::compare(gpu, &plan.kernel_scene, kernel, plan.kernel_size)?);
    }
    let mud = format!("mud:{}", plan.mud);
    let scene = load(&mud, &Overrides::default())?;
    let mut views = Vec::new();
    for (camera, fps) in scene.path.iter().zip(FIGURE_7) {
        let scene = BenchScene { camera: *camera, ..scene.clone() };
        views.extend(
            measurer.rows(&mud, plan.view_size, plan.frames, None, Some(fps), |_| Ok(scene)),
        );
    }
    // The first of the views has the size and the number of particles of the memory's table.
    let memory = views.iter().take(VARIANTS.len()).cloned().collect();

    let mut table = Vec::new();
    for &particles in &plan.particles {
        let spec = format!("mud:{particles}");
        let printed = TABLE.iter().find(|row| row.particles == particles);
        let printed = printed.map(|&Printed { phases, .. }| phases);
        let load = |spec: &str| Ok(load(spec, &Overrides::default())?);
        table.extend(measurer.rows(&spec, plan.size, plan.frames, printed, None, load));
    }

    let runs: Vec<_> = table.iter().filter_map(|row| row.run.clone()).collect();
    Ok(Measurements {
        heading: Heading::new(SCHEMA, Some(gpu), cpu_remark(Some(gpu)).into_iter().collect()),
        size: plan.size,
        growth: growth(&VARIANTS.map(|(name, ..)| name), &runs),
        table,
        views,
        kernels: rows,
        kernel_scene: (plan.kernel_scene.clone(), plan.kernel_size),
        memory,
    })
}

/// What rows are measured with, and what they have taken.
struct Measurer<'a> {
    gpu: &'a Gpu,
    software: bool,
    /// For everything; `None`: no limit.
    time: Option<Duration>,
    begun: Instant,
    spent: Spent,
}

/// The last rows that were measured.
#[derive(Default)]
struct Spent {
    particles: usize,
    pixels: u32,
    time: Duration,
}

impl Spent {
    /// What rows of so many particles and pixels may take: some of it goes with the pixels, some with
    /// the particles, so the larger ratio bounds it. `None` before anything is known.
    fn estimate(&self, particles: usize, pixels: u32) -> Option<Duration> {
        let ratio = |now: f64, then: f64| now / then.max(1.0);
        (self.particles > 0).then(|| {
            let grown = ratio(particles as f64, self.particles as f64)
                .max(ratio(pixels.into(), self.pixels.into()));
            self.time.mul_f64(grown)
        })
    }
}

impl Measurer<'_> {
    /// The rows of a scene, one for each variant. They are not measured where they would take longer
    /// than there is time.
    fn rows(
        &mut self,
        spec: &str,
        size: (u32, u32),
        frames: usize,
        paper: Option<Phases>,
        paper_fps: Option<f64>,
        load: impl FnOnce(&str) -> anyhow::Result<BenchScene>,
    ) -> Vec<Row> {
        let row = |variant: &str, outcome: anyhow::Result<ListRun>| {
            let (run, why) = match outcome {
                Ok(run) => {
                    let why = paper.map(|paper| explain(&run, &paper, self.software));
                    (Some(run), why)
                }
                Err(error) => (None, Some(format!("{error:#}"))),
            };
            let (scene, variant) = (spec.to_owned(), variant.to_owned());
            Row { scene, variant, paper, paper_fps, run, why }
        };
        let particles = spec.rsplit(':').next().and_then(|count| count.parse().ok()).unwrap_or(0);
        let pixels = size.0 * size.1;
        let estimate = self.spent.estimate(particles, pixels);
        let left = self.time.map(|time| time.saturating_sub(self.begun.elapsed()));
        if let (Some(estimate), Some(left)) = (estimate, left)
            && estimate > left
        {
            let reason = format!(
                "Not run: it may take {} s, and {} s are left of ten minutes; --full runs it.",
                decimal(estimate.as_secs_f64()),
                decimal(left.as_secs_f64())
            );
            console::note(&format!("{spec}: {reason}"));
            return VARIANTS.map(|(name, ..)| row(name, Err(anyhow::anyhow!("{reason}")))).to_vec();
        }
        let start = Instant::now();
        let about = estimate.map_or_else(String::new, |estimate| {
            format!(", about {} s in all", decimal(estimate.as_secs_f64()))
        });
        let stage = |what: &str| {
            let passed = self.begun.elapsed().as_secs();
            console::note(&format!("{passed} s: {spec} at {} × {}: {what}{about}", size.0, size.1));
        };
        stage("loading");
        let measured =
            load(spec).and_then(|scene| run::measure(self.gpu, &scene, size, frames, stage));
        let rows = match measured {
            Ok(runs) => VARIANTS.iter().zip(runs).map(|((name, ..), run)| row(name, run)).collect(),
            Err(error) => {
                let reason = format!("{error:#}");
                VARIANTS.map(|(name, ..)| row(name, Err(anyhow::anyhow!("{reason}")))).to_vec()
            }
        };
        self.spent = Spent { particles, pixels, time: start.elapsed() };
        rows
    }
}

/// Where the weights of the phases differ most from the paper's, and what is known of the reason.
fn explain(run: &ListRun, paper: &Phases, software: bool) -> String {
    let share = |phases: &Phases| {
        let sum: f64 = phases.named().iter().map(|(_, time)| time).sum();
        phases.named().map(|(name, time)| (name, 100.0 * time / sum.max(f64::MIN_POSITIVE)))
    };
    let pairs = share(&run.phases).into_iter().zip(share(paper));
    let most = pairs.max_by(|(a, b), (c, d)| (a.1 - b.1).abs().total_cmp(&(c.1 - d.1).abs()));
    let Some(((name, ours), (_, theirs))) = most else { return String::new() };
    let adapter = if software { "shaders run on the processor" } else { "another adapter" };
    format!(
        "{name} is {} % of the phases here, {} % in the paper: {adapter}, and {} pixels have lists of {} \
         balls on average; the paper's scene and lists are not printed.",
        decimal(ours),
        decimal(theirs),
        grouped(run.lists.pixels as usize),
        decimal(run.lists.mean)
    )
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use metaball_core::gpu::AdapterChoice;

    use super::kernels::Picture;
    use super::*;
    use crate::testing::{assert_stands_alone, read_back};

    #[test]
    fn every_table_is_measured() {
        let Some(gpu) = Gpu::for_test() else { return };
        let options = Options {
            extent: Extent::Quick,
            size: None,
            adapter: AdapterChoice::Environment,
            out: PathBuf::new(),
        };
        let measurements = measure(&gpu, &Plan::new(&options), None).expect("measured");
        let rows = || measurements.table.iter().chain(&measurements.views);
        assert_eq!(rows().count(), 5 * VARIANTS.len());
        for row in rows() {
            let run = row.run.as_ref().unwrap_or_else(|| panic!("{row:?}"));
            assert!(run.phases.sort > 0.0 && run.lists.nodes > 100, "{run:?}");
            // Rounding of supports to tiles and rectangles changes no list: all gather the same.
            assert!(run.lists.max >= run.lists.p99 && run.lists.mean >= 1.0);
        }
        for scene in measurements.table.chunks(VARIANTS.len()) {
            let nodes = |row: &Row| row.run.as_ref().map(|run| run.lists.nodes);
            assert_eq!(nodes(&scene[0]), nodes(&scene[1]), "one order, one picture");
        }
        assert_eq!(measurements.growth.len(), 1 + VARIANTS.len());
        assert!(measurements.memory.iter().all(|row| row.run.is_some()));
        // Perlin's has no exact variant; the cubic is worse than the exact polynomial where there is one.
        let mut compared = 0;
        for row in &measurements.kernels {
            let Picture::Compared(cubic) = &row.cubic else { panic!("{row:?}") };
            match &row.exact {
                Picture::Compared(exact) => {
                    compared += 1;
                    assert!(exact.rel_rms_t < cubic.rel_rms_t, "{row:?}");
                }
                Picture::Refused(reason) => assert!(reason.contains(&row.kernel), "{reason}"),
            }
        }
        assert_eq!(compared, 2, "Wyvill's and the quartic");

        let back = read_back(&measurements);
        assert_eq!(
            (back.heading.provenance.schema.as_str(), back.table.len()),
            (SCHEMA, measurements.table.len())
        );
        let page = page::page(&measurements);
        assert_stands_alone(&page, &[]);
        assert!(page.contains("Table 1"));
        assert!(measurements.text().contains("mud:800"));
    }

    #[test]
    fn rows_that_take_too_long_say_so() {
        let Some(gpu) = Gpu::for_test() else { return };
        let spent = Spent { particles: 100, pixels: 100, time: Duration::from_secs(1) };
        let time = Some(Duration::from_secs(30));
        let mut measurer =
            Measurer { gpu: &gpu, software: true, time, begun: Instant::now(), spent };
        let never = |_: &str| -> anyhow::Result<BenchScene> { panic!("not to be loaded") };
        let rows = measurer.rows("mud:4000", (10, 10), 1, None, None, never);
        assert_eq!(rows.len(), VARIANTS.len());
        for row in rows {
            assert!(row.why.is_some_and(|why| why.starts_with("Not run: it may take 40.0 s")));
        }
    }
}
