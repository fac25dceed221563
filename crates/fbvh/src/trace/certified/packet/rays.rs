//! Eight rays side by side.

use metaball_core::{Aabb, Ray};

use super::super::lanes::{Lanes, WIDTH, array_of};
use super::super::ranges::UNIT;
use crate::trace::slabs::WIDER;

/// Rays that go the same way along each axis, and so through the same order of leaves. Lanes that
/// have no ray repeat the first one.
pub(super) struct Packet {
    pub(super) origin: [Lanes<f32>; 3],
    pub(super) direction: [Lanes<f32>; 3],
    inverse: [Lanes<f32>; 3],
    pub(super) t_min: Lanes<f32>,
    pub(super) t_max: Lanes<f32>,
    /// Per axis: whether the rays go towards −∞.
    pub(super) is_negative: [bool; 3],
}

/// What leaves need to know of a packet in f64: most packets that miss everything reach none.
pub(super) struct ExactPacket {
    pub(super) origin: [Lanes<f64>; 3],
    inverse: [Lanes<f64>; 3],
    /// The origins' distance from the world's, scene units.
    pub(super) distance: Lanes<f32>,
    /// Length of the directions, and its square: unit to 1e-7 only.
    pub(super) length: Lanes<f32>,
    pub(super) square: Lanes<f64>,
}

impl Packet {
    #[inline(always)]
    pub(super) fn new(rays: &[Ray]) -> Self {
        let mut all = [rays[0]; WIDTH];
        all[..rays.len()].copy_from_slice(rays);
        let all = Lanes(all);
        let direction: [_; 3] = array_of(|axis| all.map(|ray| ray.direction[axis]));
        Self {
            origin: array_of(|axis| all.map(|ray| ray.origin[axis])),
            direction,
            inverse: array_of(|axis| direction[axis].map(f32::recip)),
            t_min: all.map(|ray| ray.t_min),
            t_max: all.map(|ray| ray.t_max),
            is_negative: is_negative(&rays[0]),
        }
    }

    #[inline(always)]
    pub(super) fn exact(&self) -> ExactPacket {
        let direction: [_; 3] = array_of(|axis| self.direction[axis].map(f64::from));
        let [x, y, z] = direction;
        ExactPacket {
            origin: array_of(|axis| self.origin[axis].map(f64::from)),
            inverse: array_of(|axis| direction[axis].map(f64::recip)),
            distance: length_squared(self.origin).sqrt(),
            length: length_squared(self.direction).sqrt(),
            square: x * x + y * y + z * z,
        }
    }

    /// The lanes whose rays cross the closed box, by the operations of
    /// [`Slabs::crossing`](crate::trace::slabs::Slabs::crossing).
    #[inline(always)]
    pub(super) fn crossing(&self, min: &[f32; 3], max: &[f32; 3]) -> u32 {
        let (mut enter, mut leave) = (self.t_min, self.t_max);
        for axis in 0..3 {
            let (near, far) = if self.is_negative[axis] { (max, min) } else { (min, max) };
            let to = |face: f32| (Lanes::splat(face) - self.origin[axis]) * self.inverse[axis];
            enter = to(near[axis]).max(enter);
            leave = (to(far[axis]) * WIDER).min(leave);
        }
        enter.is_at_most(leave).bits()
    }

    /// The rays' intervals in a box, widened by rounding; those that miss it start after the end. By
    /// the operations of [`RayState::interval`](super::super::ray::RayState::interval).
    #[inline(always)]
    pub(super) fn interval(&self, exact: &ExactPacket, bounds: &Aabb) -> (Lanes<f64>, Lanes<f64>) {
        let (mut start, mut end) = (self.t_min.map(f64::from), self.t_max.map(f64::from));
        for axis in 0..3 {
            let (min, max) = (bounds.min[axis], bounds.max[axis]);
            let (near, far) = if self.is_negative[axis] { (max, min) } else { (min, max) };
            let to = |face: f32| {
                (Lanes::splat(f64::from(face)) - exact.origin[axis]) * exact.inverse[axis]
            };
            start = to(near).map(|t| t - 6.0 * UNIT * t.abs()).max(start);
            end = to(far).map(|t| t + 6.0 * UNIT * t.abs()).min(end);
        }
        (start, end)
    }
}

/// Per axis: whether the ray goes towards −∞.
#[inline(always)]
pub(super) fn is_negative(ray: &Ray) -> [bool; 3] {
    array_of(|axis| ray.direction[axis].is_sign_negative())
}

#[inline(always)]
pub(super) fn length_squared([x, y, z]: [Lanes<f32>; 3]) -> Lanes<f32> {
    x * x + y * y + z * z
}
