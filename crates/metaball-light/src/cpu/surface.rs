//! What a path's own ray finds: light of the surroundings where it leaves the scene, and a surface where
//! it hits, or the floor where that is nearer.

use glam::Vec3;
use metaball_core::{NO_LIMIT, Ray, SurfaceHit, Verdict};

use super::floor::floor_clearance;
use super::lighting::Lighting;
use crate::path::{OUTSIDE, Path, WITHIN};

impl Lighting {
    /// Takes the answer to a path's own ray. `clearance` and `color` read those of a hit. False where the
    /// path has ended in the surroundings.
    pub(super) fn meet(
        &self,
        path: &mut Path,
        ray: &Ray,
        found: &SurfaceHit,
        clearance: impl FnOnce() -> f32,
        color: impl FnOnce() -> Vec3,
    ) -> bool {
        let hit = found.hit.most_likely();
        // A ray that starts beyond the surface that it seeks has met it; so has an eye in the solid.
        let is_met = hit.is_hit();
        let t_surface = if hit.verdict == Verdict::Hit { hit.t } else { 0.0 };
        let t_floor = self.floor_along(ray.origin, ray.direction);
        let is_on_floor = t_floor < if is_met { t_surface } else { NO_LIMIT };
        let t = if is_on_floor { t_floor } else { t_surface };
        path.on_floor = u32::from(is_on_floor);
        path.undecided += u32::from(found.hit.verdict == Verdict::Undecided);
        if path.stage == WITHIN {
            path.throughput *= self.transmittance(t);
        }
        path.position = ray.origin + t * ray.direction;
        if is_on_floor {
            path.position.y = self.settings.floor_middle.y;
            path.normal = Vec3::Y;
            path.clearance = floor_clearance(ray.origin, t, path.position);
            path.base = self.floor_base(path.position);
            let share = self.floor_presence(path.position);
            path.radiance += path.throughput * (1.0 - share) * self.horizon(ray.direction);
            path.throughput *= share;
        } else if is_met {
            path.normal = hit.normal;
            path.base = color();
            if self.is_left(path) {
                path.clearance = clearance();
            }
            let is_beyond = hit.verdict == Verdict::Inside;
            path.undecided += u32::from(is_beyond && path.bounces > 0 && path.stage == OUTSIDE);
        } else {
            path.radiance += path.throughput * self.environment.light(ray.direction);
            return false;
        }
        true
    }

    /// Whether rays may start at the path's surface.
    fn is_left(&self, path: &Path) -> bool {
        self.sends_shadow_rays() || path.bounces < self.settings.bounces
    }
}
