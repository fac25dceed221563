//! Light of the surroundings, along occlusion rays where it is occluded.

use glam::Vec3;
use metaball_core::Ray;

use super::lighting::Lighting;
use super::sampling::{around, on_disc};
use super::secondary::Purpose;
use crate::path::Path;

impl Lighting {
    /// Adds the surroundings' mean, as if nothing occluded them.
    pub(super) fn add_unoccluded(&self, path: &mut Path, direction: Vec3) {
        let light = self.shaded(self.environment.ambient(path.normal));
        path.radiance += self.own_share(path, direction) * path.base * light;
    }

    /// One of the surface's occlusion rays, distributed by Lambert's cosine; none where it does not leave
    /// the surface.
    pub(super) fn occlusion_ray(
        &self,
        path: &Path,
        (pixel, sample): (u32, u32),
        ray: u32,
    ) -> Option<Ray> {
        let number = sample.wrapping_mul(self.settings.occlusion_rays).wrapping_add(ray);
        let square = self.point(path, pixel, Purpose::Sky, number);
        path.send(around(path.normal, on_disc(square)), self.settings.occlusion_reach)
    }

    /// The light that an occlusion ray brings if it hits nothing.
    pub(super) fn unoccluded(&self, path: &Path, direction: Vec3, ray: &Ray) -> Vec3 {
        let light = self.beyond(path.position, ray.direction);
        self.own_share(path, direction) * path.base * light / self.settings.occlusion_rays as f32
    }
}
