//! Where pictures are drawn: on the targets of an adapter, or, where there is none, on the CPU alone.

use std::time::Instant;

use metaball_core::gpu::{self, Frame, FrameReport, FrameStatus, Gpu, RenderError, Targets};
use metaball_core::{Hit, Ray, Scene, View};

use crate::renderer::{Built, Renderer};

/// An adapter with the targets of a picture's size, or neither.
#[derive(Debug, Clone, Copy)]
pub struct Canvas<'a>(Option<(&'a Gpu, &'a Targets)>);

impl<'a> Canvas<'a> {
    /// On the adapter, if there is one with targets.
    pub fn new(gpu: Option<&'a Gpu>, targets: Option<&'a Targets>) -> Self {
        Self(gpu.zip(targets))
    }

    /// On an adapter.
    pub fn on_adapter(gpu: &'a Gpu, targets: &'a Targets) -> Self {
        Self(Some((gpu, targets)))
    }

    /// The adapter.
    pub fn gpu(&self) -> Option<&'a Gpu> {
        self.0.map(|(gpu, _)| gpu)
    }

    /// The view's rays, the same bits for every method and for the reference: where there is an adapter
    /// it makes them. What was drawn before is lost.
    ///
    /// # Errors
    /// When the device fails.
    pub fn rays(&self, view: &View) -> Result<Vec<Ray>, RenderError> {
        let Some((gpu, targets)) = self.0 else { return Ok(view.rays()) };
        // A frame without a method makes the rays.
        Frame::begin(gpu, targets, view)?.finish()?;
        targets.read_rays(gpu, view)
    }

    /// Builds for the scene, and draws one picture: its hits, row by row from the top left. Built for
    /// another scene, a renderer on an adapter keeps its pipelines.
    ///
    /// # Errors
    /// When the renderer cannot do the scene or needs an adapter, or its frame stays incomplete.
    pub fn picture(
        &self,
        renderer: &mut Renderer,
        scene: &Scene,
        view: &View,
    ) -> Result<Vec<Hit>, RenderError> {
        match renderer {
            Renderer::Adapter(renderer) => {
                let (gpu, targets) = self.0.ok_or(RenderError::NoAdapter)?;
                renderer.build(gpu, scene)?;
                gpu::render(gpu, renderer.as_mut(), targets, view)?;
                targets.read_hits(gpu)
            }
            Renderer::Host(method) => {
                let tracer = method.build(scene)?;
                Ok(tracer.picture_hits(&self.rays(view)?, view.width() as usize))
            }
        }
    }

    /// Draws a frame. The time of a method on the CPU is that of tracing alone, the rays being there.
    ///
    /// # Errors
    /// When the frame stays incomplete, or the device fails.
    pub fn draw(&self, built: &mut Built<'_>, view: &View) -> Result<Drawn, RenderError> {
        match built {
            Built::Adapter(renderer) => {
                let (gpu, targets) = self.0.ok_or(RenderError::NoAdapter)?;
                let report = gpu::render(gpu, renderer.as_mut(), targets, view)?;
                Ok(Drawn { report, hits: None })
            }
            Built::Host(tracer) => {
                let rays = self.rays(view)?;
                let start = Instant::now();
                let hits = tracer.picture_hits(&rays, view.width() as usize);
                let wall = start.elapsed();
                let passes = vec![("cpu:trace".to_owned(), wall)];
                let status = FrameStatus::default();
                let report = FrameReport { wall, passes, untimed_passes: 0, status };
                Ok(Drawn { report, hits: Some(hits) })
            }
        }
    }

    /// The hits of the frame that was drawn last.
    ///
    /// # Errors
    /// When the device fails.
    pub fn hits(&self, drawn: Drawn) -> Result<Vec<Hit>, RenderError> {
        match (drawn.hits, self.0) {
            (Some(hits), _) => Ok(hits),
            (None, Some((gpu, targets))) => targets.read_hits(gpu),
            (None, None) => Err(RenderError::NoAdapter),
        }
    }
}

/// A frame that was drawn.
#[derive(Debug)]
pub struct Drawn {
    /// Its times.
    pub report: FrameReport,
    /// Its hits; on an adapter they stay in the targets.
    hits: Option<Vec<Hit>>,
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};

    use super::*;
    use crate::configuration::sweeps::presets;

    /// A method on the CPU traces the very rays that the adapter's passes read.
    #[test]
    fn both_kinds_have_the_same_rays() {
        let Some(gpu) = Gpu::for_test() else { return };
        let bench = load("random-200", &Overrides::default()).expect("known");
        let view = View::new(bench.camera, 64, 48).expect("a size");
        let targets = Targets::new(&gpu, 64, 48, false, false).expect("memory");
        let canvas = Canvas::on_adapter(&gpu, &targets);
        let mut on_adapter = presets(&["fbvh"])[0].renderer(false);
        canvas.picture(&mut on_adapter, &bench.scene, &view).expect("drawn");
        let read = targets.read_rays(&gpu, &view).expect("read");
        assert_eq!(canvas.rays(&view).expect("made"), read);

        let renderer = presets(&["fbvh-certified-cpu"])[0].renderer(false);
        let Renderer::Host(method) = renderer else { panic!("on the CPU") };
        let tracer = method.build(&bench.scene).expect("built");
        let along = |rays: &[Ray]| tracer.picture_hits(rays, 64);
        let mut renderer = Renderer::Host(method);
        let drawn = canvas.picture(&mut renderer, &bench.scene, &view).expect("traced");
        assert_eq!(drawn, along(&read));
        // The view's own rays round otherwise: a comparison along those would be of other rays.
        assert_ne!(drawn, along(&view.rays()));
    }

    #[test]
    fn without_an_adapter_the_view_makes_the_rays() {
        let bench = load("random-200", &Overrides::default()).expect("known");
        let view = View::new(bench.camera, 64, 48).expect("a size");
        let canvas = Canvas::new(None, None);
        assert_eq!(canvas.rays(&view).expect("made"), view.rays());
        let mut on_adapter = presets(&["fbvh"])[0].renderer(false);
        let refused = canvas.picture(&mut on_adapter, &bench.scene, &view);
        assert!(matches!(refused, Err(RenderError::NoAdapter)));
    }
}
