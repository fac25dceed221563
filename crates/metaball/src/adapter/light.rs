//! Ray traced light on a graphics adapter.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use metaball_core::gpu::{Gpu, IsoRenderer};
use metaball_core::{Hit, Image, View};
use metaball_light::Film;
use metaball_light::gpu::PathTracer;

use super::Certain;
use crate::Error;
use crate::light::{DEPTH_CUE_WIDTH, Lighting};
use crate::summary::{Progress, Stage, asked};

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
