//! A view with its effects on the adapter, to which samples are added.

use glam::Vec4;
use metaball_core::gpu::{
    FrameReport, Gpu, IsoRenderer, RayBatch, RenderError, Targets, render_with,
};
use metaball_core::{Scene, View};

use super::buffers::Buffers;
use super::passes::Passes;
use super::waves::{Waves, is_followed_by};
use crate::cpu::sampling::shift;
use crate::path::{Path, Settings};
use crate::{Effects, Film};

/// A view of a scene with its light, and the film that collects the samples. 216 bytes a pixel.
#[derive(Debug)]
pub struct PathTracer<'a> {
    gpu: &'a Gpu,
    view: View,
    effects: Effects,
    settings: Settings,
    targets: Targets,
    buffers: Buffers,
    passes: Passes,
}

impl<'a> PathTracer<'a> {
    /// Prepares a view. `samples` is how many will be added: a single one goes through the middles of
    /// pixels, several are spread over them.
    ///
    /// # Errors
    /// When the picture does not fit the adapter.
    pub fn new(
        gpu: &'a Gpu,
        scene: &Scene,
        view: &View,
        effects: Effects,
        samples: u32,
        seed: u32,
    ) -> Result<Self, RenderError> {
        let has_colors = scene.colors().is_some();
        let targets = Targets::new(gpu, view.width(), view.height(), has_colors, false)?;
        let settings = Settings::new(&effects, samples, seed);
        let buffers = Buffers::new(gpu, &targets, &effects, settings)?;
        let passes = Passes::new(gpu, &targets, &buffers, &effects.environment)?;
        Ok(Self { gpu, view: view.clone(), effects, settings, targets, buffers, passes })
    }

    /// Begins a new picture with another camera and the same light.
    ///
    /// # Errors
    /// When the view is of another size, or the device fails.
    pub fn set_view(&mut self, view: &View) -> Result<(), RenderError> {
        let needed = (self.view.width(), self.view.height());
        let found = (view.width(), view.height());
        if needed != found {
            return Err(RenderError::ViewSize { needed, found });
        }
        let gpu = self.gpu;
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.clear_buffer(&self.buffers.film, 0, None);
            gpu.queue.submit([encoder.finish()]);
        })?;
        self.view = view.clone();
        self.settings.sample = 0;
        Ok(())
    }

    /// Follows one more path a pixel through the scene that the renderer has built, and adds its light to the
    /// film.
    ///
    /// A method that traces no rays but the view's own is enough for effects that
    /// [end at the first surface](Effects::end_at_first_surface).
    ///
    /// # Errors
    /// When the surface is see-through, which the CPU alone draws; when the method cannot trace the rays that
    /// the effects need; and whatever stops it.
    pub fn add_sample(
        &mut self,
        renderer: &mut dyn IsoRenderer,
    ) -> Result<FrameReport, RenderError> {
        if self.effects.transparency() > 0.0 {
            let method = renderer.name();
            let reason = "needed an opaque surface or a fluid on an adapter, found a see-through \
                          surface; the path tracer on the CPU draws it"
                .to_owned();
            return Err(RenderError::Unsupported { method, reason });
        }
        let gpu = self.gpu;
        let (mut settings, mut view) = (self.settings, self.view.clone());
        let follows = is_followed_by(&self.effects, renderer);
        if !follows && self.effects.end_at_first_surface() && settings.samples > 1 {
            // The method's rays go through the middles of pixels: the camera is turned instead.
            let moved = shift(settings.sample, settings.seed);
            let pixel = 2.0 * view.camera().half_height() / view.height() as f32;
            view = view.with_camera(view.camera().turned(pixel * moved.x, pixel * moved.y));
            settings.samples = 1;
        }
        let bytes = bytemuck::bytes_of(&settings);
        gpu.checked(|| gpu.queue.write_buffer(&self.buffers.settings, 0, bytes))?;
        let waves = Waves {
            effects: &self.effects,
            targets: &self.targets,
            buffers: &self.buffers,
            passes: &self.passes,
            rays_per_surface: settings.rays_per_surface(),
        };
        let report = render_with(gpu, renderer, &self.targets, &view, |renderer, frame| {
            if follows {
                waves.encode(renderer, frame)
            } else {
                waves.encode_first(renderer, frame)
            }
        })?;
        // The frame is complete: an incomplete one has been drawn again.
        self.passes.add_sample(gpu)?;
        self.settings.sample += 1;
        Ok(report)
    }

    /// The mean of the samples so far, of each pixel those whose rays have all been decided; black where
    /// there is none.
    ///
    /// # Errors
    /// When the device fails.
    pub fn film(&self) -> Result<Film, RenderError> {
        let sums = self.gpu.read::<Vec4>(&self.buffers.film)?;
        let light = sums.iter().map(|sum| sum.truncate() / sum.w.max(1.0)).collect();
        Ok(Film { width: self.view.width(), height: self.view.height(), light })
    }

    /// Pixels that a sample is missing of, since the method left a ray of it undecided: indices row by
    /// row. A tracer on the CPU that can tell draws them whole ([`cpu::PathTracer::pixels`]).
    ///
    /// [`cpu::PathTracer::pixels`]: crate::cpu::PathTracer::pixels
    ///
    /// # Errors
    /// When the device fails.
    pub fn unfinished(&self) -> Result<Vec<u32>, RenderError> {
        let sums = self.gpu.read::<Vec4>(&self.buffers.film)?;
        let samples = self.settings.sample as f32;
        let pixels = (0..).zip(&sums).filter(|(_, sum)| sum.w < samples);
        Ok(pixels.map(|(pixel, _)| pixel).collect())
    }

    /// Rays of the last sample that the method left undecided.
    ///
    /// # Errors
    /// When the device fails.
    pub fn undecided(&self) -> Result<u64, RenderError> {
        let paths = self.gpu.read::<Path>(&self.buffers.paths)?;
        Ok(paths.iter().map(|path| u64::from(path.undecided)).sum())
    }

    /// The last ray of each path, with its answer.
    pub fn last_path_rays(&self) -> &RayBatch {
        &self.buffers.path_rays
    }

    /// The last shadow or occlusion ray of each path, with its answer.
    pub fn last_shadow_rays(&self) -> &RayBatch {
        &self.buffers.shadow_rays
    }
}
