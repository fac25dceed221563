//! One scene: what is chosen for each error, and all that could have been.

use std::time::Instant;

use bench_scenes::{BenchScene, Overrides, load};
use metaball_core::View;
use metaball_core::gpu::Gpu;
use metaball_core::reference::Oracle;
use serde::{Deserialize, Serialize};

use crate::console::ProgressBar;
use harness::auto::calibration::calibrate;
use harness::auto::choice::{Choice, Errors};
use harness::auto::reference_view::ReferenceView;
use harness::configuration::Configuration;
use harness::measure::{PreparedRenderer, Sampling, time_all, views};

/// A scene to choose for.
#[derive(Debug, Clone)]
pub struct PlannedScene {
    /// What [`bench_scenes::load`] takes.
    pub spec: String,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Errors that are allowed, mean support radii.
    pub errors: &'static [f64],
}

/// A scene, measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Number of balls.
    pub balls: usize,
    /// One for each error.
    #[serde(rename = "verdicts")]
    pub choices: Vec<JudgedChoice>,
    /// Every candidate's name with its picture, or with why there is none.
    pub all: Vec<(String, Result<Drawn, String>)>,
}

/// A candidate's picture of a view that no choice was made on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Drawn {
    /// How far off it is.
    pub errors: Errors,
    /// Median milliseconds of a frame.
    pub frame_ms: f64,
}

/// What was chosen for an error, and what it is worth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JudgedChoice {
    /// The error that was allowed, mean support radii.
    pub max_error: f64,
    /// What was chosen, or why nothing was.
    pub choice: Result<Choice, String>,
    /// How long choosing took, in seconds.
    pub seconds: f64,
    /// What was chosen, among all candidates.
    pub drawn: Option<Drawn>,
    /// The quickest of all that keep the error, and its milliseconds.
    pub best: Option<(String, f64)>,
}

/// Rays of the view that no choice was made on which are held against the oracle, spread evenly.
const RAYS: usize = 20_000;

/// Five frames, or what fits into a second and a half.
const FRAMES: Sampling = Sampling { most: 5, enough: std::time::Duration::from_millis(1_500) };

impl PlannedScene {
    pub(super) fn load(&self) -> anyhow::Result<BenchScene> {
        Ok(load(&self.spec, &Overrides::default())?)
    }

    pub(super) fn steps(&self, configurations: &[Configuration]) -> u64 {
        (self.errors.len() + configurations.len() * (1 + FRAMES.most)) as u64
    }

    /// Chooses for each error as if nothing had been chosen before, then draws with all.
    pub(super) fn measure(
        &self,
        gpu: &Gpu,
        configurations: &[Configuration],
        progress: &ProgressBar,
    ) -> anyhow::Result<Measured> {
        progress.stage(format!("{}: loading", self.spec));
        let bench = self.load()?;
        let (width, height) = self.size;
        let view = View::new(bench.camera, width, height)?;
        let choose = |&max_error: &f64| {
            progress.stage(format!("{}: choosing for {max_error}", self.spec));
            let start = Instant::now();
            let choice = calibrate(Some(gpu), &bench.scene, &view, configurations, max_error);
            progress.advance(1);
            (max_error, choice.map_err(|error| error.to_string()), start.elapsed().as_secs_f64())
        };
        let choices: Vec<_> = self.errors.iter().map(choose).collect();
        let all = self.draw_all(gpu, &bench, configurations, progress)?;
        let judged =
            |(max_error, choice, seconds): (f64, Result<Choice, String>, f64)| JudgedChoice {
                max_error,
                drawn: choice.as_ref().ok().and_then(|choice| drawn(&all, &choice.configuration)),
                best: best(&all, max_error),
                choice,
                seconds,
            };
        let choices = choices.into_iter().map(judged).collect();
        Ok(Measured { balls: bench.scene.len(), choices, all })
    }

    /// All pictures of one view, timed in turn.
    fn draw_all(
        &self,
        gpu: &Gpu,
        bench: &BenchScene,
        configurations: &[Configuration],
        progress: &ProgressBar,
    ) -> anyhow::Result<Vec<(String, Result<Drawn, String>)>> {
        let bounds = bench.scene.bounds();
        // Choosing has drawn the view itself and the first few near it; the last is another.
        let near = views(&bench.camera, &[], &bounds, self.size, 2 * FRAMES.most)?;
        let timed = &near[FRAMES.most..];
        let Some(unused) = timed.last() else { anyhow::bail!("needed a view, found none") };
        let reference =
            ReferenceView::new(Some(gpu), &bench.scene, &Oracle::new(&bench.scene), unused, RAYS)?;
        let (mut renderers, mut outcomes) = (Vec::new(), Vec::new());
        for configuration in configurations {
            progress.stage(format!("{}: {configuration}", self.spec));
            let renderer = configuration.renderer(false);
            let canvas = reference.canvas();
            let prepared =
                PreparedRenderer::prepare(canvas, renderer, &bench.scene, reference.view);
            outcomes.push(match prepared {
                Ok(renderer) => {
                    let errors = reference.errors(&renderer);
                    renderers.push(renderer);
                    Ok(errors)
                }
                Err(error) => Err(error.to_string()),
            });
            progress.advance(1);
        }
        progress.stage(format!("{}: timing", self.spec));
        let advance = || progress.advance(1);
        let timings = time_all(reference.canvas(), &mut renderers, timed, FRAMES.enough, advance);
        let mut timings = timings.into_iter();
        let drawn = |errors: Result<Errors, String>| {
            let errors = errors?;
            let timing = timings.next().ok_or("not timed")?.map_err(|error| error.to_string())?;
            Ok(Drawn { errors, frame_ms: timing.frame_ms.median })
        };
        let outcomes: Vec<_> = outcomes.into_iter().map(drawn).collect();
        Ok(configurations
            .iter()
            .map(|configuration| configuration.name.clone())
            .zip(outcomes)
            .collect())
    }
}

fn drawn(all: &[(String, Result<Drawn, String>)], name: &str) -> Option<Drawn> {
    all.iter().find(|(of, _)| of == name).and_then(|(_, drawn)| drawn.clone().ok())
}

/// The quickest of those that keep the error.
fn best(all: &[(String, Result<Drawn, String>)], max_error: f64) -> Option<(String, f64)> {
    let drawn = all.iter().filter_map(|(name, drawn)| Some((name, drawn.as_ref().ok()?)));
    drawn
        .filter(|(_, drawn)| drawn.errors.keep(max_error))
        .min_by(|a, b| a.1.frame_ms.total_cmp(&b.1.frame_ms))
        .map(|(name, drawn)| (name.clone(), drawn.frame_ms))
}

impl JudgedChoice {
    /// Time of the choice over that of the best, both of the view that no choice was made on. It is
    /// below 1 where the choice does not keep the error there and nothing else is as quick.
    pub fn ratio(&self) -> Option<f64> {
        Some(self.drawn.as_ref()?.frame_ms / self.best.as_ref()?.1)
    }

    /// Whether the choice keeps the error there; `None` of no picture.
    pub fn is_kept(&self) -> Option<bool> {
        self.drawn.as_ref().map(|drawn| drawn.errors.p99 <= self.max_error)
    }
}
