//! All tracers on one scene, in turns, and all against the oracle; primary rays, then lit pictures.

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

use super::contender::{Contender, Times};
use super::lit::{self, LitPair};
use super::povray;
use super::programs::{Named, Programs};
use crate::console::ProgressBar;
use harness::imported::accuracy_of;
use harness::measure::milliseconds;
use harness::record::Samples;
use harness::reference::Reference;
use harness::score::{Accuracy, score};

/// Threads of each tracer.
pub const THREADS: usize = 2;

/// A scene for all tracers.
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
    /// Cells of meshes' grids along their longest sides.
    pub cells: [u32; 3],
}

impl PlannedScene {
    /// Steps of progress: the rounds, the peers' hits, the oracle, the lit pictures.
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
    /// The other peers; none in records older than they.
    #[serde(default)]
    pub others: Vec<NamedPeer>,
    /// Lit pictures; none in records older than they.
    #[serde(default)]
    pub lit: Vec<LitPair>,
}

/// A peer by its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NamedPeer {
    /// In tables.
    pub name: String,
    /// What it did, or why there is nothing of it.
    pub result: Result<Traced, String>,
}

impl Measured {
    /// All peers with their names, POV-Ray first.
    pub fn peers(&self) -> impl Iterator<Item = (&str, &Result<Traced, String>)> {
        let others = self.others.iter().map(|peer| (peer.name.as_str(), &peer.result));
        std::iter::once((povray::NAME, &self.peer)).chain(others)
    }
}

/// A tracer's times and errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Traced {
    /// Milliseconds before the first ray, each round: ours builds a tree, POV-Ray parses a file, a mesh
    /// is made of a grid and a tree of it, Embree builds its own.
    pub prepare_ms: Samples,
    /// Milliseconds from the first ray to the last, each round, by the wall's clock. Ours makes the
    /// rays and finds hits and normals; POV-Ray makes the rays, finds hits and colours them; the others
    /// take the rays from memory and find hits and normals.
    pub trace_ms: Samples,
    /// Milliseconds of processor time for tracing, summed over the threads, the mean over the
    /// rounds; `null` where the system does not say, or all rounds together are less than a tenth of
    /// a second and its steps too coarse.
    pub cpu_ms: Option<f64>,
    /// Pixels that hit.
    pub hits: usize,
    /// Comparison with the oracle; without normals for POV-Ray.
    pub accuracy: Accuracy,
}

impl Traced {
    /// Milliseconds from the arrays to the picture: the median over the rounds.
    pub fn picture_ms(&self) -> f64 {
        let rounds = self.prepare_ms.samples.iter().zip(&self.trace_ms.samples);
        Samples::new(rounds.map(|(prepare, trace)| prepare + trace).collect()).median
    }
}

/// Measures all on a scene.
///
/// # Errors
/// When the scene does not load or no tree of it can be built. What goes wrong with a peer is in
/// the result.
pub fn measure(
    planned: &PlannedScene,
    programs: &Programs,
    progress: &ProgressBar,
) -> anyhow::Result<Measured> {
    let bench = load(&planned.spec, &Overrides::default())?;
    let kernel = bench.scene.kernel().to_string();
    let scene = bench.scene.with_kernel(Kernel::QUARTIC);
    let view = View::new(bench.camera, planned.size.0, planned.size.1)?;
    let pool = ThreadPoolBuilder::new().num_threads(THREADS).build().context("no threads")?;

    let mut ours = Rounds::default();
    let contenders = programs.contenders(planned, &scene, &view);
    let mut peers: Vec<_> = contenders.into_iter().map(PeerRounds::new).collect();
    let mut hits = Vec::new();
    for round in 1..=planned.rounds {
        progress.stage(format!("{}: round {round} of {}", planned.spec, planned.rounds));
        hits = pool.install(|| trace(&scene, &view, &mut ours))?;
        peers.iter_mut().for_each(PeerRounds::add);
        progress.advance(1);
    }
    progress.stage(format!("{}: the peers' hits", planned.spec));
    let drawn: Vec<_> = peers.into_iter().map(PeerRounds::finish).collect();
    progress.advance(1);

    progress.stage(format!("{}: oracle", planned.spec));
    let (images, rays) = (images(&hits, &drawn), view.rays());
    let reference = reference(&scene, &rays, planned.size, &images, &pool);
    progress.advance(1);
    let ours = ours.summary(&hits, score(&reference, &hits)?);
    let mut others = Vec::new();
    for Drawn { name, result } in drawn {
        let result = match result {
            Ok((rounds, image)) => {
                Ok(rounds.summary(&image.hits, accuracy_of(&image, &reference)?))
            }
            Err(reason) => Err(reason),
        };
        others.push(NamedPeer { name, result });
    }
    let peer = others.remove(0).result;
    let lit = lit::measure(planned, programs.povray.as_ref(), &pool, progress)?;
    Ok(Measured { balls: scene.len(), kernel, ours, peer, others, lit })
}

/// A contender and its times so far, or why it has none.
struct PeerRounds<'a> {
    name: String,
    result: Result<(Box<dyn Contender + 'a>, Rounds), String>,
}

/// What a peer has to show.
struct Drawn {
    name: String,
    result: Result<(Rounds, HitImage), String>,
}

impl<'a> PeerRounds<'a> {
    fn new((name, contender): Named<'a>) -> Self {
        let result = contender.map(|contender| (contender, Rounds::default()));
        Self { name, result: result.map_err(|error| format!("{error:#}")) }
    }

    /// Another round.
    fn add(&mut self) {
        let Ok((contender, rounds)) = &mut self.result else { return };
        match contender.time() {
            Ok(times) => rounds.add_peer(times),
            Err(error) => self.result = Err(format!("{error:#}")),
        }
    }

    fn finish(self) -> Drawn {
        let result = self.result.and_then(|(contender, rounds)| {
            let image = contender.hits().map_err(|error| format!("{error:#}"))?;
            Ok((rounds, image))
        });
        Drawn { name: self.name, result }
    }
}

fn images<'a>(ours: &'a [Hit], drawn: &'a [Drawn]) -> Vec<&'a [Hit]> {
    let drawn = drawn.iter().filter_map(|peer| peer.result.as_ref().ok());
    std::iter::once(ours).chain(drawn.map(|(_, image)| &image.hits[..])).collect()
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
        self.prepare.push(times.prepare);
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
