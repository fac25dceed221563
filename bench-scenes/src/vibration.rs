//! A molecule that vibrates in a few of its normal modes.

use metaball_core::{Metaball, Scene};
use particle_files::PackedFrames;

use crate::error::LoadError;
use crate::exact::turn;

/// A periodic motion of balls.
#[derive(Debug)]
pub(crate) struct Vibration {
    /// The balls at rest.
    pub(crate) rest: Scene,
    /// For each mode the displacements of all balls, softest mode first.
    pub(crate) modes: PackedFrames,
}

impl Vibration {
    /// Frames of a period.
    pub(crate) const PERIOD: u32 = 96;

    /// Every ball at its position of rest plus its displacement in each mode, the softest of which swings
    /// once in a period, the next twice, and so on: at frame 0 all are at rest.
    pub(crate) fn frame(&self, number: u32) -> Result<Scene, LoadError> {
        let mut balls: Vec<Metaball> = self.rest.balls().collect();
        for mode in 0..self.modes.count() {
            let phase = (mode + 1) * (number % Self::PERIOD);
            let swing = turn(f64::from(phase) / f64::from(Self::PERIOD)).y as f32;
            for (ball, displaced) in balls.iter_mut().zip(self.modes.centers(mode)) {
                ball.center += swing * displaced;
            }
        }
        let scene = Scene::new(balls, self.rest.kernel(), self.rest.threshold())?;
        match self.rest.colors() {
            Some(colors) => Ok(scene.with_colors(colors.to_vec())?),
            None => Ok(scene),
        }
    }
}
