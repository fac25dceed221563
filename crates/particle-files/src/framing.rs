//! Cameras that frame particles.

use glam::Vec3;
use metaball_core::{Aabb, Camera, Scene};

use crate::origin::middle;

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

/// The box around the balls that are not far out, and how many are: farther from the middle of all than
/// 64 times the median distance to it (with the median support radius). Among so many pixels what is
/// nearer would be a speck.
pub(crate) fn near_bounds(scene: &Scene) -> (Aabb, usize) {
    const FAR: f64 = 64.0;
    const SAMPLES: usize = 10_001;
    let supports = scene.supports();
    let samples = || supports.iter().step_by(supports.len().div_ceil(SAMPLES).max(1));
    let middle = middle(&samples().map(|support| support.center.as_dvec3()).collect::<Vec<_>>());
    let away = |center: Vec3| (center.as_dvec3() - middle).length();
    let median = |mut values: Vec<f64>| match values.len() {
        0 => 0.0,
        count => *values.select_nth_unstable_by(count / 2, f64::total_cmp).1,
    };
    let extent = median(samples().map(|support| away(support.center)).collect())
        + median(samples().map(|support| f64::from(support.radius)).collect());
    let mut outside = 0;
    let near = supports.iter().fold(Aabb::EMPTY, |bounds, support| {
        if away(support.center) > FAR * extent {
            outside += 1;
            return bounds;
        }
        bounds.union(&Aabb::around_sphere(support.center, support.radius))
    });
    (near, outside)
}

#[cfg(test)]
mod tests {
    use metaball_core::{Kernel, Metaball};

    use super::*;

    #[test]
    fn what_is_far_out_is_not_framed() {
        let bounds = |far: f32| {
            let at = |x: f32| Metaball::new(Vec3::X * x, 1.0);
            let balls = (0..5).map(|x| at(x as f32)).chain([at(far)]);
            near_bounds(&Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal"))
        };
        assert!((bounds(1000.0).0.max.x - 5.0).abs() < 1e-5);
        assert_eq!(bounds(1000.0).1, 1);
        assert!((bounds(100.0).0.max.x - 101.0).abs() < 1e-3);
        assert_eq!(bounds(100.0).1, 0);
        let empty = Scene::new([], Kernel::QUARTIC, 0.25).expect("legal");
        assert_eq!(near_bounds(&empty).1, 0);
    }
}
