//! A stability case: a scene with a parameter.

use metaball_core::View;

use crate::bench_scene::{BenchScene, Kind};
use crate::error::LoadError;
use crate::small::Shot;

/// A family of scenes with a parameter.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// The name by which a run chooses it.
    pub name: &'static str,
    /// What it is about.
    pub category: Category,
    /// One sentence on what is hard about it.
    pub about: &'static str,
    /// What the number means, and its unit.
    pub parameter: &'static str,
    /// The numbers to try, from easy to hard.
    pub values: &'static [f64],
    /// Those of them that a quick run tries.
    pub quick: &'static [f64],
    /// Pixels across and down at a value.
    pub(super) size: fn(f64) -> (u32, u32),
    /// What is drawn after the frame, if anything.
    pub redraw: Option<Redraw>,
    pub(super) make: fn(f64) -> Result<Shot, LoadError>,
}

/// What a case is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Category {
    /// Almost no balls, and many over one point.
    Overlap,
    /// Distances, sizes, strengths and thresholds.
    Magnitude,
    /// What is thin, near, or only just touched.
    Shape,
    /// Where the eye is.
    Viewpoint,
    /// Lenses, image sizes, and drawing again.
    Image,
}

/// A second frame, which should show what the first one does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Redraw {
    /// Of the same scene: to the last bit.
    Same,
    /// Of the [shuffled](BenchScene::shuffled) scene.
    Shuffled,
}

impl Category {
    /// As a heading says it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Overlap => "Overlap beyond capacity",
            Self::Magnitude => "Distances, sizes and thresholds",
            Self::Shape => "Thin, near and tangent",
            Self::Viewpoint => "Viewpoint",
            Self::Image => "Lenses and images",
        }
    }
}

impl Case {
    /// The scene at a value of the parameter, one of `values` or any other.
    ///
    /// # Errors
    /// When the value makes no legal scene or camera, which none of `values` does.
    pub fn scene(&self, value: f64) -> Result<BenchScene, LoadError> {
        let (scene, camera) = (self.make)(value)?;
        Ok(BenchScene {
            name: format!("{}={value}", self.name),
            about: self.about.to_owned(),
            scene,
            camera,
            path: Vec::new(),
            kind: Kind::General,
            file: None,
        })
    }

    /// The scene and its view at a value: an odd number of pixels across and down wherever the
    /// number is not what the case is about, so that one ray is the view axis.
    ///
    /// # Errors
    /// As [`Case::scene`].
    pub fn view(&self, value: f64) -> Result<(BenchScene, View), LoadError> {
        let scene = self.scene(value)?;
        let (width, height) = (self.size)(value);
        let view = View::new(scene.camera, width, height)?;
        Ok((scene, view))
    }
}

/// Pixels where nothing else is said.
pub(super) const SIZE: fn(f64) -> (u32, u32) = |_| (33, 25);

/// Small numbers on both sides of nothing.
pub(super) const AROUND_ZERO: &[f64] = &[0.1, -0.1, 1e-3, -1e-3, 1e-5, -1e-5, 1e-6, -1e-6, 0.0];

/// A parameter that counts.
pub(super) fn number(value: f64) -> usize {
    value.round() as usize
}
