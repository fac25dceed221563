//! What a generator is.

use glam::Vec3;
use metaball_core::{Aabb, Camera, Kernel};

use crate::density::UnscaledBall;
use crate::random::Random;

/// A way to fill space with balls.
#[derive(Debug)]
pub struct Generator {
    /// The first word of its spec.
    pub name: &'static str,
    /// One sentence on what it makes.
    pub about: &'static str,
    /// Mean number of other balls' supports that hold a ball's centre, where a spec names none.
    pub density: f64,
    /// The falloff.
    pub kernel: Kernel,
    /// T.
    pub threshold: f32,
    pub(super) layout: Layout,
    /// From the middle of the balls to the eye.
    pub(super) seen_from: Vec3,
    /// The path of cameras, from the balls' bounds and `seen_from`.
    pub(super) path: fn(&Aabb, Vec3) -> Vec<Camera>,
}

/// Lays out so many balls.
#[derive(Debug, Clone, Copy)]
pub(super) enum Layout {
    /// The same at all times.
    Still(fn(usize, &mut Random) -> Vec<UnscaledBall>),
    /// At a time in seconds; the still scene's is 0.
    Moving(fn(usize, &mut Random, f64) -> Vec<UnscaledBall>),
}

impl Generator {
    /// Whether its balls move.
    pub fn moves(&self) -> bool {
        matches!(self.layout, Layout::Moving(_))
    }
}
