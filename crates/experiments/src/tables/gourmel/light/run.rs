//! Measuring effects on a scene with several structures, in turn.

use std::collections::BTreeMap;

use anyhow::Context;
use bench_scenes::{Overrides, load};
use metaball_core::View;
use metaball_core::gpu::{Gpu, IsoRenderer, RenderError};
use metaball_light::gpu::PathTracer;
use serde::{Deserialize, Serialize};

use super::effect::Effect;
use crate::console::ProgressBar;
use crate::tables::gourmel::run::CameraPath;
use harness::measure::{milliseconds, views};
use harness::methods::find;
use harness::record::Samples;
use harness::stats::median;

/// An effect drawn with a structure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EffectRun {
    /// What was loaded.
    pub scene: String,
    /// Number of balls.
    pub balls: usize,
    /// The method.
    pub method: String,
    /// Name of the effect.
    pub effect: String,
    /// Milliseconds of each frame, from the start of encoding to the fence, one a camera.
    pub frame_ms: Samples,
    /// Median milliseconds of each pass; those of one label are summed over the frame.
    pub passes: BTreeMap<String, f64>,
    /// Rays of the last frame that the method could not answer.
    #[serde(alias = "doubts")]
    pub undecided: u64,
}

/// What to draw, and the runs that tables name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// The method.
    pub method: &'static str,
    /// The effect.
    pub effect: Effect,
}

/// Frames as they are drawn.
#[derive(Default)]
struct Frames {
    wall_ms: Vec<f64>,
    passes_ms: BTreeMap<String, Vec<f64>>,
    undecided: u64,
}

/// Draws every view with every wanted pair of a scene, in turn, after one that is not timed. A pair that
/// fails has its reason instead of a run. Advances `progress` by [`steps`] for each pair.
///
/// # Errors
/// When the scene does not load, or the pictures are too large for the adapter.
pub fn measure(
    gpu: &Gpu,
    spec: &str,
    wanted: &[Wanted],
    path: CameraPath,
    progress: &ProgressBar,
) -> anyhow::Result<Vec<anyhow::Result<EffectRun>>> {
    let bench = load(spec, &Overrides::default())?;
    let scene = &bench.scene;
    let views = views(&bench.camera, &bench.path, &scene.bounds(), path.size, path.cameras)?;
    let mut renderers: BTreeMap<&str, Result<Box<dyn IsoRenderer>, String>> = BTreeMap::new();
    let mut tracers = Vec::new();
    for one in wanted {
        renderers.entry(one.method).or_insert_with(|| {
            progress.stage(format!("{spec}: building {}", one.method));
            let method = find(one.method).ok_or("no such method")?;
            let mut renderer = method.renderer(false).on_adapter().ok_or("not on an adapter")?;
            renderer.build(gpu, scene).map_err(|error| error.to_string())?;
            Ok(renderer)
        });
        let effects = one.effect.effects(&bench.camera);
        tracers.push(PathTracer::new(gpu, scene, &views[0], effects, 1, 0)?);
    }

    let mut frames: Vec<Result<Frames, String>> =
        wanted.iter().map(|_| Ok(Frames::default())).collect();
    let warm_up = [(&views[0], false)].into_iter();
    for (view, is_timed) in warm_up.chain(views.iter().map(|view| (view, true))) {
        for ((one, tracer), frames) in wanted.iter().zip(&mut tracers).zip(&mut frames) {
            progress.stage(format!("{spec}: {} with {}", one.effect.name(), one.method));
            let renderer = renderers.get_mut(one.method);
            if let (Ok(taken), Some(Ok(renderer))) = (&mut *frames, renderer)
                && let Err(error) = taken.draw(tracer, renderer.as_mut(), view, is_timed)
            {
                *frames = Err(error.to_string());
            }
            progress.advance(1);
        }
    }
    let run = |(one, frames): (&Wanted, Result<Frames, String>)| {
        let about = || format!("{spec}, {} with {}", one.effect.name(), one.method);
        if let Some(Err(error)) = renderers.get(one.method) {
            return Err(anyhow::anyhow!("{error}")).with_context(about);
        }
        let frames = frames.map_err(anyhow::Error::msg).with_context(about)?;
        let middle = |(label, times): (String, Vec<f64>)| Some((label, median(&times)?));
        Ok(EffectRun {
            scene: spec.to_owned(),
            balls: scene.len(),
            method: one.method.to_owned(),
            effect: one.effect.name(),
            frame_ms: Samples::new(frames.wall_ms),
            passes: frames.passes_ms.into_iter().filter_map(middle).collect(),
            undecided: frames.undecided,
        })
    };
    Ok(wanted.iter().zip(frames).map(run).collect())
}

/// Steps of progress that [`measure`] makes for each pair.
pub fn steps(path: CameraPath) -> u64 {
    path.cameras as u64 + 1
}

impl Frames {
    fn draw(
        &mut self,
        tracer: &mut PathTracer<'_>,
        renderer: &mut dyn IsoRenderer,
        view: &View,
        is_timed: bool,
    ) -> Result<(), RenderError> {
        tracer.set_view(view)?;
        let report = tracer.add_sample(renderer)?;
        if is_timed {
            self.wall_ms.push(milliseconds(report.wall));
            for (label, time) in report.passes {
                self.passes_ms.entry(label).or_default().push(milliseconds(time));
            }
            self.undecided = tracer.undecided()?;
        }
        Ok(())
    }
}

impl EffectRun {
    /// How many times as long a frame took as one of the other run, the middle over the cameras.
    pub fn times_as_long_as(&self, other: &Self) -> Option<f64> {
        let pairs = self.frame_ms.samples.iter().zip(&other.frame_ms.samples);
        median(&pairs.map(|(ours, theirs)| ours / theirs).collect::<Vec<_>>())
    }

    /// Milliseconds of the passes of a kind.
    pub fn pass_ms(&self, kind: PassKind) -> f64 {
        let of_kind = self.passes.iter().filter(|(label, _)| PassKind::of(label) == kind);
        of_kind.map(|(_, ms)| ms).sum()
    }
}

/// Where a frame's time goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PassKind {
    /// Rays that seek their first hit: primary and mirrored ones.
    FirstHits,
    /// Shadow and occlusion rays.
    AnyHits,
    /// Dispatches that resume rays, most of them empty.
    Resuming,
    /// What effects do themselves.
    Light,
}

impl PassKind {
    /// Every kind.
    pub const ALL: [Self; 4] = [Self::FirstHits, Self::AnyHits, Self::Resuming, Self::Light];

    fn of(label: &str) -> Self {
        match label {
            "first hits" => Self::FirstHits,
            "any hits" => Self::AnyHits,
            label if label.starts_with("resume") => Self::Resuming,
            _ => Self::Light,
        }
    }

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::FirstHits => "first hits",
            Self::AnyHits => "any hits",
            Self::Resuming => "resuming",
            Self::Light => "light",
        }
    }
}
