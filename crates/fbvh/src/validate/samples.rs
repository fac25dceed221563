//! The field at sample points and overlaps of supports, in f64 and without the tree.

use glam::{DVec3, Vec3};
use metaball_core::{Aabb, Support};

use crate::Field;

/// Overlaps smaller than this part of the radii are rounding.
pub(super) const ROUNDING: f64 = 1e-6;

/// The field of some balls at a point, f64.
pub(super) fn value(field: &impl Field, balls: &[u32], point: DVec3) -> f64 {
    balls.iter().fold(0.0, |sum, &ball| {
        let Support { center, radius } = field.support(ball as usize);
        let squared_ratio =
            (center.as_dvec3() - point).length_squared() / f64::from(radius).powi(2);
        sum + f64::from(field.strength(ball as usize)) * field.kernel().value(squared_ratio)
    })
}

/// Whether two supports overlap by more than rounding.
pub(super) fn overlap(a: &Support, b: &Support) -> bool {
    let reach = (f64::from(a.radius) + f64::from(b.radius)) * (1.0 - ROUNDING);
    a.center.as_dvec3().distance_squared(b.center.as_dvec3()) < reach * reach
}

/// The squared distance of a point from a closed box.
pub(super) fn squared_distance(point: Vec3, bounds: &Aabb) -> f64 {
    let point = point.as_dvec3();
    let nearest = point.max(bounds.min.as_dvec3()).min(bounds.max.as_dvec3());
    point.distance_squared(nearest)
}

/// Points of a closed box, its corners among them.
pub(super) fn lattice(bounds: &Aabb) -> impl Iterator<Item = DVec3> + use<> {
    const STEPS: usize = 4;
    let (low, side) = (bounds.min.as_dvec3(), bounds.max.as_dvec3() - bounds.min.as_dvec3());
    (0..(STEPS + 1).pow(3)).map(move |at| {
        let step = |divisor: usize| (at / divisor % (STEPS + 1)) as f64 / STEPS as f64;
        low + side * DVec3::new(step(1), step(STEPS + 1), step((STEPS + 1).pow(2)))
    })
}
