//! Secondary rays: where they start, and for which purposes they take random numbers.

use glam::Vec3;
use metaball_core::Ray;

use super::lighting::Lighting;
use super::sampling::Points;
use crate::path::Path;

/// Why a path takes random numbers; each of its surfaces has its own. 0 is the point in the pixel.
#[derive(Debug, Clone, Copy)]
#[repr(u32)]
pub(super) enum Purpose {
    Lamp = 1,
    Sky = 2,
    Choice = 3,
}

impl Lighting {
    /// A path's points in the unit square, at its surface and for a purpose.
    pub(super) fn points(&self, path: &Path, pixel: u32, purpose: Purpose) -> Points {
        let purpose = 4u32.wrapping_mul(path.bounces) + purpose as u32;
        Points::new(self.settings.seed, pixel, purpose)
    }
}

impl Path {
    /// The start of a secondary ray: off the surface by its clearance, outside (1) or inside (−1).
    pub(super) fn start(&self, side: f32) -> Vec3 {
        self.position + side * self.clearance * self.normal
    }

    /// A shadow or occlusion ray; none below the surface's horizon.
    pub(super) fn send(&self, toward: Vec3, reach: f32) -> Option<Ray> {
        let leaves = toward.dot(self.normal) > 0.0;
        leaves.then(|| Ray { t_max: reach, ..Ray::new(self.start(1.0), toward) })
    }
}
