//! Pictures in the light that was asked for.

use std::time::{Duration, Instant};

use metaball_core::gpu::{Gpu, IsoRenderer, RenderError};
use metaball_core::{Hit, Image, Scene, View};
use metaball_light::gpu::PathTracer;
use metaball_light::{Effects, Film};

/// Standard deviation of the depth cue's Gaussian, in parts of the picture's height.
const DEPTH_CUE_WIDTH: f32 = 0.02;

/// Light for any number of pictures by one camera: what its options ask for, checked and read.
#[derive(Debug)]
pub(crate) struct Lighting {
    pub(super) effects: Effects,
    pub(super) samples: u32,
    pub(super) seed: u32,
    pub(super) depth_cue: Option<f32>,
    pub(super) stops: f32,
}

/// A picture's light, and what it took.
#[derive(Debug, Clone)]
pub struct Lit {
    /// Linear light.
    pub film: Film,
    /// Paths a pixel.
    pub samples: u32,
    /// Wall time of all samples.
    pub time: Duration,
    /// Rays of the last sample that the method could not answer.
    pub undecided: u64,
}

impl Lighting {
    /// Draws a picture. `renderer` has built the scene; `hits` are the view's first hits; `after_sample`
    /// gets how many samples are done, and of how many.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        renderer: &mut dyn IsoRenderer,
        scene: &Scene,
        view: &View,
        hits: &[Hit],
        mut after_sample: impl FnMut(u32, u32),
    ) -> Result<(Image, Lit), RenderError> {
        let samples = self.samples;
        let mut tracer =
            PathTracer::new(gpu, scene, view, self.effects.clone(), samples, self.seed)?;
        let start = Instant::now();
        for sample in 1..=samples {
            tracer.add_sample(renderer)?;
            after_sample(sample, samples);
        }
        let time = start.elapsed();
        let mut film = tracer.film()?;
        if let Some(strength) = self.depth_cue {
            film.cue_depth(hits, DEPTH_CUE_WIDTH, strength);
        }
        let image = film.develop(self.stops);
        Ok((image, Lit { film, samples, time, undecided: tracer.undecided()? }))
    }
}
