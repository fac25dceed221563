//! Where a ray crosses a box.

use glam::Vec3;
use metaball_core::{Aabb, Ray};

/// A ray prepared for boxes.
pub(super) struct Slabs {
    origin: Vec3,
    inverse: Vec3,
}

/// 1 + 2γ₃, γ₃ = 3w/(1 − 3w), w = 2⁻²⁴: after this no rounding of the three operations can make a
/// ray miss a box that it meets (Ize 2013, Robust BVH Ray Traversal).
const WIDER: f32 = 1.0 + 4e-7;

impl Slabs {
    pub(super) fn new(ray: &Ray) -> Self {
        Self { origin: ray.origin, inverse: ray.direction.recip() }
    }

    /// Where the ray enters and leaves the closed box, within 0 ≤ t ≤ `t_max`; `None` where it
    /// passes it by.
    ///
    /// A ray that lies in the plane of a face has 0·∞ = NaN there; `max` and `min` keep their other
    /// argument, which counts the face as part of the box.
    pub(super) fn crossing(&self, bounds: &Aabb, t_max: f32) -> Option<(f32, f32)> {
        let (mut enter, mut leave) = (0.0f32, t_max);
        for axis in 0..3 {
            let inverse = self.inverse[axis];
            let to_min = (bounds.min[axis] - self.origin[axis]) * inverse;
            let to_max = (bounds.max[axis] - self.origin[axis]) * inverse;
            let (near, far) =
                if inverse.is_sign_negative() { (to_max, to_min) } else { (to_min, to_max) };
            enter = enter.max(near);
            leave = leave.min(far * WIDER);
        }
        (enter <= leave).then_some((enter, leave))
    }
}
