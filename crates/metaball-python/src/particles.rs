//! Scenes of particles in NumPy's arrays: nothing is copied but into the scene.

use metaball_core::{Color, Kernel, Scene};
use numpy::PyReadonlyArray2;
use particle_files::{Balls, LoadError, Radii};
use pyo3::prelude::*;

use crate::arrays::{NumberArray, Numbers, PointArray};

/// One number for all particles, or one for each.
#[derive(FromPyObject)]
pub(crate) enum Amount<'py> {
    #[pyo3(transparent, annotation = "number")]
    All(f32),
    #[pyo3(transparent, annotation = "array of shape (n,)")]
    Each(NumberArray<'py>),
}

/// The arrays of a `metaball.Particles`, which has checked their shapes.
#[derive(FromPyObject)]
pub(crate) struct Particles<'py> {
    centers: PointArray<'py>,
    radius: Option<Amount<'py>>,
    support_radius: Option<Amount<'py>>,
    strength: Option<NumberArray<'py>>,
    color: Option<PyReadonlyArray2<'py, u8>>,
}

impl Particles<'_> {
    /// The scene, made without the interpreter.
    pub(crate) fn scene(
        &self,
        py: Python<'_>,
        kernel: Kernel,
        threshold: f32,
    ) -> Result<Scene, LoadError> {
        let positions = self.centers.points();
        let strengths = self.strength.as_ref().map(NumberArray::numbers);
        let (shown, support) = (
            self.radius.as_ref().map(Amount::size),
            self.support_radius.as_ref().map(Amount::size),
        );
        let colors = self.color.as_ref().map(PyReadonlyArray2::as_array);
        py.detach(|| {
            let strengths = strengths.map(Numbers::to_slice);
            let radii = match (support, shown) {
                (Some(support), _) => support.radii(),
                (None, Some(shown)) => {
                    Radii::of_shown(&shown.radii(), strengths.as_deref(), kernel, threshold)?
                }
                (None, None) => Radii::by_spacing(&positions),
            };
            let balls = Balls { positions: &positions, radii, strengths: strengths.as_deref() };
            let scene = balls.scene(kernel, threshold)?;
            let Some(colors) = colors else { return Ok(scene) };
            let colors = colors.rows().into_iter();
            let colors = colors.map(|color| Color::srgb(color[0], color[1], color[2]));
            Ok(scene.with_colors(colors.collect())?)
        })
    }
}

/// An amount, for threads that do not hold the interpreter.
#[derive(Clone, Copy)]
enum Size<'a> {
    All(f32),
    Each(Numbers<'a>),
}

impl Amount<'_> {
    fn size(&self) -> Size<'_> {
        match self {
            Self::All(number) => Size::All(*number),
            Self::Each(array) => Size::Each(array.numbers()),
        }
    }
}

impl<'a> Size<'a> {
    fn radii(self) -> Radii<'a> {
        match self {
            Self::All(radius) => Radii::All(radius),
            Self::Each(radii) => Radii::Each(radii.to_slice()),
        }
    }
}
