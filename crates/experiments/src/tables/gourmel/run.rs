//! Measuring structures on a scene, in turn.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use anyhow::Context;
use bench_scenes::{Overrides, load};
use fbvh::gpu::Renderer;
use fbvh::{Options, Stats, Tree};
use metaball_core::gpu::{Gpu, IsoRenderer, Targets};
use metaball_core::{Metaball, Scene};
use serde::{Deserialize, Serialize};

use super::plan::subject;
use super::tree_variant::TreeVariant;
use crate::console::ProgressBar;
use harness::canvas::Canvas;
use harness::measure::{PreparedRenderer, count_work, milliseconds, time_all, views};
use harness::record::{Samples, WorkPerRay};
use harness::renderer;

/// A structure measured on a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TreeRun {
    /// What was loaded.
    pub scene: String,
    /// Number of balls.
    pub balls: usize,
    /// Name of the tree's variant.
    #[serde(rename = "setting")]
    pub variant: String,
    /// Host milliseconds for the tree.
    pub build_ms: Samples,
    /// Milliseconds of each frame, from the start of encoding to the fence, one a camera.
    pub frame_ms: Samples,
    /// Median milliseconds of each pass.
    pub passes: BTreeMap<String, f64>,
    /// What was built.
    pub tree: TreeSize,
    /// Work a ray, from the first camera, in a frame of its own that is not timed.
    pub work: WorkPerRay,
}

/// Size of a tree.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TreeSize {
    /// Interior nodes.
    pub nodes: usize,
    /// Leaves.
    pub leaves: usize,
    /// Entries of all lists.
    pub list_entries: usize,
    /// Bytes of nodes, leaves and lists.
    pub bytes: usize,
    /// Levels of interior nodes.
    pub depth: usize,
    /// Own balls of a leaf, the mean.
    pub own_per_leaf: f64,
    /// Split balls of a leaf, the mean.
    pub split_per_leaf: f64,
}

impl From<Stats> for TreeSize {
    fn from(stats: Stats) -> Self {
        Self {
            nodes: stats.nodes,
            leaves: stats.leaves,
            list_entries: stats.list_entries,
            bytes: stats.bytes,
            depth: stats.depth,
            own_per_leaf: stats.own.mean,
            split_per_leaf: stats.split.mean,
        }
    }
}

impl TreeRun {
    /// Milliseconds of a frame, the mean over the cameras.
    pub fn mean_ms(&self) -> f64 {
        let samples = &self.frame_ms.samples;
        samples.iter().sum::<f64>() / samples.len().max(1) as f64
    }

    /// Evaluations of single kernels a ray.
    pub fn kernels_per_ray(&self) -> f64 {
        self.work.evaluations_per_ray
    }

    /// Milliseconds of the fastest and the slowest frame.
    pub fn extremes_ms(&self) -> (f64, f64) {
        let samples = || self.frame_ms.samples.iter().copied();
        (samples().fold(f64::INFINITY, f64::min), samples().fold(0.0, f64::max))
    }
}

/// Pictures to time, along a scene's camera path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CameraPath {
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Cameras along the path, one frame each.
    pub cameras: usize,
}

impl CameraPath {
    /// Steps of progress that [`measure`] makes for each variant.
    pub fn steps(self) -> u64 {
        self.cameras as u64 + 2
    }
}

/// What is known of a variant before it is timed.
type Prepared = ((Samples, TreeSize), WorkPerRay);

/// Trees built to time building.
const BUILDS: usize = 3;

/// Measures variants on a scene, frames in turn. One that fails has its reason instead of a run.
///
/// # Errors
/// When the scene does not load, or the pictures are too large for the adapter.
pub fn measure(
    gpu: &Gpu,
    spec: &str,
    variants: &[TreeVariant],
    path: CameraPath,
    progress: &ProgressBar,
) -> anyhow::Result<Vec<anyhow::Result<TreeRun>>> {
    let (loaded, factor) = subject(spec);
    let bench = load(loaded, &Overrides::default())?;
    let scene = &scaled(bench.scene, factor)?;
    let views = views(&bench.camera, &bench.path, &scene.bounds(), path.size, path.cameras)?;
    let colors = scene.colors().is_some();
    let targets = Targets::new(gpu, path.size.0, path.size.1, colors, false)?;
    let canvas = Canvas::on_adapter(gpu, &targets);

    let mut renderers = Vec::new();
    let mut outcomes = Vec::new();
    for &variant in variants {
        progress.stage(format!("{spec}: {}", variant.name()));
        let outcome = build(scene, &variant.options()).and_then(|built| {
            let drawn = renderer::Renderer::Adapter(renderer(variant, false));
            let prepared = PreparedRenderer::prepare(canvas, drawn, scene, &views[0])?;
            let work = count_work(gpu, renderer(variant, true), scene, &views[0])?;
            renderers.push(prepared);
            Ok((built, work))
        });
        outcomes.push((variant, outcome));
        progress.advance(2);
    }

    progress.stage(format!("{spec}: timing"));
    let advance = || progress.advance(1);
    let timings = time_all(canvas, &mut renderers, &views, Duration::MAX, advance);
    let mut timings = timings.into_iter();
    let run = |(variant, prepared): (TreeVariant, anyhow::Result<Prepared>)| {
        let about = || format!("{spec}, {}", variant.name());
        let ((build_ms, tree), work) = prepared.with_context(about)?;
        let timing = timings.next().context("a timing for each renderer")?.with_context(about)?;
        Ok(TreeRun {
            scene: spec.to_owned(),
            balls: scene.len(),
            variant: variant.name(),
            build_ms,
            frame_ms: timing.frame_ms,
            passes: timing.passes,
            tree,
            work,
        })
    };
    Ok(outcomes.into_iter().map(run).collect())
}

/// The scene with a factor on its balls' supports; the threshold stays, and so the solid swells.
fn scaled(scene: Scene, factor: f32) -> anyhow::Result<Scene> {
    if factor == 1.0 {
        return Ok(scene);
    }
    let balls = scene.balls().map(|ball| Metaball { radius: factor * ball.radius, ..ball });
    let resized = Scene::new(balls, scene.kernel(), scene.threshold())?;
    Ok(match scene.colors() {
        Some(colors) => resized.with_colors(colors.to_vec())?,
        None => resized,
    })
}

fn renderer(variant: TreeVariant, counting: bool) -> Box<dyn IsoRenderer> {
    Box::new(Renderer::new("fbvh", variant.options(), counting))
}

/// Times building, and measures how large the tree is.
fn build(scene: &Scene, options: &Options) -> anyhow::Result<(Samples, TreeSize)> {
    let mut times = Vec::new();
    loop {
        let start = Instant::now();
        let tree = Tree::build(scene, options)?;
        times.push(milliseconds(start.elapsed()));
        if times.len() == BUILDS {
            return Ok((Samples::new(times), tree.stats().into()));
        }
    }
}
