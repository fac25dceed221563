//! Cameras that frame a scene.

use glam::Vec3;
use metaball_core::{Aabb, Camera};

use crate::exact::turn;

/// The number of cameras on a walk around a scene.
const STEPS: u32 = 8;

/// A camera that shows the box from `direction` (from its middle to the eye), nearer than one that
/// is sure to show its corners: supports are larger than what is seen of them.
pub(crate) fn framing(bounds: &Aabb, direction: Vec3) -> Camera {
    const SEEN: f32 = 0.88;
    if bounds.is_empty() {
        return Camera::framing(bounds, direction);
    }
    let (center, half) = (bounds.center(), 0.5 * SEEN * bounds.extent());
    Camera::framing(&Aabb { min: center - half, max: center + half }, direction)
}

/// Cameras like [`framing`]'s at equal steps around the vertical axis, that of `direction` first.
pub(crate) fn walk_around(bounds: &Aabb, direction: Vec3) -> Vec<Camera> {
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
pub(crate) fn come_near(bounds: &Aabb, direction: Vec3) -> Vec<Camera> {
    let center = bounds.center();
    let near = |share: f32| {
        let half = 0.5 * share * bounds.extent();
        framing(&Aabb { min: center - half, max: center + half }, direction)
    };
    vec![framing(bounds, direction), near(0.5), near(0.25)]
}
