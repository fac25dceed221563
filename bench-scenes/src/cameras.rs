//! Paths of cameras: around a scene, or up to it.

use glam::Vec3;
use metaball_core::{Aabb, Camera};
use particle_files::framing;

use crate::exact::turn;

/// The number of cameras around a scene.
const STEPS: u32 = 8;

/// Cameras like [`framing`]'s at equal steps around the vertical axis, that of `direction` first.
pub(crate) fn orbit(bounds: &Aabb, direction: Vec3) -> Vec<Camera> {
    (0..STEPS)
        .map(|step| {
            let turned = turn(f64::from(step) / f64::from(STEPS)).as_vec2();
            let (x, z) = (direction.x, direction.z);
            let direction =
                Vec3::new(turned.x * x - turned.y * z, direction.y, turned.y * x + turned.x * z);
            framing(bounds, direction)
        })
        .collect()
}

/// Three cameras along one direction: [`framing`]'s, and from a half and a quarter of its distance.
pub(crate) fn approach(bounds: &Aabb, direction: Vec3) -> Vec<Camera> {
    let center = bounds.center();
    let near = |share: f32| {
        let half = 0.5 * share * bounds.extent();
        framing(&Aabb { min: center - half, max: center + half }, direction)
    };
    vec![framing(bounds, direction), near(0.5), near(0.25)]
}
