//! Surfaces that are seen through: each layer stops its share of the light, and the path goes straight on
//! with the rest, so that layers are composited in the order in which the ray meets them (Porter and Duff
//! 1984, *over*, front to back).

use glam::Vec3;
use metaball_core::{Ray, RayQuery};

use super::lighting::Lighting;
use crate::path::{OUTSIDE, Path, WITHIN};

impl Lighting {
    /// The share of the path's light that its surface stops: all of it by the floor.
    pub(super) fn coverage(&self, path: &Path) -> f32 {
        if path.on_floor == 1 { 1.0 } else { 1.0 - self.transparency }
    }

    /// The share of a shadow or occlusion ray's light that arrives: what any surface lets pass, however
    /// many there are, since the ray tells no more.
    pub(super) fn arriving(&self, is_hit: bool) -> f32 {
        if is_hit { self.transparency } else { 1.0 }
    }

    /// Continues the path behind its surface, into the solid or out of it, or ends it.
    pub(super) fn pass_straight(
        &self,
        path: &mut Path,
        direction: Vec3,
    ) -> Option<(Ray, RayQuery)> {
        if path.on_floor == 1 {
            return None;
        }
        path.throughput *= self.transparency;
        if path.bounces >= self.settings.bounces {
            // Behind the last surface there are only the surroundings.
            path.radiance += path.throughput * self.beyond(path.position, direction);
            return None;
        }
        path.bounces += 1;
        let enters = path.stage == OUTSIDE;
        path.stage = if enters { WITHIN } else { OUTSIDE };
        let (side, query) = if enters { (-1.0, RayQuery::Exit) } else { (1.0, RayQuery::FirstHit) };
        Some((Ray::new(path.start(side), direction), query))
    }
}
