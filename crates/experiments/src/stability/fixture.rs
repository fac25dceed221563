//! What cases are run with: the adapter, if there is one, and renderers that live from scene to scene.

use std::time::Instant;

use bench_scenes::{Case, Redraw};
use metaball_core::Scene;
use metaball_core::gpu::{Gpu, RenderError, Targets};
use metaball_core::reference::Oracle;

use super::case_result::CaseResult;
use harness::canvas::Canvas;
use harness::configuration::Configuration;
use harness::judge::{Judge, Terms};
use harness::renderer::Renderer;

/// Rays of a picture that are judged at most, spread evenly.
const MOST_RAYS: usize = 900;

/// Scenes of more balls leave renderers with larger buffers than small scenes need: they are made anew.
const LARGE_SCENE: usize = 100;

/// Configurations with their renderers. Composing shaders takes longer than most of these pictures, so
/// renderers live as long as they can.
pub struct Fixture<'a> {
    gpu: Option<&'a Gpu>,
    targets: Option<Targets>,
    configurations: Vec<Tested>,
}

/// A configuration, what it is held to, and its renderer.
struct Tested {
    configuration: Configuration,
    terms: Terms,
    renderer: Renderer,
    /// Whether its shaders are composed and compiled, which is no part of what a value takes.
    is_warm: bool,
}

impl<'a> Fixture<'a> {
    /// For configurations that are held to what they promise. Nothing is made yet on the adapter.
    pub fn new(
        gpu: Option<&'a Gpu>,
        configurations: impl IntoIterator<Item = Configuration>,
    ) -> Self {
        let with_terms = |configuration: Configuration| {
            let terms = configuration.technique.terms();
            (configuration, terms)
        };
        Self::holding(gpu, configurations.into_iter().map(with_terms))
    }

    /// For configurations that are held to other terms than their own.
    pub fn holding(
        gpu: Option<&'a Gpu>,
        configurations: impl IntoIterator<Item = (Configuration, Terms)>,
    ) -> Self {
        let configuration = |(configuration, terms): (Configuration, Terms)| {
            let renderer = configuration.renderer(false);
            Tested { configuration, terms, renderer, is_warm: false }
        };
        Self {
            gpu,
            targets: None,
            configurations: configurations.into_iter().map(configuration).collect(),
        }
    }

    /// Runs every configuration at a value of a case, each against the same truth; but one for which `skip`
    /// has a reason is not run.
    ///
    /// # Errors
    /// When the value makes no scene, or the device fails; what a method refuses is an outcome.
    pub fn run(
        &mut self,
        case: &Case,
        value: f64,
        skip: impl Fn(&Configuration) -> Option<String>,
    ) -> anyhow::Result<Vec<CaseResult>> {
        let (bench, view) = case.view(value)?;
        let other = match case.redraw {
            Some(Redraw::Shuffled) => bench.shuffled()?.scene,
            Some(Redraw::Same) | None => bench.scene.clone(),
        };
        let (width, height) = (view.width(), view.height());
        let is_as_large = |made: &Targets| (made.width(), made.height()) == (width, height);
        self.targets = match (self.gpu, self.targets.take().filter(is_as_large)) {
            (Some(gpu), None) => Some(Targets::new(gpu, width, height, false, false)?),
            (_, made) => made,
        };
        let canvas = Canvas::new(self.gpu, self.targets.as_ref());
        let pixels = judged_pixels(view.pixels());
        let rays = pick(&canvas.rays(&view)?, &pixels);
        let oracle = Oracle::new(&bench.scene);
        let judge = Judge::new(&bench.scene, &oracle, &rays);

        let mut results = Vec::new();
        for Tested { configuration, terms, renderer, is_warm } in &mut self.configurations {
            if let Some(reason) = skip(configuration) {
                results.push(CaseResult::untried(case.name, value, &configuration.name, reason));
                continue;
            }
            let mut draw = |scene: &Scene| canvas.picture(renderer, scene, &view);
            if !*is_warm {
                *is_warm = draw(&bench.scene).is_ok();
            }
            let start = Instant::now();
            let drawn = draw(&bench.scene).and_then(|first| match case.redraw {
                None => Ok((first, None)),
                Some(_) => {
                    let second = draw(&other)?;
                    let differing = first.iter().zip(&second).filter(|(a, b)| a != b).count();
                    Ok((second, Some(differing)))
                }
            });
            let seconds = start.elapsed().as_secs_f64();
            let name = configuration.name.as_str();
            let result = match drawn {
                Ok((hits, differing)) => CaseResult::judged(
                    (case.name, value),
                    (name, terms),
                    (&judge, &pick(&hits, &pixels)),
                    differing,
                    case.redraw == Some(Redraw::Same),
                ),
                Err(error) if is_refusal(&error) => {
                    CaseResult::refused(case.name, value, name, error.to_string())
                }
                Err(error) => return Err(error.into()),
            };
            results.push(CaseResult { seconds, ..result });
            if bench.scene.len() > LARGE_SCENE {
                *renderer = configuration.renderer(false);
            }
        }
        Ok(results)
    }
}

/// Whether a method refused; anything else is a failure of the device or of us.
fn is_refusal(error: &RenderError) -> bool {
    matches!(
        error,
        RenderError::Unsupported { .. }
            | RenderError::Structure { .. }
            | RenderError::TooLarge { .. }
            | RenderError::Incomplete { .. }
    )
}

/// Rising indices of the pixels whose rays are judged.
fn judged_pixels(pixels: usize) -> Vec<usize> {
    let count = pixels.min(MOST_RAYS);
    (0..count).map(|index| index * pixels / count).collect()
}

fn pick<T: Copy>(all: &[T], pixels: &[usize]) -> Vec<T> {
    pixels.iter().map(|&pixel| all[pixel]).collect()
}
