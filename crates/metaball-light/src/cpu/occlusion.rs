//! Light of the surroundings, along occlusion rays where it is occluded.

use glam::Vec3;
use metaball_core::Ray;

use super::lighting::Lighting;
use super::sampling::{Frame, on_disc};
use super::secondary::Purpose;
use crate::path::Path;

impl Lighting {
    /// Adds the surroundings' mean, as if nothing occluded them.
    pub(super) fn add_unoccluded(&self, path: &mut Path, direction: Vec3) {
        let light = self.shaded(self.environment.ambient(path.normal));
        path.radiance += self.own_share(path, direction) * path.base * light;
    }

    /// The surface's occlusion rays, distributed by Lambert's cosine, but for those that do not leave it.
    pub(super) fn occlusion_rays<'a>(
        &self,
        path: &'a Path,
        (pixel, sample): (u32, u32),
    ) -> impl Iterator<Item = Ray> + use<'a> {
        let (rays, reach) = (self.settings.occlusion_rays, self.settings.occlusion_reach);
        let (points, frame) = (self.points(path, pixel, Purpose::Sky), Frame::around(path.normal));
        (0..rays).filter_map(move |ray| {
            let square = points.nth(sample.wrapping_mul(rays).wrapping_add(ray));
            path.send(frame.over(on_disc(square)), reach)
        })
    }

    /// The light that an occlusion ray brings if it hits nothing.
    pub(super) fn unoccluded(&self, path: &Path, direction: Vec3, ray: &Ray) -> Vec3 {
        let light = self.beyond(path.position, ray.direction);
        self.own_share(path, direction) * path.base * light / self.settings.occlusion_rays as f32
    }
}
