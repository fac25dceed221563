//! Particles as files give them, before a kernel and a threshold make them a scene.

use metaball_core::{Color, Kernel, Metaball, Scene, SceneError};

use crate::error::{Flaw, LoadError};

/// The kernel of files that name none: the quartic.
pub const DEFAULT_KERNEL: Kernel = Kernel::QUARTIC;

/// The threshold of files that name none: under the quartic a ball alone then shows at R/√2.
pub const DEFAULT_THRESHOLD: f32 = 0.25;

/// Balls, and where they came from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Particles {
    /// In the order of the file, in its units.
    pub balls: Vec<Metaball>,
    /// One for each ball, or `None`.
    pub colors: Option<Vec<Color>>,
    /// The support radius that all balls were given by their spacing; `None` where the file or the
    /// elements say it.
    pub spacing_radius: Option<f32>,
    /// The path of the file; `None` for particles of no file.
    pub file: Option<String>,
    /// The line of each ball, counted from 1; empty where the file has no lines.
    pub lines: Vec<usize>,
}

impl Particles {
    /// The scene of these particles.
    ///
    /// # Errors
    /// Names the first ball that is refused, with its line, or the threshold.
    pub fn into_scene(self, kernel: Kernel, threshold: f32) -> Result<Scene, LoadError> {
        let Self { balls, colors, file, lines, .. } = self;
        let made = Scene::new(balls, kernel, threshold).and_then(|scene| match colors {
            Some(colors) => scene.with_colors(colors),
            None => Ok(scene),
        });
        made.map_err(|error| {
            let mut flaw = Flaw::new(error.to_string());
            flaw.location.line = ball_of(&error).and_then(|ball| lines.get(ball).copied());
            flaw.location.file = file;
            flaw.into()
        })
    }

    /// The same with another radius, if theirs is by their spacing.
    pub(crate) fn respaced(mut self, radius: f32) -> Self {
        if self.spacing_radius.is_some() {
            self.spacing_radius = Some(radius);
            self.balls.iter_mut().for_each(|ball| ball.radius = radius);
        }
        self
    }
}

fn ball_of(error: &SceneError) -> Option<usize> {
    match *error {
        SceneError::Center { index, .. }
        | SceneError::Radius { index, .. }
        | SceneError::Strength { index, .. } => Some(index),
        _ => None,
    }
}
