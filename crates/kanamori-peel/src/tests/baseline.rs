//! The CPU baseline against the oracle.

use glam::Vec3;
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Camera, Hit, HostMethod, Kernel, Metaball, Ray, Scene, Verdict};

use super::random::Random;
use crate::baseline::{Baseline, Method, Refusal};

fn scene(kernel: Kernel, balls: usize, spread: f32) -> Scene {
    let mut random = Random::new(7);
    let balls: Vec<_> = (0..balls)
        .map(|_| {
            let [x, y, z] = [(); 3].map(|()| spread * (random.unit() - 0.5));
            let strength = 0.5 + random.unit();
            Metaball { center: Vec3::new(x, y, z), radius: 0.3 + 0.7 * random.unit(), strength }
        })
        .collect();
    Scene::new(balls, kernel, 0.4).expect("legal")
}

fn rays(distance: f32) -> Vec<Ray> {
    let eye = Vec3::new(0.0, 0.1, distance);
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 40.0).expect("legal");
    let pixels = (0..48).flat_map(|row| (0..64).map(move |column| (column, row)));
    let direction = |(column, row)| camera.exact_direction(column, row, 64, 48).as_vec3();
    pixels.map(|pixel| Ray::new(eye, direction(pixel))).collect()
}

/// Right for every clear ray, wherever the eye is: up to half the threshold of an interval of at
/// most two radii, and the rounding of t.
fn assert_right(scene: &Scene, rays: &[Ray], least_hits: usize) {
    let traced = Baseline::build(scene, 1e-3).expect("a polynomial").trace(rays);
    let oracle = Oracle::new(scene);
    let truths = oracle.first_hits(rays);
    let mut hits = 0;
    for ((truth, hit), ray) in truths.iter().zip(&traced.hits).zip(rays) {
        if truth.is_ambiguous() {
            continue;
        }
        assert_eq!(hit.verdict, truth.verdict, "{ray:?}: {hit:?} against {truth:?}");
        if hit.verdict == Verdict::Hit {
            let allowed = 1e-3 + f64::from(f32::EPSILON) * truth.t;
            assert!((f64::from(hit.t) - truth.t).abs() <= allowed, "{hit:?} against {truth:?}");
            let point = ray.origin.as_dvec3() + f64::from(hit.t) * ray.direction.as_dvec3();
            let off = hit.normal.as_dvec3().distance(oracle.normal(point));
            assert!(off < 1e-6, "a normal off by {off}: {hit:?} against {truth:?}");
            hits += 1;
        }
    }
    assert!(hits >= least_hits, "{hits} hits");
}

#[test]
fn sums_of_every_polynomial_kernel_are_right() {
    for kernel in Kernel::all().filter(|kernel| kernel.coefficients().is_some()) {
        assert_right(&scene(kernel, 120, 5.0), &rays(8.0), 500);
    }
}

/// Section 7's special cases do not exist here: neither large overlap nor coincident points.
#[test]
fn overlap_and_coincident_points_are_right() {
    assert_right(&scene(Kernel::Wyvill, 150, 0.2), &rays(4.0), 300);
    let coincident = Scene::new(vec![Metaball::new(Vec3::ZERO, 1.0); 65], Kernel::QUARTIC, 0.25);
    assert_right(&coincident.expect("legal"), &rays(4.0), 300);
}

#[test]
fn the_eye_may_be_among_the_balls_and_rays_may_start_late_and_end() {
    let scene = scene(Kernel::QUARTIC, 120, 5.0);
    assert_right(&scene, &rays(1.0), 0);
    let baseline = Baseline::build(&scene, 1e-3).expect("a polynomial");
    let short: Vec<_> = rays(8.0).into_iter().map(|ray| Ray { t_max: 1.0, ..ray }).collect();
    assert!(baseline.trace(&short).hits.iter().all(|hit| *hit == Hit::MISS));
    // From the middle of the scene on, and from behind it; the rays' origins are no starts.
    for t_min in [8.0, 14.0] {
        let late: Vec<_> = rays(8.0).into_iter().map(|ray| Ray { t_min, ..ray }).collect();
        assert_right(&scene, &late, 0);
        let truths = Oracle::new(&scene).first_hits(&rays(8.0));
        let traced = baseline.trace(&late);
        let differs = |(truth, hit): (&Truth, &Hit)| (truth.t - f64::from(hit.t)).abs() > 1e-2;
        assert!(truths.iter().zip(&traced.hits).filter(|pair| differs(*pair)).count() > 100);
    }
}

#[test]
fn nothing_is_a_legal_scene_and_perlin_is_refused() {
    let empty = Scene::new([], Kernel::QUARTIC, 0.4).expect("legal");
    let traced = Baseline::build(&empty, 1e-3).expect("a polynomial").trace(&rays(3.0));
    assert!(traced.hits.iter().all(|hit| *hit == Hit::MISS));
    let perlin = scene(Kernel::Perlin, 3, 1.0);
    let refusal = Baseline::build(&perlin, 1e-3).expect_err("refused");
    assert_eq!(refusal, Refusal::NoPolynomial { found: Kernel::Perlin });
}

/// Among other methods it finds the same, under its name.
#[test]
fn as_a_method_it_is_the_same() {
    let scene = scene(Kernel::Wyvill, 120, 5.0);
    let method = Method::new("kanamori-cpu", 1e-3);
    let tracer = method.build(&scene).expect("a polynomial");
    let traced = Baseline::build(&scene, 1e-3).expect("a polynomial").trace(&rays(8.0));
    assert_eq!(tracer.picture_hits(&rays(8.0), 64), traced.hits);
    assert!(tracer.bytes() > 120 * size_of::<Metaball>() as u64);
    let perlin = scene.clone().with_kernel(Kernel::Perlin);
    let refusal = method.build(&perlin).err().expect("refused");
    assert!(refusal.to_string().starts_with("method kanamori-cpu: needed a kernel that is"));
}

/// Finer clipping takes more iterations and nothing else.
#[test]
fn work_is_counted() {
    let scene = scene(Kernel::Wyvill, 120, 5.0);
    let count =
        |threshold| Baseline::build(&scene, threshold).expect("a polynomial").trace(&rays(8.0));
    let (coarse, fine) = (count(1e-2), count(1e-6));
    assert!(coarse.searches > 1000 && coarse.iterations < fine.iterations);
    assert!(fine.most_iterations > 2 && fine.most_iterations < 100, "{}", fine.most_iterations);
}
