//! What light does in a picture.

use glam::{Vec3, Vec4};
use metaball_core::Camera;
use thiserror::Error;

/// The light of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Effects {
    /// What the metaballs are made of.
    pub surface: Surface,
    /// Lamps, far away.
    pub lamps: Vec<Lamp>,
    /// Whether lamps cast shadows.
    pub shadows: bool,
    /// Rays that feel for the surroundings. Without them a surface is lit by their mean.
    pub occlusion: Option<Occlusion>,
    /// Surfaces that a path may meet after the first: levels of reflection, or of surfaces seen through
    /// each other. Beyond the last there are the floor and the surroundings: at 0 a mirror shows these
    /// alone, which is environment mapping.
    pub bounces: u32,
    /// What the scene stands on, if anything.
    pub floor: Option<Floor>,
    /// What is seen where there is nothing.
    pub environment: Environment,
    /// Bands of light in cel shading; 0 for smooth shades.
    pub bands: u32,
}

/// What the metaballs are made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// Phong's model in the scene's colours.
    Opaque {
        /// Share of light that is mirrored at normal incidence, 0 to 1; 0 mirrors nothing.
        reflectivity: f32,
    },
    /// A clear fluid.
    Fluid {
        /// Index of refraction, above 0; water has 1.33.
        refraction: f32,
        /// Of red, green and blue, per scene unit: e^(−absorption·length) passes.
        absorption: Vec3,
    },
}

/// A lamp so far away that all of the scene sees it in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    /// Towards the lamp, world space; any length but 0.
    pub toward: Vec3,
    /// Degrees from rim to rim, 0 to 180; 0 casts hard shadows. The sun has half a degree.
    pub diameter: f32,
    /// Linear light on a surface that faces it.
    pub color: Vec3,
}

/// Rays from each surface point that feel whether they leave the scene (Gourmel et al. 2010, figure
/// 8 d: 64 of them).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Occlusion {
    /// Rays a surface point and sample.
    pub rays: u32,
    /// Where they end, scene units; [`NO_LIMIT`](metaball_core::NO_LIMIT) to feel the whole scene.
    pub reach: f32,
}

/// A level floor, matt, seen from above; y points up. Lamps cast shadows on it, a fluid casts none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// The point below the scene, world space.
    pub middle: Vec3,
    /// How far around it the floor goes before it is lost in the surroundings, scene units, above 0.
    pub reach: f32,
    /// Its colour, linear.
    pub color: Vec3,
    /// The side of its tiles, scene units; 0 for none.
    pub tile: f32,
}

/// What is seen where there is nothing.
#[derive(Debug, Clone, PartialEq)]
pub enum Environment {
    /// A generated clear sky over a studio floor; y points up.
    Sky,
    /// An image.
    Panorama(Panorama),
}

/// An equirectangular image of the surroundings: columns go around the y axis, from −z over +x; rows
/// from the zenith to the nadir.
#[derive(Debug, Clone, PartialEq)]
pub struct Panorama {
    columns: u32,
    rows: u32,
    light: Vec<Vec4>,
}

/// Why an image is no panorama.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PanoramaError {
    /// No pixels, or not one for each place.
    #[error(
        "panorama of {columns} × {rows}: needed as many pixels and at least one, found {found}"
    )]
    Size {
        /// Pixels around.
        columns: u32,
        /// Pixels from zenith to nadir.
        rows: u32,
        /// Pixels given.
        found: usize,
    },
    /// Light that is negative, infinite or NaN.
    #[error("panorama pixel {index}: needed finite light of at least 0, found {found}")]
    Light {
        /// Index, row by row.
        index: usize,
        /// The light.
        found: Vec3,
    },
}

impl Panorama {
    /// Linear light of each pixel, row by row from the zenith.
    ///
    /// # Errors
    /// When the size does not fit or a pixel is no light.
    pub fn new(
        columns: u32,
        rows: u32,
        light: impl IntoIterator<Item = Vec3>,
    ) -> Result<Self, PanoramaError> {
        let light: Vec<_> = light.into_iter().map(|light| light.extend(0.0)).collect();
        let found = light.len();
        if found == 0 || found as u64 != u64::from(columns) * u64::from(rows) {
            return Err(PanoramaError::Size { columns, rows, found });
        }
        let is_light = |light: &Vec4| light.is_finite() && light.min_element() >= 0.0;
        if let Some(index) = light.iter().position(|light| !is_light(light)) {
            return Err(PanoramaError::Light { index, found: light[index].truncate() });
        }
        Ok(Self { columns, rows, light })
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> (u32, u32) {
        (self.columns, self.rows)
    }

    pub(crate) fn light(&self) -> &[Vec4] {
        &self.light
    }
}

impl Effects {
    /// Whether the view's first hits tell all: nothing is asked about the scene along further rays.
    pub fn end_at_first_surface(&self) -> bool {
        let is_opaque = matches!(self.surface, Surface::Opaque { .. });
        is_opaque && self.bounces == 0 && !self.need_shadow_rays()
    }

    /// Whether surfaces send shadow or occlusion rays.
    pub(crate) fn need_shadow_rays(&self) -> bool {
        self.occlusion.is_some() || self.shadows && !self.lamps.is_empty()
    }

    /// Phong's model under the generated sky, lit by [`Lamp::studio`] without shadows.
    pub fn phong(camera: &Camera) -> Self {
        Self {
            surface: Surface::Opaque { reflectivity: 0.0 },
            lamps: Lamp::studio(camera).to_vec(),
            shadows: false,
            occlusion: None,
            bounces: 0,
            floor: None,
            environment: Environment::Sky,
            bands: 0,
        }
    }
}

impl Lamp {
    /// A warm key lamp over the left shoulder and a cool fill lamp from the right, which move with the
    /// camera: those of the shared Phong picture.
    pub fn studio(camera: &Camera) -> [Self; 2] {
        let (right, up, forward) = (camera.right(), camera.up(), camera.forward());
        [
            Self {
                toward: 0.8 * up - 0.6 * right - 0.9 * forward,
                diameter: 0.0,
                color: 0.85 * Vec3::new(1.0, 0.97, 0.92),
            },
            Self {
                toward: 0.9 * right - 0.1 * up - 0.5 * forward,
                diameter: 0.0,
                color: 0.18 * Vec3::new(0.75, 0.85, 1.0),
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panoramas_are_checked() {
        assert!(Panorama::new(2, 1, [Vec3::ZERO, Vec3::ONE]).is_ok());
        let size = Panorama::new(2, 2, [Vec3::ONE]).expect_err("refused");
        assert_eq!(size, PanoramaError::Size { columns: 2, rows: 2, found: 1 });
        assert!(Panorama::new(0, 0, []).is_err());
        let light = Panorama::new(1, 1, [Vec3::new(0.0, -1.0, 0.0)]).expect_err("refused");
        assert!(light.to_string().starts_with("panorama pixel 0"), "{light}");
        assert!(Panorama::new(1, 1, [Vec3::NAN]).is_err());
    }
}
