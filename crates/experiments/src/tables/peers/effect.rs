//! What lit pictures are drawn with, by both tracers.

use glam::Vec3;
use metaball_core::{Camera, NO_LIMIT};
use metaball_light::{Effects, Environment, Lamp, Occlusion, Panorama, Surface};

/// The light of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LitEffect {
    /// Hard shadows of one lamp, in the dark.
    Shadows,
    /// The same, with three levels of reflection.
    Mirrors,
    /// No lamp, but white surroundings, occluded along 64 rays.
    Occlusion,
}

impl LitEffect {
    /// Every effect, in the order of the table.
    pub const ALL: [Self; 3] = [Self::Shadows, Self::Mirrors, Self::Occlusion];

    /// Occlusion rays of a surface point.
    pub const OCCLUSION_RAYS: u32 = 64;

    /// White light on a surface that faces the lamp: with Phong's highlight less than white.
    pub const LAMP: f32 = 0.9;

    /// Its name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shadows => "hard shadows",
            Self::Mirrors => "hard shadows, 3 reflections",
            Self::Occlusion => "64 occlusion rays",
        }
    }

    /// How POV-Ray does it.
    pub fn peer(self) -> &'static str {
        match self {
            Self::Shadows | Self::Mirrors => "POV-Ray blob",
            Self::Occlusion => "POV-Ray radiosity, count 64, one bounce",
        }
    }

    /// What it is made of.
    ///
    /// # Errors
    /// When there are no such surroundings.
    pub(super) fn effects(self, camera: &Camera) -> anyhow::Result<Effects> {
        let [key, _] = Lamp::studio(camera);
        let lamp = Lamp { color: Vec3::splat(Self::LAMP), ..key };
        let surroundings = |light| Panorama::new(1, 1, [light]).map(Environment::Panorama);
        let base = Effects {
            lamps: vec![lamp],
            shadows: true,
            environment: surroundings(Vec3::ZERO)?,
            ..Effects::phong(camera)
        };
        Ok(match self {
            Self::Shadows => base,
            Self::Mirrors => {
                Effects { surface: Surface::Opaque { reflectivity: 0.3 }, bounces: 3, ..base }
            }
            Self::Occlusion => Effects {
                lamps: Vec::new(),
                occlusion: Some(Occlusion { rays: Self::OCCLUSION_RAYS, reach: NO_LIMIT }),
                environment: surroundings(Vec3::ONE)?,
                ..base
            },
        })
    }
}
