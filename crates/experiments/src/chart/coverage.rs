//! What of a picture a scene covers: the share of its pixels that hit, how many supports a ray meets, and
//! the threshold for a wanted share.

use bench_scenes::BenchScene;
use fbvh::{Options, Tracer, Tree};
use metaball_core::{Camera, Ray, Scene};
use rayon::prelude::*;

/// Rays that a share is taken over, across and down: enough to know it to some 2 %.
const SAMPLE: (u32, u32) = (96, 72);

/// A threshold is changed at most so often: each step halves what is left of its range.
const STEPS: usize = 24;

/// Shares of hits that differ by less than this part of themselves are the same.
const SAME_SHARE: f64 = 0.02;

/// Mean number of supports that a ray of the camera meets: depth complexity.
pub(super) fn supports_per_ray(scene: &Scene, camera: &Camera) -> f64 {
    let rays = rays(camera);
    let met = |ray: &Ray| {
        let meets = |center: glam::Vec3, radius: f32| {
            let offset = (center - ray.origin).as_dvec3();
            let direction = ray.direction.as_dvec3();
            let along = offset.dot(direction).max(0.0) / direction.length_squared();
            (offset - along * direction).length_squared() < f64::from(radius) * f64::from(radius)
        };
        scene.supports().iter().filter(|ball| meets(ball.center, ball.radius)).count()
    };
    let total: usize = rays.par_iter().map(met).sum();
    total as f64 / rays.len() as f64
}

/// The share of the camera's rays that hit the scene.
///
/// # Errors
/// When the scene has no tree.
pub(super) fn hit_share(scene: &Scene, camera: &Camera) -> anyhow::Result<f64> {
    let tree = Tree::build(scene, &Options::certified())?;
    let tracer = Tracer::new(&tree, scene);
    let hits = tracer.first_hits(&rays(camera));
    Ok(hits.iter().filter(|hit| hit.is_hit()).count() as f64 / hits.len() as f64)
}

/// The scene with the camera, and with the threshold at which that share of its rays hit.
///
/// # Errors
/// When no threshold does that.
pub(super) fn with_hit_share(
    mut bench: BenchScene,
    camera: Camera,
    share: f64,
) -> anyhow::Result<BenchScene> {
    bench.camera = camera;
    bench.path.clear();
    // Nothing of the field lies above what all balls add at their centres.
    let (mut low, mut high) = (0.0f32, bench.scene.balls().map(|ball| ball.strength).sum::<f32>());
    for _ in 0..STEPS {
        let threshold = 0.5 * (low + high);
        bench.scene = bench.scene.with_threshold(threshold)?;
        let found = hit_share(&bench.scene, &camera)?;
        if (found - share).abs() <= SAME_SHARE * share {
            return Ok(bench);
        }
        *(if found > share { &mut low } else { &mut high }) = threshold;
    }
    anyhow::bail!("scene {}: no threshold makes {share:.3} of its rays hit", bench.name)
}

fn rays(camera: &Camera) -> Vec<Ray> {
    let (width, height) = SAMPLE;
    let ray = |pixel: u32| {
        let direction = camera.exact_direction(pixel % width, pixel / width, width, height);
        Ray::new(camera.eye(), direction.as_vec3())
    };
    (0..width * height).map(ray).collect()
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};

    use super::*;

    #[test]
    fn density_grows_and_the_picture_stays() {
        let load = |spec| load(spec, &Overrides::default()).expect("loads");
        let sparse = load("scattered:200:3");
        let share = hit_share(&sparse.scene, &sparse.camera).expect("built");
        let met = supports_per_ray(&sparse.scene, &sparse.camera);
        assert!((0.05..0.95).contains(&share) && met > 0.5, "{share} {met}");

        let dense = with_hit_share(load("scattered:200:30"), sparse.camera, share).expect("found");
        let again = hit_share(&dense.scene, &dense.camera).expect("built");
        assert!((again - share).abs() <= 0.05 * share, "{again} for {share}");
        assert!(supports_per_ray(&dense.scene, &dense.camera) > 2.0 * met);
        assert_eq!(dense.camera, sparse.camera);
    }

    #[test]
    fn an_impossible_share_is_refused() {
        let bench = load("scattered:200:3", &Overrides::default()).expect("loads");
        let camera = bench.camera;
        let error = with_hit_share(bench, camera, 2.0).expect_err("more than all");
        assert!(error.to_string().contains("scattered:200:3"), "{error}");
    }
}
