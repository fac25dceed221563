//! Cameras that frame particles.

use glam::Vec3;
use metaball_core::{Aabb, Camera};

/// From the middle of a file's particles to the eye: the front, a little from the right and above.
pub(crate) const FRONT: Vec3 = Vec3::new(0.4, 0.3, 1.0);

/// A camera that shows the box from `direction` (from its middle to the eye), nearer than one that
/// is sure to show its corners: supports are larger than what is seen of them.
pub fn framing(bounds: &Aabb, direction: Vec3) -> Camera {
    const SEEN: f32 = 0.88;
    if bounds.is_empty() {
        return Camera::framing(bounds, direction);
    }
    let (center, half) = (bounds.center(), 0.5 * SEEN * bounds.extent());
    Camera::framing(&Aabb { min: center - half, max: center + half }, direction)
}
