//! A generated environment: a clear sky over a studio floor, brightest at the horizon. The second axis
//! points to the zenith.

use super::super::power::power;
use glam::Vec3;

const ZENITH: Vec3 = Vec3::new(0.11, 0.23, 0.47);
const HORIZON: Vec3 = Vec3::new(0.66, 0.73, 0.80);
const FLOOR_NEAR: Vec3 = Vec3::new(0.090, 0.088, 0.085);

pub(super) fn light(direction: Vec3) -> Vec3 {
    let up = direction.y;
    // The horizon is soft: no edge to be seen through a lens.
    let share = ((up + 0.12) / 0.24).clamp(0.0, 1.0);
    let share = share * share * (3.0 - 2.0 * share);
    let sky = || HORIZON.lerp(ZENITH, power(up.clamp(0.0, 1.0), 0.55));
    let ground = || (0.65 * HORIZON).lerp(FLOOR_NEAR, power((-up).clamp(0.0, 1.0), 0.35));
    if share >= 1.0 {
        sky()
    } else if share <= 0.0 {
        ground()
    } else {
        ground().lerp(sky(), share)
    }
}

/// Of the sky it is 0.22 horizon and 0.78 zenith, of the ground 0.15 and 0.85, as the powers above weigh
/// them by the cosine.
pub(super) fn ambient(normal: Vec3) -> Vec3 {
    let (below, above) = (Vec3::new(0.141, 0.146, 0.150), Vec3::new(0.229, 0.338, 0.541));
    below.lerp(above, 0.5 + 0.5 * normal.y)
}
