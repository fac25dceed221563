//! Pictures in the light that was asked for.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use metaball_core::gpu::{Gpu, IsoRenderer};
use metaball_core::{Hit, Image, Scene, View};
use metaball_light::gpu::PathTracer;
use metaball_light::{Effects, Film};

use crate::Error;
use crate::summary::Progress;

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

/// A picture in its light, and what it took.
#[derive(Debug)]
pub(crate) struct Lit {
    pub(crate) image: Image,
    pub(crate) film: Film,
    pub(crate) samples: u32,
    pub(crate) time: Duration,
    /// Rays of the last sample that the method could not answer.
    pub(crate) undecided: u64,
}

impl Lighting {
    /// Draws a picture. `renderer` has built the scene; `hits` are the view's first hits; after each
    /// sample `progress` gets how many are done, and may break off.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        renderer: &mut dyn IsoRenderer,
        scene: &Scene,
        view: &View,
        hits: &[Hit],
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Lit, Error> {
        let samples = self.samples;
        let mut tracer =
            PathTracer::new(gpu, scene, view, self.effects.clone(), samples, self.seed)?;
        let start = Instant::now();
        for done in 1..=samples {
            tracer.add_sample(renderer)?;
            if progress(Progress { done, of: samples, resumed: 0 }).is_break() {
                return Err(Error::Interrupted);
            }
        }
        let time = start.elapsed();
        let mut film = tracer.film()?;
        if let Some(strength) = self.depth_cue {
            film.cue_depth(hits, DEPTH_CUE_WIDTH, strength);
        }
        let image = film.develop(self.stops);
        Ok(Lit { image, film, samples, time, undecided: tracer.undecided()? })
    }
}
