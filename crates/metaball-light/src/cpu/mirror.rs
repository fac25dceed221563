//! A mirror: the share of light that it reflects, and the path that continues along the reflection.

use glam::Vec3;
use metaball_core::Ray;

use super::lighting::Lighting;
use crate::path::{OUTSIDE, Path};

impl Lighting {
    /// The share of light that is mirrored: Schlick's approximation of Fresnel's equations (1994). None
    /// by the floor, and none inside the solid.
    fn mirror_share(&self, path: &Path, direction: Vec3) -> f32 {
        let cosine = -direction.dot(path.normal);
        if path.on_floor == 1 || self.settings.reflectivity == 0.0 || cosine <= 0.0 {
            return 0.0;
        }
        let grazing = 1.0 - cosine.min(1.0);
        let square = grazing * grazing;
        let fifth = square * square * grazing;
        fifth * (1.0 - self.settings.reflectivity) + self.settings.reflectivity
    }

    /// The share that the surface itself scatters to the eye.
    pub(super) fn own_share(&self, path: &Path, direction: Vec3) -> Vec3 {
        path.throughput * (1.0 - self.mirror_share(path, direction)) * self.coverage(path)
    }

    /// Continues the path along the reflection, or ends it.
    pub(super) fn mirror(&self, path: &mut Path, direction: Vec3) -> Option<Ray> {
        let share = self.mirror_share(path, direction);
        path.throughput *= share;
        if share == 0.0 {
            return None;
        }
        let toward = direction.reflect(path.normal).normalize();
        if path.bounces >= self.settings.bounces {
            // The last surface of a path mirrors the surroundings alone.
            path.radiance += path.throughput * self.beyond(path.position, toward);
            return None;
        }
        path.bounces += 1;
        path.stage = OUTSIDE;
        Some(Ray::new(path.start(1.0), toward))
    }
}
