//! Cameras that frame particles.

use glam::{DVec3, Vec3};
use metaball_core::{Aabb, Camera, Scene};

use crate::cell::Cell;
use crate::notes::{Notes, counted};
use crate::options::ReadOptions;
use crate::origin::middle;

/// From the middle of a file's particles to the eye: the front, a little from the right and above.
pub(crate) const FRONT: Vec3 = Vec3::new(0.4, 0.3, 1.0);

/// What is seen of a box around support spheres: they are larger than the surface.
const SEEN: f32 = 0.88;

/// A camera that shows the box from `direction` (from its middle to the eye), nearer than one that
/// is sure to show its corners: supports are larger than what is seen of them.
pub fn framing(bounds: &Aabb, direction: Vec3) -> Camera {
    if bounds.is_empty() {
        return Camera::framing(bounds, direction);
    }
    let (center, half) = (bounds.center(), 0.5 * SEEN * bounds.extent());
    Camera::framing(&Aabb { min: center - half, max: center + half }, direction)
}

/// The camera of particles that come without one, from the front, and how many it leaves out: those that are
/// far from the others.
pub fn own_camera(scene: &Scene) -> (Camera, usize) {
    let (near, outside) = near_bounds(scene);
    (framing(&near, FRONT), outside)
}

/// The box for a camera to frame: all balls, or those that are not far out; where the surface goes on
/// across the faces of the periodic cell, that cell.
pub(crate) fn framed(
    scene: &Scene,
    cell: Option<&Cell>,
    options: &ReadOptions,
    notes: &mut Notes,
) -> Aabb {
    if let (Some(cell), true) = (cell, options.periodic) {
        return bounds_of_cell(cell, scene.origin());
    }
    let bounds = scene.bounds();
    if options.frame_all {
        return bounds;
    }
    let (near, outside) = near_bounds(scene);
    if outside == 0 {
        return bounds;
    }
    notes.guessed(format!(
        "the camera leaves out {} far from the others (--frame-all shows all)",
        counted(outside, "particle")
    ));
    near
}

/// The box around a cell, in coordinates that begin at `origin`. All of a cell is seen.
fn bounds_of_cell(cell: &Cell, origin: DVec3) -> Aabb {
    let [a, b, c] = cell.edges;
    let middle = cell.origin - origin + 0.5 * (a + b + c);
    let half = 0.5 * (a.abs() + b.abs() + c.abs()) / f64::from(SEEN);
    Aabb { min: (middle - half).as_vec3(), max: (middle + half).as_vec3() }
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
