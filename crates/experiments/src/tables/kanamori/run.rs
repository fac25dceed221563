//! Measuring variants on a scene in turn, and the CPU baseline beside them.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use anyhow::Context;
use bench_scenes::{Overrides, load};
use kanamori_peel::baseline::Baseline;
use metaball_core::gpu::{Gpu, Targets, render};
use metaball_core::{Hit, Ray, Scene, View, Work};
use serde::{Deserialize, Serialize};

use super::plan::{Part, PlannedScene};
use super::variant::Variant;
use crate::console::ProgressBar;
use crate::tables::scene_result::SceneResult;
use harness::canvas::Canvas;
use harness::measure::{PreparedRenderer, milliseconds, time_all, views};
use harness::record::Samples;
use harness::renderer::Renderer;

/// A scene with its results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PartResult {
    /// Where it is reported.
    pub part: Part,
    /// What was measured.
    #[serde(flatten)]
    pub measured: SceneResult<Measured>,
    /// The paper's milliseconds on the GPU, where printed.
    pub paper_gpu_ms: Option<f64>,
    /// The paper's milliseconds on the CPU, where printed.
    pub paper_cpu_ms: Option<f64>,
}

/// What was measured on a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Number of balls.
    pub balls: usize,
    /// The variants, in the order planned.
    pub runs: Vec<VariantResult>,
    /// The CPU baseline.
    pub cpu: CpuRun,
}

/// A variant on the adapter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariantResult {
    /// Its name.
    #[serde(rename = "setting")]
    pub variant: String,
    /// What was measured, or why nothing was.
    pub result: Result<GpuRun, String>,
}

/// Times, work and error of a variant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GpuRun {
    /// Milliseconds of each frame, from the start of encoding to the fence.
    pub frame_ms: Samples,
    /// Median milliseconds of each pass.
    pub passes: BTreeMap<String, f64>,
    /// Layers that the ray with the most went through, and the mean over all rays.
    pub layers: (u32, f64),
    /// Iterations of a search: the mean and the most.
    pub iterations: (f64, u32),
    /// What the last frame was like, by name, such as the share of balls that culling left out.
    pub facts: BTreeMap<String, f64>,
    /// Root of the mean square of (t − t*)/t* over rays that both hit; t* is the CPU's, clipped to
    /// 1e-6. `None`: there is no such ray.
    pub rel_rms_t: Option<f64>,
    /// Rays that only one of the two hits.
    pub other_verdicts: usize,
}

/// The CPU baseline's times and work.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CpuRun {
    /// Milliseconds for the hierarchy.
    pub build_ms: f64,
    /// Milliseconds of each frame, on all threads.
    pub frame_ms: Samples,
    /// The part of the threads' time that went to finding intersections, 0 to 1: figure 8. The rest
    /// went to the isosurface tests.
    pub traversal_share: f64,
    /// Iterations of a search: the mean and the most.
    pub iterations: (f64, u64),
}

/// Frames of each variant that are timed.
const FRAMES: usize = 3;

/// Steps of progress for each variant: drawn, counted and timed.
pub(super) const STEPS: u64 = 2 + FRAMES as u64;

/// The baseline's threshold where it is the reference.
const REFERENCE_THRESHOLD: f64 = 1e-6;

/// Measures all variants on a scene.
///
/// # Errors
/// When the scene does not load, or the pictures are too large for the adapter.
pub fn measure(
    gpu: &Gpu,
    planned: &PlannedScene,
    progress: &ProgressBar,
) -> anyhow::Result<Measured> {
    let bench = load(&planned.spec, &Overrides::default())?;
    let scene = &bench.scene;
    let views = views(&bench.camera, &[], &scene.bounds(), planned.size, FRAMES)?;
    let (width, height) = planned.size;
    let targets = Targets::new(gpu, width, height, scene.colors().is_some(), false)?;

    let mut renderers = Vec::new();
    let mut prepared = Vec::new();
    let mut seen = None;
    for &variant in &planned.variants {
        progress.stage(format!("{}: {}", planned.spec, variant.name()));
        let outcome = prepare(gpu, scene, &targets, &views[0], variant).and_then(|made| {
            let rays = targets.read_rays(gpu, &views[0])?;
            renderers.push(made.0);
            seen = Some(rays);
            Ok(made.1)
        });
        prepared.push((variant, outcome));
        progress.advance(2);
    }
    let rays = seen.context("no variant could draw the scene")?;

    progress.stage(format!("{}: CPU", planned.spec));
    let (cpu, reference) = baseline(scene, &rays)?;
    progress.stage(format!("{}: timing", planned.spec));
    let errors: Vec<_> =
        renderers.iter().map(|renderer| error_of_t(&renderer.hits, &reference)).collect();
    let advance = || progress.advance(1);
    let canvas = Canvas::on_adapter(gpu, &targets);
    let timings = time_all(canvas, &mut renderers, &views, Duration::MAX, advance);
    let mut timed = timings.into_iter().zip(errors);

    let run = |(variant, prepared): (Variant, anyhow::Result<WorkOfRays>)| {
        let result = prepared.and_then(|work| {
            let (timing, (rel_rms_t, other_verdicts)) = timed.next().context("a timing each")?;
            let timing = timing?;
            Ok(GpuRun {
                frame_ms: timing.frame_ms,
                passes: timing.passes,
                layers: work.layers,
                iterations: work.iterations,
                facts: work.facts,
                rel_rms_t,
                other_verdicts,
            })
        });
        VariantResult {
            variant: variant.name(),
            result: result.map_err(|error| format!("{error:#}")),
        }
    };
    let runs = prepared.into_iter().map(run).collect();
    Ok(Measured { balls: scene.len(), runs, cpu })
}

fn prepare<'s>(
    gpu: &Gpu,
    scene: &'s Scene,
    targets: &Targets,
    view: &View,
    variant: Variant,
) -> anyhow::Result<(PreparedRenderer<'s>, WorkOfRays)> {
    let size = (view.width(), view.height());
    let mut counting = variant.renderer(size, true);
    counting.build(gpu, scene)?;
    let counted = Targets::new(gpu, size.0, size.1, scene.colors().is_some(), true)?;
    render(gpu, counting.as_mut(), &counted, view)?;
    let mut work = WorkOfRays::of(&counted.read_work(gpu)?.unwrap_or_default());
    let facts = counting.frame_facts(gpu)?.into_iter();
    work.facts = facts.map(|(name, value)| (name.to_owned(), value)).collect();
    let canvas = Canvas::on_adapter(gpu, targets);
    let renderer = Renderer::Adapter(variant.renderer(size, false));
    Ok((PreparedRenderer::prepare(canvas, renderer, scene, view)?, work))
}

/// What the counters of a picture come to; see [`GpuRun`].
#[derive(Debug, Clone, PartialEq)]
struct WorkOfRays {
    layers: (u32, f64),
    iterations: (f64, u32),
    facts: BTreeMap<String, f64>,
}

impl WorkOfRays {
    fn of(work: &[Work]) -> Self {
        let sum = |of: fn(&Work) -> u32| work.iter().map(|work| f64::from(of(work))).sum::<f64>();
        let most = |of: fn(&Work) -> u32| work.iter().map(of).max().unwrap_or(0);
        let searches = sum(|work| work.leaf_tests).max(1.0);
        Self {
            layers: (most(|work| work.layers), sum(|work| work.layers) / work.len().max(1) as f64),
            iterations: (sum(|work| work.iterations) / searches, most(|work| work.longest_search)),
            facts: BTreeMap::new(),
        }
    }
}

/// Times the baseline with the paper's threshold, and traces the reference.
fn baseline(scene: &Scene, rays: &[Ray]) -> anyhow::Result<(CpuRun, Vec<Hit>)> {
    let start = Instant::now();
    let published = Baseline::build(scene, 1e-3)?;
    let build_ms = milliseconds(start.elapsed());
    let mut frames = Vec::new();
    let mut traversal_share = 0.0;
    let mut iterations = (0.0, 0);
    for _ in 0..FRAMES {
        let start = Instant::now();
        let traced = published.trace(rays);
        frames.push(milliseconds(start.elapsed()));
        let traversal = traced.traversal.as_secs_f64();
        let both = traversal + traced.isosurface.as_secs_f64();
        traversal_share = traversal / both.max(f64::MIN_POSITIVE);
        let mean = traced.iterations as f64 / traced.searches.max(1) as f64;
        iterations = (mean, traced.most_iterations);
    }
    let reference = Baseline::build(scene, REFERENCE_THRESHOLD)?.trace(rays).hits;
    let frame_ms = Samples::new(frames);
    Ok((CpuRun { build_ms, frame_ms, traversal_share, iterations }, reference))
}

/// The relative root mean square error of t, and the rays with another verdict.
fn error_of_t(hits: &[Hit], reference: &[Hit]) -> (Option<f64>, usize) {
    let (mut squares, mut count, mut other) = (0.0, 0u32, 0);
    for (hit, reference) in hits.iter().zip(reference) {
        if hit.is_hit() != reference.is_hit() {
            other += 1;
        } else if hit.is_hit() && reference.t > 0.0 {
            squares += (f64::from(hit.t) / f64::from(reference.t) - 1.0).powi(2);
            count += 1;
        }
    }
    ((count > 0).then(|| (squares / f64::from(count)).sqrt()), other)
}

#[cfg(test)]
mod tests {
    use metaball_core::Verdict;

    use super::*;

    #[test]
    fn errors_are_relative_and_verdicts_are_counted() {
        let at = |t| Hit { verdict: Verdict::Hit, fallback: false, t, ..Hit::MISS };
        let hits = [at(1.1), at(2.0), Hit::MISS, at(5.0), Hit::MISS];
        let reference = [at(1.0), at(2.0), Hit::MISS, Hit::MISS, at(3.0)];
        let (error, other) = error_of_t(&hits, &reference);
        // t is an f32: 1.1 is off by 2.4e-8.
        assert!((error.expect("hits") - (0.01f64 / 2.0).sqrt()).abs() < 1e-7);
        assert_eq!(other, 2);
        assert_eq!(error_of_t(&[], &[]), (None, 0));
    }

    #[test]
    fn work_is_summed_up() {
        let ray = |leaf_tests, iterations, layers, longest_search| Work {
            leaf_tests,
            iterations,
            layers,
            longest_search,
            ..Work::default()
        };
        let work = WorkOfRays::of(&[ray(1, 5, 2, 5), ray(3, 7, 8, 4), ray(0, 0, 2, 0)]);
        assert_eq!((work.layers, work.iterations), ((8, 4.0), (3.0, 5)));
    }
}
