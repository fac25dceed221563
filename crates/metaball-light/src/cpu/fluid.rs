//! A clear fluid, which reflects and refracts.

use glam::Vec3;
use metaball_core::{Ray, RayQuery};

use super::lighting::Lighting;
use super::secondary::Purpose;
use crate::path::{OUTSIDE, Path, WITHIN};

impl Lighting {
    /// Whether the surface is the clear fluid's.
    pub(super) fn is_clear(&self, path: &Path) -> bool {
        self.settings.refraction > 0.0 && path.on_floor == 0
    }

    /// What passes of light of a way through the fluid.
    pub(super) fn transmittance(&self, t: f32) -> Vec3 {
        Vec3::from((-self.settings.absorption * t).to_array().map(libm::expf))
    }

    /// A clear fluid reflects or refracts, by Fresnel's equations: one of the two at random, with its
    /// share of the light as probability. The path's next ray; none where it ends.
    pub(super) fn pass_through(
        &self,
        path: &mut Path,
        (pixel, sample): (u32, u32),
        direction: Vec3,
    ) -> Option<(Ray, RayQuery)> {
        let settings = &self.settings;
        // The normal on the side that the ray comes from.
        let leaves = path.stage == WITHIN;
        let facing = if leaves { -path.normal } else { path.normal };
        let ratio = if leaves { settings.refraction } else { 1.0 / settings.refraction };
        let cosine = (-direction.dot(facing)).clamp(0.0, 1.0);
        let sine_squared = ratio * ratio * (1.0 - cosine * cosine);
        let mut mirrored = 1.0;
        if sine_squared < 1.0 {
            let onward_cosine = (1.0 - sine_squared).sqrt();
            let across = (ratio * cosine - onward_cosine) / (ratio * cosine + onward_cosine);
            let along = (cosine - ratio * onward_cosine) / (cosine + ratio * onward_cosine);
            mirrored = 0.5 * (across * across + along * along);
        }
        let choice = self.points(path, pixel, Purpose::Choice).nth(sample).x;
        let is_mirrored = choice < mirrored;
        let onward =
            if is_mirrored { direction.reflect(facing) } else { direction.refract(facing, ratio) };
        let toward = onward.normalize();
        if path.bounces >= settings.bounces {
            // Beyond the last surface there are only the surroundings.
            path.radiance += path.throughput * self.beyond(path.position, toward);
            return None;
        }
        path.bounces += 1;
        let is_within = leaves == is_mirrored;
        path.stage = if is_within { WITHIN } else { OUTSIDE };
        let (side, query) =
            if is_within { (-1.0, RayQuery::Exit) } else { (1.0, RayQuery::FirstHit) };
        Some((Ray::new(path.start(side), toward), query))
    }
}
