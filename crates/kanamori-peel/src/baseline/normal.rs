//! The normal at a hit, from the chords that hold it.

use glam::{DVec3, Vec3};
use metaball_core::{Ray, Scene};

use super::chord::Chord;

/// The unit vector against the field's gradient at `t`, world space; against the ray where the gradient
/// is zero.
pub(super) fn normal(scene: &Scene, chords: &[Chord], ray: &Ray, t: f32) -> Vec3 {
    let kernel = scene.kernel();
    let point = ray.origin.as_dvec3() + f64::from(t) * ray.direction.as_dvec3();
    let outward = chords.iter().fold(DVec3::ZERO, |outward, chord| {
        let support = scene.supports()[chord.ball as usize];
        let offset = point - support.center.as_dvec3();
        let inverse_square = f64::from(support.radius).powi(-2);
        let slope = kernel.slope(offset.length_squared() * inverse_square);
        outward - chord.strength * slope * inverse_square * offset
    });
    outward.try_normalize().map_or_else(|| (-ray.direction).normalize_or_zero(), DVec3::as_vec3)
}
