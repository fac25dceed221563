//! A scene with the cameras that show it.

use metaball_core::{Camera, Scene};
use particle_files::{Cell, Legend, Notes};

use crate::error::LoadError;
use crate::random::Random;

/// A scene with the cameras that show it.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchScene {
    /// A known name, a generator's spec in full, or a file's name without its folder.
    pub name: String,
    /// One sentence on what it shows.
    pub about: String,
    /// The balls.
    pub scene: Scene,
    /// The camera for a single picture.
    pub camera: Camera,
    /// Cameras along a path, `camera` first, for measurements over many views. Empty where `camera`
    /// is the only view.
    pub path: Vec<Camera>,
    /// How strictly verdicts on its rays may be compared.
    pub kind: Kind,
    /// What its file says beside the balls; `None` for scenes of no file.
    pub file: Option<FileFacts>,
}

/// What a file says beside the balls.
#[derive(Debug, Clone, PartialEq)]
pub struct FileFacts {
    /// What was read, guessed and left out.
    pub notes: Notes,
    /// The periodic cell, in the coordinates of the file, in the unit of the scene.
    pub cell: Option<Cell>,
    /// What the colours say, where a column gave them.
    pub legend: Option<Legend>,
}

/// How strictly hit and miss may be compared between methods.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// No ray of `camera`, in pictures up to twice as wide as high, comes near a silhouette: the
    /// verdicts must be identical.
    Clear,
    /// Some rays graze the surface: those near it are the oracle's to call ambiguous.
    General,
}

impl BenchScene {
    /// The same balls in another order, without their colours.
    ///
    /// # Errors
    /// None that the scene itself would not have had.
    pub fn shuffled(&self) -> Result<Self, LoadError> {
        let mut balls: Vec<_> = self.scene.balls().collect();
        let mut random = Random::new(8);
        for last in (1..balls.len()).rev() {
            balls.swap(last, (random.unit() * (last + 1) as f64) as usize);
        }
        let scene = Scene::new(balls, self.scene.kernel(), self.scene.threshold())?;
        Ok(Self { scene, ..self.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases;

    #[test]
    fn shuffling_keeps_the_balls() {
        let case = cases().iter().find(|case| case.name == "shuffled").expect("known");
        let scene = case.scene(100.0).expect("legal");
        let shuffled = scene.shuffled().expect("legal");
        let sorted = |scene: &Scene| {
            let mut balls: Vec<_> = scene.balls().map(|ball| ball.center.to_array()).collect();
            balls.sort_by(|a, b| a[0].total_cmp(&b[0]));
            balls
        };
        assert_ne!(scene.scene, shuffled.scene);
        assert_eq!(sorted(&scene.scene), sorted(&shuffled.scene));
    }
}
