//! Pictures in the light that was asked for.

use glam::Vec3;
use metaball_core::{Color, HostTracer, Scene, ValueRange, View};
use metaball_light::{DepthCue, Effects, cpu, develop};

/// Standard deviation of the depth cue's Gaussian, in parts of the picture's height.
pub(crate) const DEPTH_CUE_WIDTH: f32 = 0.02;

/// Light for any number of pictures by one camera: what its options ask for, checked and read.
#[derive(Debug)]
pub(crate) struct Lighting {
    pub(crate) effects: Effects,
    pub(crate) samples: u32,
    pub(crate) seed: u32,
    pub(crate) depth_cue: Option<f32>,
    pub(crate) stops: f32,
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
}
