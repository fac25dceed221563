//! Where a ray crosses a box.

use glam::Vec3;
use metaball_core::{Aabb, Ray};

/// A ray prepared for tests against boxes.
pub(super) struct Slabs {
    origin: Vec3,
    inverse: Vec3,
    t_min: f32,
    /// Per axis: whether the ray goes towards −∞.
    is_negative: [bool; 3],
}

/// 1 + 2γ₃, γ₃ = 3w/(1 − 3w), w = 2⁻²⁴: after this no rounding of the three operations can make a
/// ray miss a box that it meets (Ize 2013, Robust BVH Ray Traversal).
pub(super) const WIDER: f32 = 1.0 + 4e-7;

impl Slabs {
    pub(super) fn new(ray: &Ray) -> Self {
        let inverse = ray.direction.recip();
        let is_negative = inverse.to_array().map(f32::is_sign_negative);
        Self { origin: ray.origin, inverse, t_min: ray.t_min, is_negative }
    }

    /// Where the ray enters and leaves the closed box, within the ray's `t_min` ≤ t ≤ `t_max`;
    /// `None` where it
    /// misses it.
    ///
    /// A ray that lies in the plane of a face has 0·∞ = NaN there; no comparison with it holds,
    /// which counts the face as part of the box.
    #[inline]
    pub(super) fn crossing(&self, bounds: &Aabb, t_max: f32) -> Option<(f32, f32)> {
        let (mut enter, mut leave) = (self.t_min, t_max);
        for axis in 0..3 {
            let faces = [bounds.min[axis], bounds.max[axis]];
            let first = usize::from(self.is_negative[axis]);
            let near = (faces[first] - self.origin[axis]) * self.inverse[axis];
            let far = (faces[1 - first] - self.origin[axis]) * self.inverse[axis] * WIDER;
            enter = if near > enter { near } else { enter };
            leave = if far < leave { far } else { leave };
        }
        (enter <= leave).then_some((enter, leave))
    }
}
