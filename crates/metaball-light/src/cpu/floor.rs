//! A level floor below the scene, matt, seen from above. Far from its middle it takes on the colour of
//! the horizon behind it, so that it has no edge.

use glam::{Vec3, Vec3Swizzles};
use metaball_core::NO_LIMIT;

use super::lighting::Lighting;

/// Every other tile has this share of the floor's colour.
const DARK_TILE: f32 = 0.55;

impl Lighting {
    /// Where a ray meets the floor; [`NO_LIMIT`] for nowhere.
    pub(super) fn floor_along(&self, origin: Vec3, direction: Vec3) -> f32 {
        let above = origin.y - self.settings.floor_middle.y;
        if self.settings.floor_reach == 0.0 || above <= 0.0 || direction.y >= 0.0 {
            return NO_LIMIT;
        }
        // A ray may be so level that the distance overflows.
        if above < 1e30 * -direction.y { above / -direction.y } else { NO_LIMIT }
    }

    /// What the floor fades into, far off along a ray.
    pub(super) fn horizon(&self, direction: Vec3) -> Vec3 {
        let level = direction.with_y(0.0);
        self.environment.light(level / level.length().max(1e-6))
    }

    /// Share of the floor in what is seen there, 0 to 1; the rest is horizon.
    pub(super) fn floor_presence(&self, position: Vec3) -> f32 {
        let away = (position - self.settings.floor_middle).xz() / self.settings.floor_reach;
        libm::expf(-away.length_squared().min(80.0))
    }

    /// The floor's colour, linear.
    pub(super) fn floor_base(&self, position: Vec3) -> Vec3 {
        let settings = &self.settings;
        if settings.tile == 0.0 {
            return settings.floor_color;
        }
        let tile = ((position - settings.floor_middle).xz() / settings.tile).floor();
        let is_odd = (tile.x + tile.y).abs() % 2.0 == 1.0;
        settings.floor_color * if is_odd { DARK_TILE } else { 1.0 }
    }

    /// What is seen along a ray that meets no surface: the floor as if nothing stood on it, or the
    /// surroundings.
    pub(super) fn beyond(&self, origin: Vec3, direction: Vec3) -> Vec3 {
        let t = self.floor_along(origin, direction);
        if t == NO_LIMIT {
            return self.environment.light(direction);
        }
        let lamps = self.lamps.iter().map(|lamp| lamp.color * lamp.toward.y.max(0.0));
        let light = self.environment.ambient(Vec3::Y) + lamps.sum::<Vec3>();
        let position = origin + t * direction;
        let floor = self.floor_base(position) * light;
        self.horizon(direction).lerp(floor, self.floor_presence(position))
    }
}

/// The clearance of a point on the floor: it errs by the roundings of its sum.
pub(super) fn floor_clearance(origin: Vec3, t: f32, position: Vec3) -> f32 {
    4.0 * f32::EPSILON * (origin.length() + 2.0 * t + position.length())
}
