//! Effects of light as plain values: surface, lamps, occlusion, floor and environment.

use glam::Vec3;
use metaball_core::{Camera, RayQuery};

use crate::Panorama;

/// The light of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Effects {
    /// What the metaballs are made of.
    pub surface: Surface,
    /// Lamps, far away.
    pub lamps: Vec<Lamp>,
    /// Whether lamps cast shadows.
    pub shadows: bool,
    /// Occlusion of the surroundings' light. Without it a surface is lit by their mean.
    pub occlusion: Option<Occlusion>,
    /// Surfaces that a path may meet after the first: levels of reflection or refraction, or surfaces seen
    /// through others. The last one reflects, refracts or shows the floor and the environment alone: at 0
    /// that is environment mapping.
    pub bounces: u32,
    /// What the scene stands on, if anything.
    pub floor: Option<Floor>,
    /// What rays see that leave the scene.
    pub environment: Environment,
    /// Bands of brightness in cel shading; 0 for smooth shading.
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
    /// Phong's model in the scene's colours, seen through: a path goes straight on through the surface,
    /// where it enters the solid and where it leaves it, and each of these layers is lit from outside. What
    /// any number of them shadows or occludes has 1 − opacity of the light. On the CPU alone.
    SeeThrough {
        /// Share of each layer in what is seen through it, 0 to 1; at 1 the surface is opaque.
        opacity: f32,
    },
    /// A clear fluid.
    Fluid {
        /// Index of refraction, above 0; water has 1.33.
        refraction: f32,
        /// Of red, green and blue, per scene unit: e^(−absorption·length) passes.
        absorption: Vec3,
    },
}

/// A distant lamp: all of the scene sees it in the same direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    /// Towards the lamp, world space; any length but 0.
    pub toward: Vec3,
    /// Degrees from rim to rim, 0 to 180; 0 casts hard shadows. The sun has half a degree.
    pub diameter: f32,
    /// Linear light on a surface that faces it.
    pub color: Vec3,
}

/// Ambient occlusion: rays from each surface point, each of which brings the environment's light if it hits
/// nothing (Gourmel et al. 2010, figure 8 d: 64 of them).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Occlusion {
    /// Rays a surface point and sample.
    pub rays: u32,
    /// Their length, scene units: what lies beyond does not occlude. [`NO_LIMIT`](metaball_core::NO_LIMIT)
    /// for the whole scene.
    pub reach: f32,
}

/// A level floor, matt, seen from above; y points up. Lamps cast shadows on it, a fluid casts none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// The point below the scene, world space.
    pub middle: Vec3,
    /// The distance around it at which 1/e of the floor is left, the rest being horizon, scene units,
    /// above 0.
    pub reach: f32,
    /// Its colour, linear.
    pub color: Vec3,
    /// The side of its tiles, scene units; 0 for none.
    pub tile: f32,
}

/// What rays see that leave the scene.
#[derive(Debug, Clone, PartialEq)]
pub enum Environment {
    /// A generated clear sky over a studio floor; y points up.
    Sky,
    /// An image.
    Panorama(Panorama),
}

impl Effects {
    /// Whether the view's first hits are enough: no secondary ray is traced through the scene.
    pub fn end_at_first_surface(&self) -> bool {
        !self.is_fluid() && self.bounces == 0 && !self.need_shadow_rays()
    }

    /// Whether surfaces send shadow or occlusion rays.
    pub(crate) fn need_shadow_rays(&self) -> bool {
        self.occlusion_rays() > 0 || self.cast_shadows()
    }

    /// Whether lamps cast shadows. A fluid casts none, nor is anything occluded by it.
    pub(crate) fn cast_shadows(&self) -> bool {
        self.shadows && !self.lamps.is_empty() && !self.is_fluid()
    }

    /// Occlusion rays of a surface point.
    pub(crate) fn occlusion_rays(&self) -> u32 {
        let rays = self.occlusion.map_or(0, |occlusion| occlusion.rays);
        if self.is_fluid() { 0 } else { rays }
    }

    /// The share of light that the metaballs' surface lets pass straight on.
    pub(crate) fn transparency(&self) -> f32 {
        match self.surface {
            Surface::SeeThrough { opacity } => 1.0 - opacity.clamp(0.0, 1.0),
            Surface::Opaque { .. } | Surface::Fluid { .. } => 0.0,
        }
    }

    fn is_fluid(&self) -> bool {
        matches!(self.surface, Surface::Fluid { .. })
    }

    /// The queries that rays of these effects make.
    pub(crate) fn queries(&self) -> Vec<RayQuery> {
        if self.is_fluid() {
            return vec![RayQuery::FirstHit, RayQuery::Exit];
        }
        let shadow = self.need_shadow_rays().then_some(RayQuery::AnyHit);
        let onward = (self.transparency() > 0.0).then_some(RayQuery::Exit);
        [RayQuery::FirstHit].into_iter().chain(shadow).chain(onward).collect()
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
