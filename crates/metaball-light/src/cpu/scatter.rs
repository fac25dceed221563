//! What a surface does with light: it is lit along shadow and occlusion rays and mirrors or shows what lies
//! behind, or it is a clear fluid.

use glam::Vec3;
use metaball_core::{Ray, RayQuery};

use super::lighting::Lighting;
use crate::path::Path;

/// A shadow or occlusion ray, and the light that it brings if it hits nothing.
pub(super) enum Sent {
    Shadow(Ray, Vec3),
    Occlusion(Ray),
}

impl Lighting {
    /// Adds the light that needs no ray.
    pub(super) fn light_without_rays(&self, path: &mut Path, direction: Vec3) {
        if self.settings.occlusion_rays == 0 {
            self.add_unoccluded(path, direction);
        }
        if self.settings.shadows == 0 {
            self.add_unshadowed(path, direction);
        }
    }

    /// Whether surfaces send shadow or occlusion rays.
    pub(super) fn sends_shadow_rays(&self) -> bool {
        self.settings.shadows != 0 || self.settings.occlusion_rays > 0
    }

    /// Every shadow and occlusion ray of a surface point, in the order in which their light is added.
    pub(super) fn sent<'a>(
        &'a self,
        path: &'a Path,
        at: (u32, u32),
        direction: Vec3,
    ) -> impl Iterator<Item = Sent> + 'a {
        let to_lamps = if self.settings.shadows == 0 { 0 } else { self.lamps.len() };
        let shadow = move |lamp| {
            let (ray, light) = self.shadow_ray(path, at, direction, lamp)?;
            Some(Sent::Shadow(ray, light))
        };
        let occlusion = self.occlusion_rays(path, at).map(Sent::Occlusion);
        (0..to_lamps).filter_map(shadow).chain(occlusion)
    }

    /// The next ray of a path from a lit surface, off it or through it; none where the path ends.
    pub(super) fn onward(&self, path: &mut Path, direction: Vec3) -> Option<(Ray, RayQuery)> {
        if self.transparency > 0.0 {
            return self.pass_straight(path, direction);
        }
        self.mirror(path, direction).map(|next| (next, RayQuery::FirstHit))
    }
}
