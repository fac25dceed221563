//! The shaders as a tracer of rays that are made on the host.

use fbvh::Options;
use fbvh::gpu::Renderer;
use metaball_core::gpu::{
    FreeRay, Gpu, IsoRenderer, RayBatch, RenderError, Targets, render, render_with,
};
use metaball_core::{Camera, Hit, Kernel, Ray, RayQuery, Scene, View};

/// Rays of a batch: this many squared.
pub const SIDE: u32 = 128;

/// An adapter with a renderer for each kind of scene, since making pipelines takes longer than most of
/// these batches.
pub struct AdapterTracer<'a> {
    gpu: &'a Gpu,
    targets: Targets,
    batch: RayBatch,
    renderers: Vec<(Kernel, bool, Renderer)>,
}

impl<'a> AdapterTracer<'a> {
    /// Nothing is compiled yet.
    ///
    /// # Errors
    /// When the device fails.
    pub fn new(gpu: &'a Gpu) -> Result<Self, RenderError> {
        let targets = Targets::new(gpu, SIDE, SIDE, false, false)?;
        let batch = RayBatch::new(gpu, &targets)?;
        Ok(Self { gpu, targets, batch, renderers: Vec::new() })
    }

    /// Builds the certified tree of a scene.
    ///
    /// # Errors
    /// When it cannot be built, or the device fails.
    pub fn build(&mut self, scene: &Scene) -> Result<AdapterScene<'_>, RenderError> {
        let (kernel, strengths) = (scene.kernel(), scene.strengths().is_some());
        let known = self.renderers.iter().position(|kind| (kind.0, kind.1) == (kernel, strengths));
        let index = known.unwrap_or(self.renderers.len());
        if known.is_none() {
            let renderer = Renderer::new("fbvh-certified", Options::certified(), false);
            self.renderers.push((kernel, strengths, renderer));
        }
        let renderer = &mut self.renderers[index].2;
        renderer.build(self.gpu, scene)?;
        Ok(AdapterScene { gpu: self.gpu, targets: &self.targets, batch: &self.batch, renderer })
    }
}

/// A scene on the adapter.
pub struct AdapterScene<'a> {
    gpu: &'a Gpu,
    targets: &'a Targets,
    batch: &'a RayBatch,
    renderer: &'a mut Renderer,
}

impl AdapterScene<'_> {
    /// The primary rays of a picture of [`SIDE`] by [`SIDE`] pixels, as the shaders made them, and what
    /// was found along them.
    ///
    /// # Errors
    /// When the device fails.
    pub fn picture(&mut self, camera: Camera) -> anyhow::Result<(Vec<Ray>, Vec<Hit>)> {
        let view = View::new(camera, SIDE, SIDE)?;
        render(self.gpu, self.renderer, self.targets, &view)?;
        Ok((self.targets.read_rays(self.gpu, &view)?, self.targets.read_hits(self.gpu)?))
    }

    /// Answers to rays, at most [`SIDE`] squared of them.
    ///
    /// # Errors
    /// When there are more, or the device fails.
    pub fn answers(&mut self, camera: Camera, rays: &[FreeRay]) -> anyhow::Result<Vec<Hit>> {
        let view = View::new(camera, SIDE, SIDE)?;
        self.batch.write_rays(self.gpu, rays)?;
        let batch = self.batch;
        render_with(self.gpu, self.renderer, self.targets, &view, |renderer, frame| {
            let name = renderer.name();
            let reason = "needed a tracer of any ray, found none".to_owned();
            let none = RenderError::Unsupported { method: name, reason };
            let tracer = renderer.ray_tracer().ok_or(none)?;
            RayQuery::ALL.iter().try_for_each(|&query| tracer.encode_answers(frame, batch, query))
        })?;
        let mut hits = self.batch.read_hits(self.gpu)?;
        hits.truncate(rays.len());
        Ok(hits)
    }
}
