//! Measuring candidates on a scene: sparse pictures of all, whole pictures of the best few.

use std::time::Duration;

use metaball_core::gpu::{Gpu, RenderError};
use metaball_core::reference::Oracle;
use metaball_core::{Scene, View};

use super::choice::{Candidate, Choice, Errors, Measure, Measurement, choose};
use super::reference_view::ReferenceView;
use crate::configuration::Configuration;
use crate::measure::{PreparedRenderer, Sampling, Timing, time_all, views};
use crate::numbers::small;

/// Pixels across of sparse pictures; as many down as the view's shape needs.
const SPARSE_WIDTH: u32 = 96;

/// Rays of a whole picture that are held against the oracle, spread evenly.
const HELD_OUT_RAYS: usize = 96 * 72;

/// Two frames of a sparse picture.
const SPARSE: Sampling = Sampling::exactly(2);

/// Four frames of a whole picture, or what fits into a second.
const WHOLE: Sampling = Sampling { most: 4, enough: Duration::from_secs(1) };

/// Chooses the quickest of the candidates for the scene in this view whose error is at most
/// `max_error` mean support radii, with at most one wrong verdict in 10⁵ rays. Without an adapter
/// those that need one are left out.
///
/// # Errors
/// When none will do, with the reason for each; when the view cannot be drawn at all.
pub fn calibrate(
    gpu: Option<&Gpu>,
    scene: &Scene,
    view: &View,
    configurations: &[Configuration],
    max_error: f64,
) -> Result<Choice, RenderError> {
    let oracle = Oracle::new(scene);
    // The sparse picture's eye is moved a little: none of its rays is one of the whole picture's.
    let sparse_views = nearby(scene, view, sparse_size(view.width(), view.height()), SPARSE)?;
    let Some(sparse_view) = sparse_views.first() else { return Err(refused(String::new())) };
    let mut calibration = Calibration {
        scene,
        configurations,
        max_error,
        sparse: ReferenceView::new(gpu, scene, &oracle, sparse_view, usize::MAX)?,
        sparse_views: &sparse_views,
        whole: ReferenceView::new(gpu, scene, &oracle, view, HELD_OUT_RAYS)?,
        whole_views: nearby(scene, view, (view.width(), view.height()), WHOLE)?,
        renderers: configurations.iter().map(|_| None).collect(),
    };
    choose(&entries(configurations), max_error, &mut calibration).map_err(|left_out| {
        let reasons: Vec<_> =
            left_out.iter().map(|(name, reason)| format!("{name}: {reason}")).collect();
        let needed = small(max_error);
        refused(format!(
            "needed 99 of 100 hits within {needed} of the mean radius and no wrong verdict, found \
             {}",
            reasons.join("; ")
        ))
    })
}

/// Configurations as there are to choose: one with an option turned is a crude version of its method's
/// preset, where that takes part too.
fn entries<'a>(configurations: &'a [Configuration]) -> Vec<Candidate<'a>> {
    let preset_of = |configuration: &Configuration| {
        let is_preset = |other: &Configuration| {
            other.options.is_empty() && other.method.name == configuration.method.name
        };
        configurations.iter().position(is_preset).filter(|_| !configuration.options.is_empty())
    };
    let entry = |configuration: &'a Configuration| Candidate {
        name: &configuration.name,
        refines: preset_of(configuration),
    };
    configurations.iter().map(entry).collect()
}

fn refused(reason: String) -> RenderError {
    RenderError::Unsupported { method: super::NAME, reason }
}

/// The view's shape in fewer pixels, or the view's size where that is smaller.
fn sparse_size(width: u32, height: u32) -> (u32, u32) {
    let across = width.min(SPARSE_WIDTH);
    let down = u64::from(across) * u64::from(height) / u64::from(width.max(1));
    (across, u32::try_from(down).unwrap_or(height).clamp(1, height.max(1)))
}

/// Views moved by a pixel or two from this one.
fn nearby(
    scene: &Scene,
    view: &View,
    size: (u32, u32),
    sampling: Sampling,
) -> Result<Vec<View>, RenderError> {
    let nearby = views(view.camera(), &[], &scene.bounds(), size, sampling.most);
    nearby.map_err(|error| refused(error.to_string()))
}

/// Candidates on their scene. Those that are right enough in the sparse picture keep their renderers
/// for the whole one: composing shaders and compiling them takes longer than drawing.
struct Calibration<'a> {
    scene: &'a Scene,
    configurations: &'a [Configuration],
    max_error: f64,
    sparse: ReferenceView<'a>,
    sparse_views: &'a [View],
    whole: ReferenceView<'a>,
    whole_views: Vec<View>,
    renderers: Vec<Option<PreparedRenderer<'a>>>,
}

impl Measure for Calibration<'_> {
    fn sparse(&mut self, candidate: usize) -> Result<Measurement, String> {
        let (reference, renderer) = (&self.sparse, self.configurations[candidate].renderer(false));
        let prepared =
            PreparedRenderer::prepare(reference.canvas(), renderer, self.scene, reference.view);
        let renderer = prepared.map_err(|error| error.to_string())?;
        let errors = reference.errors(&renderer);
        if !errors.keep(self.max_error) {
            return Ok(Measurement { errors, frame_ms: f64::INFINITY });
        }
        let mut alone = [renderer];
        let timed = self.time(&self.sparse, &mut alone, self.sparse_views, SPARSE.enough);
        let frame_ms = timed.into_iter().next().unwrap_or_else(|| Err("not timed".to_owned()))?;
        let [renderer] = alone;
        self.renderers[candidate] = Some(renderer);
        Ok(Measurement { errors, frame_ms })
    }

    fn whole(&mut self, candidates: &[usize]) -> Vec<Result<Measurement, String>> {
        let mut drawn = Vec::new();
        let mut outcomes = Vec::new();
        for &candidate in candidates {
            outcomes.push(self.redraw(candidate).map(|renderer| {
                let errors = self.whole.errors(&renderer);
                if errors.keep(self.max_error) {
                    drawn.push(renderer);
                }
                errors
            }));
        }
        let timed = self.time(&self.whole, &mut drawn, &self.whole_views, WHOLE.enough);
        let mut timed = timed.into_iter();
        let outcome = |errors: Result<Errors, String>| {
            let errors = errors?;
            let frame_ms = if errors.keep(self.max_error) {
                timed.next().unwrap_or_else(|| Err("not timed".to_owned()))?
            } else {
                f64::INFINITY
            };
            Ok(Measurement { errors, frame_ms })
        };
        outcomes.into_iter().map(outcome).collect()
    }
}

impl<'a> Calibration<'a> {
    /// The whole picture, by the renderer that drew the sparse one.
    fn redraw(&mut self, candidate: usize) -> Result<PreparedRenderer<'a>, String> {
        let mut renderer =
            self.renderers[candidate].take().ok_or("drawn before, and was not right enough")?;
        let whole = &self.whole;
        let redrawn = renderer.redraw(whole.canvas(), whole.view);
        redrawn.map(|()| renderer).map_err(|error| error.to_string())
    }

    /// Median milliseconds of each renderer's frames, in turn.
    fn time(
        &self,
        reference: &ReferenceView<'_>,
        renderers: &mut [PreparedRenderer<'_>],
        views: &[View],
        enough: Duration,
    ) -> Vec<Result<f64, String>> {
        let timings = time_all(reference.canvas(), renderers, views, enough, || ());
        let median = |timing: Timing| timing.frame_ms.median;
        timings
            .into_iter()
            .map(|timing| timing.map(median).map_err(|error| error.to_string()))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sparse_pictures_have_the_shape_of_the_view() {
        assert_eq!(sparse_size(640, 480), (96, 72));
        assert_eq!(sparse_size(48, 36), (48, 36));
        assert_eq!(sparse_size(8192, 64), (96, 1));
        assert_eq!(sparse_size(1, 1), (1, 1));
    }
}
