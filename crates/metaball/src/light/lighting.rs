//! Pictures in the light that was asked for.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use glam::Vec3;
use metaball_core::gpu::{Gpu, IsoRenderer};
use metaball_core::{Color, Hit, HostTracer, Image, Scene, ValueRange, View};
use metaball_light::gpu::PathTracer;
use metaball_light::{DepthCue, Effects, Film, cpu, develop};

use crate::Error;
use crate::certain::Certain;
use crate::summary::{Progress, Stage, asked};

/// Standard deviation of the depth cue's Gaussian, in parts of the picture's height.
pub(crate) const DEPTH_CUE_WIDTH: f32 = 0.02;

/// Light for any number of pictures by one camera: what its options ask for, checked and read.
#[derive(Debug)]
pub(crate) struct Lighting {
    pub(super) effects: Effects,
    pub(super) samples: u32,
    pub(super) seed: u32,
    pub(super) depth_cue: Option<f32>,
    pub(super) stops: f32,
}

/// A picture in its light, and what it took.
#[derive(Debug)]
pub(crate) struct Lit {
    pub(crate) image: Image,
    pub(crate) film: Film,
    pub(crate) samples: u32,
    pub(crate) time: Duration,
    /// Pixels with rays that the adapter could not tell, which the CPU has drawn.
    pub(crate) asked_again: u64,
}

impl Lighting {
    /// Paths of light a pixel.
    pub(crate) fn samples(&self) -> u32 {
        self.samples
    }

    /// Whether a pixel's light depends on the hits around it.
    pub(crate) fn cues_depth(&self) -> bool {
        self.depth_cue.is_some()
    }

    /// By how much, if it does.
    pub(crate) fn depth_cue_strength(&self) -> Option<f32> {
        self.depth_cue
    }

    /// What changes the light of a picture with these distances, if anything does.
    pub(crate) fn depth_cue(&self, view: &View, range: ValueRange) -> Option<DepthCue> {
        let size = (view.width(), view.height());
        self.depth_cue.map(|strength| DepthCue::new(size, range, DEPTH_CUE_WIDTH, strength))
    }

    /// The picture of light.
    pub(crate) fn develop(&self, light: &[Vec3]) -> Vec<Color> {
        develop(light, self.stops)
    }

    /// The same light on the CPU; `None` where the tree does not follow the rays that it needs.
    pub(crate) fn on_cpu<'a, T: HostTracer>(
        &self,
        tracer: &'a T,
        scene: &'a Scene,
        view: &View,
    ) -> Option<cpu::PathTracer<'a, T>> {
        let Self { effects, samples, seed, .. } = self;
        cpu::PathTracer::new(tracer, scene, view, effects, *samples, *seed).ok()
    }

    /// Draws a picture on the adapter. `renderer` has built the scene; `hits` are the view's first hits;
    /// after each sample `progress` gets how many are done, and may break off.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        renderer: &mut dyn IsoRenderer,
        certain: &Certain<'_>,
        view: &View,
        hits: &[Hit],
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Lit, Error> {
        let samples = self.samples;
        let mut tracer =
            PathTracer::new(gpu, certain.scene, view, self.effects.clone(), samples, self.seed)?;
        let start = Instant::now();
        for done in 1..=samples {
            tracer.add_sample(renderer)?;
            let stage = Stage::Drawing;
            asked(progress(Progress { stage, done, of: samples, resumed: 0 }))?;
        }
        let mut film = tracer.film()?;
        let unfinished = tracer.unfinished()?;
        certain.relight(self, view, &unfinished, &mut film)?;
        let time = start.elapsed();
        if let Some(strength) = self.depth_cue {
            film.cue_depth(hits, DEPTH_CUE_WIDTH, strength);
        }
        let image = film.develop(self.stops);
        Ok(Lit { image, film, samples, time, asked_again: unfinished.len() as u64 })
    }
}
