//! Measuring candidates on a scene: sparse pictures of all, whole pictures of the best few.

use std::time::Duration;

use metaball_core::gpu::{Frame, Gpu, RenderError, Targets};
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Scene, View};

use super::choice::{Choice, Errors, Outcome, Sketch, choose};
use crate::measure::{Contender, Sampling, time_all, views};
use crate::numbers::small;
use crate::settings::Setting;

/// Pixels across of sparse pictures; as many down as the view's shape asks for.
const SPARSE_WIDTH: u32 = 96;

/// Rays of a whole picture that are held against the oracle, spread evenly.
const HELD_OUT_RAYS: usize = 96 * 72;

/// Two frames of a sparse picture.
const SPARSE: Sampling = Sampling::exactly(2);

/// Five frames of a whole picture, or what fits into two seconds.
const WHOLE: Sampling = Sampling { most: 5, enough: Duration::from_secs(2) };

/// Chooses the quickest of the candidates for the scene in this view whose error is at most
/// `max_error` mean support radii, with at most one wrong verdict in 10⁵ rays.
///
/// # Errors
/// When none will do, with the reason for each; when the view cannot be drawn at all.
pub fn calibrate(
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    candidates: &[Setting],
    max_error: f64,
) -> Result<Choice, RenderError> {
    let oracle = Oracle::new(scene);
    // The sparse picture's eye is moved a little: none of its rays is one of the whole picture's.
    let sparse_size = sparse_size(view.width(), view.height());
    let sparse_views = nearby(scene, view, sparse_size, SPARSE)?;
    let Some(sparse_view) = sparse_views.first() else { return Err(refused(String::new())) };
    let sparse_stage = Stage::new(gpu, scene, &oracle, sparse_view, usize::MAX)?;
    let sketch = |setting: &Setting| {
        let mut outcomes = sparse_stage.draw(&[setting], &sparse_views, SPARSE.enough);
        outcomes.pop().unwrap_or_else(|| Err("not drawn".to_owned()))
    };
    let sparse: Vec<_> = candidates.iter().map(sketch).collect();

    let whole_views = nearby(scene, view, (view.width(), view.height()), WHOLE)?;
    let whole_stage = Stage::new(gpu, scene, &oracle, view, HELD_OUT_RAYS)?;
    let names: Vec<_> = candidates.iter().map(|setting| setting.name.as_str()).collect();
    let examine = |places: &[usize]| {
        let few: Vec<_> = places.iter().map(|&place| &candidates[place]).collect();
        whole_stage.draw(&few, &whole_views, WHOLE.enough)
    };
    choose(&names, &sparse, max_error, examine).map_err(|left_out| {
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

/// The mean support radius.
pub fn mean_radius(scene: &Scene) -> f64 {
    let sum: f64 = scene.supports().iter().map(|ball| f64::from(ball.radius)).sum();
    sum / scene.len().max(1) as f64
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

/// Views a pixel or two beside this one.
fn nearby(
    scene: &Scene,
    view: &View,
    size: (u32, u32),
    sampling: Sampling,
) -> Result<Vec<View>, RenderError> {
    let nearby = views(view.camera(), &[], &scene.bounds(), size, sampling.most);
    nearby.map_err(|error| refused(error.to_string()))
}

/// A view with the truth about some of its rays.
struct Stage<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    view: &'a View,
    targets: Targets,
    /// Rising indices of pixels with the truth about each.
    truths: Vec<(usize, Truth)>,
    mean_radius: f64,
}

impl<'a> Stage<'a> {
    /// Asks the oracle about at most so many rays, spread evenly.
    fn new(
        gpu: &'a Gpu,
        scene: &'a Scene,
        oracle: &Oracle<'_>,
        view: &'a View,
        most_rays: usize,
    ) -> Result<Self, RenderError> {
        let has_colors = scene.colors().is_some();
        let targets = Targets::new(gpu, view.width(), view.height(), has_colors, false)?;
        // A frame without a method makes the rays.
        Frame::begin(gpu, &targets, view)?.finish()?;
        let rays = targets.read_rays(gpu, view)?;
        let count = rays.len().min(most_rays);
        let pixels: Vec<_> = (0..count).map(|index| index * rays.len() / count).collect();
        let chosen: Vec<_> = pixels.iter().map(|&pixel| rays[pixel]).collect();
        let truths = pixels.into_iter().zip(oracle.first_hits(&chosen)).collect();
        Ok(Self { gpu, scene, view, targets, truths, mean_radius: mean_radius(scene) })
    }

    /// Draws with each, holds the pictures against the truth, and times them in turn.
    fn draw(&self, settings: &[&Setting], views: &[View], enough: Duration) -> Vec<Outcome> {
        let mut contenders = Vec::new();
        let mut outcomes = Vec::new();
        for setting in settings {
            let renderer = setting.renderer(false);
            let (scene, targets) = (self.scene, &self.targets);
            match Contender::prepare(self.gpu, renderer, scene, targets, self.view) {
                Ok(contender) => {
                    outcomes.push(Ok(self.errors(&contender)));
                    contenders.push(contender);
                }
                Err(error) => outcomes.push(Err(error.to_string())),
            }
        }
        let timings = time_all(self.gpu, &mut contenders, &self.targets, views, enough, || ());
        let mut timings = timings.into_iter();
        let outcome = |errors: Result<Errors, String>| {
            let errors = errors?;
            let timing = timings.next().ok_or("not timed")?.map_err(|error| error.to_string())?;
            Ok(Sketch { errors, frame_ms: timing.frame_ms.median })
        };
        outcomes.into_iter().map(outcome).collect()
    }

    fn errors(&self, contender: &Contender) -> Errors {
        let pairs = self.truths.iter().map(|(pixel, truth)| (truth, &contender.hits[*pixel]));
        Errors::of(pairs, self.mean_radius)
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
