//! The pass that makes rays.

use std::sync::Arc;

use glam::Vec3;

use super::sphere::{HEIGHT, Sphere, WIDTH, hits, scene, targets, view};
use crate::gpu::{Frame, Gpu};
use crate::{Camera, NO_LIMIT, Ray, Verdict, View};

fn rays(gpu: &Gpu, view: &View) -> Vec<Ray> {
    let targets = targets(gpu, &scene(), false);
    let frame = Frame::begin(gpu, &targets, view).expect("begins");
    frame.finish().expect("finishes");
    targets.read_rays(gpu, view).expect("reads")
}

/// With u = 2⁻²⁴, half_pixel and the products err by u each, so a term x·right by 3u|x|, the two sums
/// by u of their size: at most 5u·m for m = 1 + |x| + |y|. The vector is no shorter than 1, so its
/// direction errs by no more; the stored axes are part of what is compared with. Division by the
/// length adds 2u for the dot product's and 2.5 + 2.5 units (each 2u) that WGSL allows square root and
/// division: 12u of at most 1. A mistake of one pixel would be 2·half_pixel/m, here above 0.01.
#[test]
fn directions_are_those_of_the_exact_camera() {
    let Some(gpu) = Gpu::for_test() else { return };
    for degrees in [1.0, 38.0, 150.0] {
        let eye = Vec3::new(3.0, -7.0, 1e4);
        let camera = Camera::look_at(eye, Vec3::ONE, Vec3::Y, degrees).expect("legal");
        let view = View::new(camera, WIDTH, HEIGHT).expect("legal");
        let rays = rays(&gpu, &view);
        assert_eq!(rays.len(), view.pixels());

        let half_height = f64::from(camera.half_height());
        let reach = 1.0 + half_height * (1.0 + f64::from(WIDTH) / f64::from(HEIGHT));
        let tolerance = (5.0 * reach + 12.0) * 0.5f64.powi(24);
        for (index, ray) in rays.iter().enumerate() {
            let (column, row) = (index as u32 % WIDTH, index as u32 / WIDTH);
            let exact = camera.exact_direction(column, row, WIDTH, HEIGHT);
            let error = (ray.direction.as_dvec3() - exact).abs().max_element();
            assert!(error <= tolerance, "pixel {index} at {degrees}°: {error:e} > {tolerance:e}");
            assert_eq!((ray.origin, ray.t_max), (eye, NO_LIMIT));
        }
    }
}

#[test]
fn the_opaque_scene_ends_rays() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut distances = vec![f32::INFINITY; view().pixels()];
    distances[3] = 0.0;
    distances[7] = 1.5;
    let stopped = view().with_opaque_distance(Arc::from(distances)).expect("legal");
    let rays = rays(&gpu, &stopped);
    assert_eq!((rays[3].t_max, rays[7].t_max), (0.0, 1.5));
    assert_eq!(rays.iter().filter(|ray| ray.t_max == NO_LIMIT).count(), view().pixels() - 2);
}

#[test]
fn the_opaque_scene_hides_the_surface() {
    let Some(gpu) = Gpu::for_test() else { return };
    // A wall at 4.5, where the unit sphere seen from 5 begins at 4: its middle shows, its rim not.
    let wall = Arc::from(vec![4.5; view().pixels()]);
    let walled = view().with_opaque_distance(wall).expect("legal");
    let free = hits(&gpu, &mut Sphere::new(), &scene(), &view());
    let stopped = hits(&gpu, &mut Sphere::new(), &scene(), &walled);
    for (free, stopped) in free.iter().zip(&stopped) {
        let shows = free.verdict == Verdict::Hit && free.t <= 4.5;
        assert_eq!(stopped.verdict == Verdict::Hit, shows);
    }
    let count = |hits: &[crate::Hit]| hits.iter().filter(|hit| hit.is_hit()).count();
    assert!(0 < count(&stopped) && count(&stopped) < count(&free));
}
