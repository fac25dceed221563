//! Both tracers on one scene, in turns, and both against the oracle; primary rays, then lit pictures.

use std::fs;
use std::time::Instant;

use anyhow::Context;
use bench_scenes::{Overrides, load};
use fbvh::{Options, Tracer, Tree};
use metaball_core::reference::Oracle;
use metaball_core::{Hit, Kernel, Ray, Scene, View};
use picture_files::HitImage;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::{Deserialize, Serialize};

use super::lit::{self, LitPair};
use super::povray::Povray;
use super::povray::primary::{Primary, Times};
use crate::console::ProgressBar;
use harness::imported::accuracy_of;
use harness::measure::milliseconds;
use harness::record::Samples;
use harness::reference::Reference;
use harness::score::{Accuracy, score};

/// Threads of either tracer.
pub const THREADS: usize = 2;

/// A scene for both tracers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlannedScene {
    /// What to load.
    pub spec: String,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Times that each traces the picture.
    pub rounds: usize,
    /// Times that each draws the picture in each light.
    pub lit_rounds: usize,
}

impl PlannedScene {
    /// Steps of progress: the rounds, the peer's depths, the oracle, the lit pictures.
    pub(super) fn steps(&self) -> u64 {
        self.rounds as u64 + 2 + lit::steps(self)
    }
}

/// What was measured on a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Number of balls.
    pub balls: usize,
    /// The scene's own kernel, instead of which α = 2 was drawn.
    pub kernel: String,
    /// The certified tree.
    pub ours: Traced,
    /// POV-Ray, or why there is nothing of it.
    pub peer: Result<Traced, String>,
    /// Lit pictures; none in records older than they.
    #[serde(default)]
    pub lit: Vec<LitPair>,
}

impl Measured {
    /// The peer's time for tracing over ours; medians.
    pub fn times_as_fast(&self) -> Option<f64> {
        let peer = self.peer.as_ref().ok()?;
        Some(peer.trace_ms.median / self.ours.trace_ms.median)
    }
}

/// A tracer's times and errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Traced {
    /// Milliseconds before the first ray, each round: ours builds a tree, the peer parses a file.
    pub prepare_ms: Samples,
    /// Milliseconds from the first ray to the last, each round, by the wall's clock. Ours makes the
    /// rays and finds hits and normals; the peer makes the rays, finds hits and colours them.
    pub trace_ms: Samples,
    /// Milliseconds of processor time for tracing, summed over the threads, the mean over the
    /// rounds; `null` where the system does not say, or all rounds together are less than a tenth of
    /// a second and its steps too coarse.
    pub cpu_ms: Option<f64>,
    /// Pixels that hit.
    pub hits: usize,
    /// Comparison with the oracle; without normals for the peer.
    pub accuracy: Accuracy,
}

/// Measures both on a scene.
///
/// # Errors
/// When the scene does not load or no tree of it can be built. What goes wrong with the peer is in
/// the result.
pub fn measure(
    planned: &PlannedScene,
    program: Option<&Povray>,
    progress: &ProgressBar,
) -> anyhow::Result<Measured> {
    let bench = load(&planned.spec, &Overrides::default())?;
    let kernel = bench.scene.kernel().to_string();
    let scene = bench.scene.with_kernel(Kernel::QUARTIC);
    let view = View::new(bench.camera, planned.size.0, planned.size.1)?;
    let pool = ThreadPoolBuilder::new().num_threads(THREADS).build().context("no threads")?;

    let mut ours = Rounds::default();
    let mut theirs = Rounds::default();
    let job = program.context("not installed").and_then(|_| Primary::new(&scene, &view, THREADS));
    let mut job = job.map_err(|error| format!("{error:#}"));
    let mut hits = Vec::new();
    for round in 1..=planned.rounds {
        progress.stage(format!("{}: round {round} of {}", planned.spec, planned.rounds));
        hits = pool.install(|| trace(&scene, &view, &mut ours))?;
        if let Ok(drawn) = &job {
            match drawn.time() {
                Ok(times) => theirs.add_peer(times),
                Err(error) => job = Err(format!("{error:#}")),
            }
        }
        progress.advance(1);
    }
    progress.stage(format!("{}: depths", planned.spec));
    let depths = job.and_then(|job| job.hits().map_err(|error| format!("{error:#}")));
    progress.advance(1);

    progress.stage(format!("{}: oracle", planned.spec));
    let (images, rays) = (images(&hits, &depths), view.rays());
    let reference = reference(&scene, &rays, planned.size, &images, &pool);
    progress.advance(1);
    let ours = ours.summary(&hits, score(&reference, &hits)?);
    let peer = match depths {
        Ok(image) => Ok(theirs.summary(&image.hits, accuracy_of(&image, &reference)?)),
        Err(reason) => Err(reason),
    };
    let lit = lit::measure(planned, program, &pool, progress)?;
    Ok(Measured { balls: scene.len(), kernel, ours, peer, lit })
}

fn images<'a>(ours: &'a [Hit], theirs: &'a Result<HitImage, String>) -> Vec<&'a [Hit]> {
    std::iter::once(ours).chain(theirs.iter().map(|image| &image.hits[..])).collect()
}

/// The oracle on telling pixels; on all of a small picture.
fn reference(
    scene: &Scene,
    rays: &[Ray],
    size: (u32, u32),
    images: &[&[Hit]],
    pool: &ThreadPool,
) -> Reference {
    /// About a second's work.
    const SMALL: usize = 10_000;
    let oracle = Oracle::new(scene);
    pool.install(|| {
        if rays.len() <= SMALL {
            return Reference::of_every_pixel(size, oracle.first_hits(rays));
        }
        let radius = scene.supports().iter().map(|support| support.radius);
        let radius = radius.fold(f32::INFINITY, f32::min);
        Reference::of_telling_pixels(&oracle, rays, size, images, radius)
    })
}

/// Builds the tree and traces the picture, on the current pool.
fn trace(scene: &Scene, view: &View, rounds: &mut Rounds) -> anyhow::Result<Vec<Hit>> {
    let start = Instant::now();
    let tree = Tree::build(scene, &Options::certified())?;
    rounds.prepare.push(milliseconds(start.elapsed()));

    let (start, cpu) = (Instant::now(), processor_ms());
    let tracer = Tracer::new(&tree, scene);
    let hits = tracer.picture_hits(&view.rays(), view.width() as usize);
    rounds.trace.push(milliseconds(start.elapsed()));
    rounds.cpu.extend(processor_ms().zip(cpu).map(|(end, start)| end - start));
    Ok(hits)
}

/// Milliseconds that each round took.
#[derive(Debug, Default)]
struct Rounds {
    prepare: Vec<f64>,
    trace: Vec<f64>,
    cpu: Vec<f64>,
}

impl Rounds {
    fn add_peer(&mut self, times: Times) {
        self.prepare.push(times.parse);
        self.trace.push(times.trace);
        self.cpu.push(times.trace_cpu);
    }

    fn summary(self, hits: &[Hit], accuracy: Accuracy) -> Traced {
        /// Ten steps of [`processor_ms`].
        const TELLING: f64 = 100.0;
        let (rounds, cpu) = (self.cpu.len(), self.cpu.iter().sum::<f64>());
        Traced {
            prepare_ms: Samples::new(self.prepare),
            trace_ms: Samples::new(self.trace),
            cpu_ms: (cpu >= TELLING).then(|| cpu / rounds as f64),
            hits: hits.iter().filter(|hit| hit.is_hit()).count(),
            accuracy,
        }
    }
}

/// Processor time of this process so far, all threads, in Linux's steps of a hundredth of a second;
/// `None` elsewhere.
fn processor_ms() -> Option<f64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The name, in brackets, may have spaces; user and system time are the 12th and 13th after it.
    let fields = stat.rsplit_once(')')?.1;
    let ticks: Vec<f64> =
        fields.split_whitespace().skip(11).take(2).filter_map(|field| field.parse().ok()).collect();
    (ticks.len() == 2).then(|| 10.0 * ticks.iter().sum::<f64>())
}
