//! A view with the truth about its rays: what candidates are held against.

use metaball_core::gpu::{Gpu, RenderError, Targets};
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Scene, View};

use super::choice::Errors;
use crate::canvas::Canvas;
use crate::measure::PreparedRenderer;

/// A view with the truth about some of its rays.
pub struct ReferenceView<'a> {
    /// What is drawn.
    pub view: &'a View,
    gpu: Option<&'a Gpu>,
    targets: Option<Targets>,
    /// Rising indices of pixels with the truth about each.
    truths: Vec<(usize, Truth)>,
    mean_radius: f64,
}

impl<'a> ReferenceView<'a> {
    /// With the oracle's truth about at most so many rays, spread evenly.
    ///
    /// # Errors
    /// When there are no targets of that size, or the device fails.
    pub fn new(
        gpu: Option<&'a Gpu>,
        scene: &Scene,
        oracle: &Oracle<'_>,
        view: &'a View,
        most_rays: usize,
    ) -> Result<Self, RenderError> {
        let has_colors = scene.colors().is_some();
        let (width, height) = (view.width(), view.height());
        let targets =
            gpu.map(|gpu| Targets::new(gpu, width, height, has_colors, false)).transpose()?;
        let rays = Canvas::new(gpu, targets.as_ref()).rays(view)?;
        let count = rays.len().min(most_rays);
        let pixels: Vec<_> = (0..count).map(|index| index * rays.len() / count).collect();
        let chosen: Vec<_> = pixels.iter().map(|&pixel| rays[pixel]).collect();
        let truths = pixels.into_iter().zip(oracle.first_hits(&chosen)).collect();
        Ok(Self { view, gpu, targets, truths, mean_radius: mean_radius(scene) })
    }

    /// Where it is drawn.
    pub fn canvas(&self) -> Canvas<'_> {
        Canvas::new(self.gpu, self.targets.as_ref())
    }

    /// How far off the renderer's last picture is, which must be of this view.
    pub fn errors(&self, renderer: &PreparedRenderer<'_>) -> Errors {
        let pairs = self.truths.iter().map(|(pixel, truth)| (truth, &renderer.hits[*pixel]));
        Errors::of(pairs, self.mean_radius)
    }
}

/// The mean support radius.
pub fn mean_radius(scene: &Scene) -> f64 {
    let sum: f64 = scene.supports().iter().map(|ball| f64::from(ball.radius)).sum();
    sum / scene.len().max(1) as f64
}
