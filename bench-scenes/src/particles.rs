//! Particles as files give them, before a kernel and a threshold make them a scene.

use glam::Vec3;
use metaball_core::{Color, Kernel, Metaball, Scene, SceneError};

use crate::error::Flaw;

/// The kernel of files that name none: the quartic.
pub const DEFAULT_KERNEL: Kernel = Kernel::QUARTIC;

/// The threshold of files that name none: under the quartic a ball alone then shows at R/√2.
pub const DEFAULT_THRESHOLD: f32 = 0.25;

/// Balls and where they came from.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Particles {
    /// In the order of the file.
    pub(crate) balls: Vec<Metaball>,
    /// One for each ball, or `None`.
    pub(crate) colors: Option<Vec<Color>>,
    /// The line of each ball, counted from 1; empty where the file has no lines.
    pub(crate) lines: Vec<usize>,
    /// The radius that all balls were given by their spacing; `None` where the file or elements say it.
    pub(crate) spaced_radius: Option<f32>,
}

impl Particles {
    /// The same with another radius, if theirs is by their spacing.
    pub(crate) fn respaced(mut self, radius: f32) -> Self {
        if self.spaced_radius.is_some() {
            self.spaced_radius = Some(radius);
            self.balls.iter_mut().for_each(|ball| ball.radius = radius);
        }
        self
    }

    /// The scene of these particles.
    pub(crate) fn into_scene(self, kernel: Kernel, threshold: f32) -> Result<Scene, Flaw> {
        let scene = Scene::new(self.balls, kernel, threshold).map_err(|error| {
            let flaw = Flaw::new(error.to_string());
            match ball_of(&error).and_then(|ball| self.lines.get(ball)) {
                Some(&line) => flaw.at_line(line),
                None => flaw,
            }
        })?;
        match self.colors {
            Some(colors) => scene.with_colors(colors).map_err(|e| Flaw::new(e.to_string())),
            None => Ok(scene),
        }
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

/// The median distance from a particle to its nearest neighbour at another place, over at most 1,001
/// particles picked at equal steps through the list. `None` where all are at one place.
pub(crate) fn median_spacing(centers: &[Vec3]) -> Option<f32> {
    let step = centers.len().div_ceil(1001).max(1);
    let mut distances: Vec<f32> = centers
        .iter()
        .step_by(step)
        .filter_map(|center| {
            let squared = centers
                .iter()
                .map(|other| center.distance_squared(*other))
                .filter(|squared| *squared > 0.0)
                .fold(f32::INFINITY, f32::min);
            squared.is_finite().then(|| squared.sqrt())
        })
        .collect();
    let middle = distances.len() / 2;
    (!distances.is_empty()).then(|| *distances.select_nth_unstable_by(middle, f32::total_cmp).1)
}
