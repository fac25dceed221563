//! Lists, arrays and cubics at their limits.

use glam::{DVec3, Vec3};
use illes_fraglist::{Gather, LIST_CAPACITY, Options, Piece, Renderer};
use metaball_core::gpu::{Gpu, IsoRenderer, Targets, render};
use metaball_core::{Camera, Hit, Kernel, Metaball, Ray, Scene, Verdict, View};

/// A drawn picture.
struct Picture {
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    nodes: u32,
    core_hits: u32,
}

fn draw(gpu: &Gpu, scene: &Scene, view: &View, options: Options) -> Picture {
    let mut renderer = Renderer::new("illes", options, false);
    renderer.build(gpu, scene).expect("builds");
    let targets =
        Targets::new(gpu, view.width(), view.height(), false, false).expect("small targets");
    render(gpu, &mut renderer, &targets, view).expect("draws");
    let stats = renderer.list_stats(gpu).expect("readable").expect("a frame was drawn");
    Picture {
        rays: targets.read_rays(gpu, view).expect("readable"),
        hits: targets.read_hits(gpu).expect("readable"),
        nodes: stats.nodes,
        core_hits: stats.core_hits,
    }
}

/// A view of the origin from so far that a height of `height` fills the picture.
fn view(distance: f32, height: f32) -> View {
    let fov = 2.0 * (0.5 * height / distance).atan().to_degrees();
    let eye = Vec3::new(0.0, 0.0, distance);
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, fov).expect("a legal camera");
    View::new(camera, 40, 30).expect("a legal size")
}

/// `count` balls in a cube of side 2, from a fixed sequence.
fn overlapping(count: u32, kernel: Kernel, threshold: f32) -> Scene {
    let coordinate = |index: u32, axis: u32| {
        let hash = (3 * index + axis + 1).wrapping_mul(0x9e37_79b9) >> 8;
        hash as f32 / (1 << 23) as f32 - 1.0
    };
    let balls = (0..count).map(|index| {
        let center = Vec3::new(coordinate(index, 0), coordinate(index, 1), coordinate(index, 2));
        Metaball { center, radius: 0.6, strength: 0.1 }
    });
    Scene::new(balls, kernel, threshold).expect("a legal scene")
}

fn cubic(kernel: i64) -> Kernel {
    Kernel::power(kernel).expect("a legal exponent")
}

#[test]
fn a_pool_of_any_size_grows_to_the_same_picture() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (scene, view) = (overlapping(40, Kernel::Wyvill, 0.1), view(5.0, 4.0));
    let ample = draw(&gpu, &scene, &view, Options::default());
    assert!(ample.nodes > 1000 && ample.hits.iter().any(Hit::is_hit));
    for first_nodes in [0, 1, 100, ample.nodes - 1, ample.nodes] {
        let grown = draw(&gpu, &scene, &view, Options { first_nodes, ..Options::default() });
        assert_eq!(grown.hits, ample.hits, "{first_nodes} nodes");
        assert_eq!(grown.nodes, ample.nodes);
    }
}

/// No threshold is ever reached, so that nothing is clipped: by rasteriser and in compute, from
/// outside and from among the balls. Q² errs by a few roundings of the squared distance, below 50, and
/// so does the end of a chord that begins behind the eye.
#[test]
fn every_chord_is_in_a_list() {
    let Some(gpu) = Gpu::for_test() else { return };
    let scene = overlapping(40, Kernel::Wyvill, 100.0);
    for view in [view(5.0, 4.0), view(0.3, 1.0)] {
        for gather in [Gather::Raster, Gather::Tiles] {
            let picture = draw(&gpu, &scene, &view, Options { gather, ..Options::default() });
            let allowed = 25.0 * 50.0 * f64::from(f32::EPSILON);
            let count = |margin| -> usize {
                let of_ray = |ray| scene.balls().filter(|ball| meets(ray, ball, margin)).count();
                picture.rays.iter().map(of_ray).sum()
            };
            let (least, most) = (count(-allowed) as u32, count(allowed) as u32);
            assert!((least..=most).contains(&picture.nodes), "{least} {} {most}", picture.nodes);
            assert!(most - least < 20, "{least} to {most}: too vague");
            assert!(picture.hits.iter().all(|hit| *hit == Hit::MISS));
        }
    }
}

/// Whether a ray meets a support whose squared radius and reach are larger by a margin.
fn meets(ray: &Ray, ball: &Metaball, margin: f64) -> bool {
    let offset = ball.center.as_dvec3() - ray.origin.as_dvec3();
    let direction = ray.direction.as_dvec3().normalize();
    let middle = offset.dot(direction);
    let across = (offset - middle * direction).length_squared();
    let squared = f64::from(ball.radius).powi(2) - across + margin;
    squared > 0.0 && middle + squared.sqrt() + margin > 0.0
}

/// The two gatherings take cores and lists from the same sums; only where two cores are equally deep
/// to the depth test, to 2⁻²² of their distance, may they pick different ones.
#[test]
fn the_compute_twin_draws_the_same_picture() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (scene, view) = (overlapping(20, Kernel::QUARTIC, 0.05), view(5.0, 4.0));
    let published = draw(&gpu, &scene, &view, Options::default());
    let twin = draw(&gpu, &scene, &view, Options { gather: Gather::Tiles, ..Options::default() });
    assert!(published.core_hits > 10, "{} core hits: no test of cores", published.core_hits);
    for (ours, theirs) in twin.hits.iter().zip(&published.hits) {
        assert_eq!(ours.verdict, theirs.verdict);
        let is_near = !ours.is_hit() || (ours.t - theirs.t).abs() <= 2e-6 * theirs.t;
        assert!(is_near, "{ours:?} for {theirs:?}");
    }
}

#[test]
fn a_small_array_marks_what_it_may_spoil_and_nothing_else() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (scene, view) = (overlapping(60, Kernel::Wyvill, 0.3), view(5.0, 4.0));
    let ample = draw(&gpu, &scene, &view, Options::default());
    assert!(ample.hits.iter().all(|hit| !hit.fallback));
    let mut before = usize::MAX;
    for array_capacity in [3, 4, 12, 48] {
        let tight = draw(&gpu, &scene, &view, Options { array_capacity, ..Options::default() });
        let marked = tight.hits.iter().filter(|hit| hit.fallback).count();
        assert!(marked <= before, "capacity {array_capacity}: {marked} pixels after {before}");
        before = marked;
        for (tight, ample) in tight.hits.iter().zip(&ample.hits) {
            assert!(
                tight.fallback || tight == ample,
                "capacity {array_capacity}: {tight:?} for {ample:?}"
            );
        }
        if array_capacity == 3 {
            assert!(marked > 100, "an array of three is enough for nearly all: no test");
        }
    }
}

/// Both solvers stop within 4e-7 of their interval, at most a radius, and evaluate to a few 1e-6 of
/// T; the slope at these hits is above T per radius at all but grazing rays, which get ten times that.
#[test]
fn the_robust_variant_is_right_with_any_array() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (scene, view) = (overlapping(60, Kernel::Wyvill, 0.3), view(5.0, 4.0));
    let robust = Options { piece: Piece::Robust, ..Options::default() };
    let ample = draw(&gpu, &scene, &view, robust);
    for array_capacity in [3, 5] {
        let tight = draw(&gpu, &scene, &view, Options { array_capacity, ..robust });
        for (tight, ample) in tight.hits.iter().zip(&ample.hits) {
            assert!(!tight.fallback);
            assert_eq!(tight.verdict, ample.verdict, "capacity {array_capacity}");
            let is_near = !ample.is_hit() || (tight.t - ample.t).abs() < 1e-4;
            assert!(is_near, "capacity {array_capacity}: {tight:?} for {ample:?}");
        }
    }
}

/// Ten coincident balls are one ball of ten times the strength: every rank has its node, although
/// all distances are equal. The sums differ by ten roundings, and the roots by their tolerance.
#[test]
fn equal_distances_have_an_order() {
    let Some(gpu) = Gpu::for_test() else { return };
    let view = view(5.0, 3.0);
    let scene = |count: usize, strength| {
        let ball = Metaball { center: Vec3::ZERO, radius: 1.0, strength };
        Scene::new(vec![ball; count], cubic(3), 0.3).expect("a legal scene")
    };
    let rebuilt = Options { piece: Piece::Rebuilt, ..Options::default() };
    let many = draw(&gpu, &scene(10, 0.1), &view, rebuilt);
    let one = draw(&gpu, &scene(1, 1.0), &view, rebuilt);
    let near =
        |a: &Hit, b: &Hit| a.verdict == b.verdict && (a.t == b.t || (a.t - b.t).abs() < 1e-5);
    let differing = many.hits.iter().zip(&one.hits).filter(|(a, b)| !near(a, b)).count();
    // One ring of pixels is clipped by the core of the one and seen by the cubic of the other.
    assert!(one.hits.iter().filter(|hit| hit.is_hit()).count() > 100);
    assert!(differing <= one.core_hits as usize, "{differing} pixels differ");
}

/// Six thousand coincident weak balls are one of six thousand times the strength. Sums of so many
/// equal terms err by 2⁻²⁴ of the sum a term at worst, 4e-4, where the slope is above one in a radius.
#[test]
fn lists_of_many_thousands_are_cast() {
    let Some(gpu) = Gpu::for_test() else { return };
    const COUNT: usize = 6_000;
    let camera = view(5.0, 2.0);
    let view = View::new(*camera.camera(), 6, 4).expect("a legal size");
    let strength = (-12.0_f32).exp2();
    let scene = |count: usize, strength| {
        let ball = Metaball { center: Vec3::ZERO, radius: 1.0, strength };
        Scene::new(vec![ball; count], Kernel::QUARTIC, 0.3).expect("a legal scene")
    };
    let exact = Options { piece: Piece::Exact, ..Options::default() };
    let one = draw(&gpu, &scene(1, COUNT as f32 * strength), &view, exact);
    assert!(one.hits.iter().filter(|hit| hit.is_hit()).count() >= 4);
    for gather in [Gather::Raster, Gather::Tiles] {
        let options = Options { piece: Piece::Robust, gather, ..Options::default() };
        let many = draw(&gpu, &scene(COUNT, strength), &view, options);
        assert!(many.nodes >= 4 * COUNT as u32, "{} nodes", many.nodes);
        for (many, one) in many.hits.iter().zip(&one.hits) {
            assert_eq!(many.verdict, one.verdict);
            let is_near = !one.is_hit() || (many.t - one.t).abs() < 1e-3;
            assert!(is_near, "{many:?} for {one:?}");
        }
    }
}

#[test]
fn a_list_that_is_too_long_is_refused_with_its_numbers() {
    let Some(gpu) = Gpu::for_test() else { return };
    let camera = view(5.0, 3.0);
    let view = View::new(*camera.camera(), 3, 3).expect("a legal size");
    let ball = Metaball { center: Vec3::ZERO, radius: 1.0, strength: 1e-6 };
    let scene = Scene::new(vec![ball; LIST_CAPACITY as usize + 1], Kernel::QUARTIC, 0.3)
        .expect("a legal scene");
    let mut renderer = Renderer::new("illes", Options::default(), false);
    renderer.build(&gpu, &scene).expect("builds");
    let targets = Targets::new(&gpu, 3, 3, false, false).expect("small targets");
    let error = render(&gpu, &mut renderer, &targets, &view).expect_err("too long").to_string();
    let needed = format!("at most {LIST_CAPACITY} balls along a ray");
    assert!(error.contains(&needed), "{error}");
}

#[test]
fn an_eye_in_a_core_is_inside() {
    let Some(gpu) = Gpu::for_test() else { return };
    let balls = [Metaball::new(Vec3::new(0.0, 0.1, 5.0), 1.0), Metaball::new(Vec3::ZERO, 1.0)];
    for piece in [Piece::Running, Piece::Rebuilt, Piece::Exact] {
        let scene = Scene::new(balls, Kernel::QUARTIC, 0.5).expect("a legal scene");
        let options = Options { piece, ..Options::default() };
        let picture = draw(&gpu, &scene, &view(5.0, 3.0), options);
        assert!(picture.hits.iter().all(|hit| hit.verdict == Verdict::Inside && hit.t == 0.0));
    }
}

/// Figure 5 and equations (2) and (3), corrected, in f64: the value where the method says that the
/// cubic reaches T. At the distance D in radii, projections, separators and the hit itself err by
/// about four roundings of D together, twice for the interval's two ends; a cubic rises by at most
/// 1.5γ per half chord, and grazing chords, short but low, by no more.
#[test]
fn the_cubic_reaches_the_threshold_at_any_distance() {
    let Some(gpu) = Gpu::for_test() else { return };
    let scene = overlapping(40, cubic(3), 0.12);
    for distance in [10.0, 1e3, 1e5] {
        let rebuilt = Options { piece: Piece::Rebuilt, ..Options::default() };
        let picture = draw(&gpu, &scene, &view(distance, 4.0), rebuilt);
        let mut measured = 0;
        for (ray, hit) in picture.rays.iter().zip(&picture.hits).filter(|(_, hit)| hit.is_hit()) {
            let (value, slope) = published_cubic(&scene, ray, f64::from(hit.t));
            let rounding = 8.0 * f64::from(f32::EPSILON) * f64::from(distance);
            let error = (value - 0.12).abs();
            assert!(error < 1e-5 + rounding * slope, "{distance}: {error:.2e}, slope {slope}");
            measured += 1;
        }
        assert!(measured > 100, "{distance}: {measured} hits");
        assert_eq!(picture.core_hits, 0, "strengths are below the threshold: there is no core");
    }
}

/// Section 3: at the ends the cubic is 0 and flat, at the midpoint it has the field's value and is flat.
/// Differences over h = 1e-6 of a half chord are h times the second derivative, 6γ, or less.
#[test]
fn the_cubic_meets_its_defining_conditions() {
    let ball = Metaball { center: Vec3::new(0.2, -0.1, 0.3), radius: 1.5, strength: 0.7 };
    let scene = Scene::new([ball], Kernel::Wyvill, 0.5).expect("a legal scene");
    for target in [Vec3::new(0.2, -0.1, 0.0), Vec3::new(0.9, 0.4, 0.0), Vec3::new(1.5, 0.0, 0.0)] {
        let eye = Vec3::new(0.0, 0.0, 4.0);
        let ray = Ray::new(eye, (target - eye).normalize());
        let direction = ray.direction.as_dvec3();
        let offset = ball.center.as_dvec3() - eye.as_dvec3();
        let middle = offset.dot(direction) / direction.length_squared();
        let across = (offset - middle * direction).length_squared();
        let half = (1.5_f64.powi(2) - across).sqrt();
        let peak = f64::from(ball.strength) * scene.kernel().value(across / 1.5_f64.powi(2));
        let value = |t| published_cubic(&scene, &ray, t).0;
        for (t, expected) in [(middle - half, 0.0), (middle, peak), (middle + half, 0.0)] {
            assert!((value(t) - expected).abs() < 1e-9, "{t}");
            for step in [-1e-6 * half, 1e-6 * half] {
                let slope = (value(t + step) - value(t)) / step * half;
                assert!(slope.abs() < 1e-5 * peak, "{t}: {slope:.2e}");
            }
        }
        // Canary: half way up the cubic is half the peak, and its slope is not 0.
        assert!((value(middle - 0.5 * half) - 0.5 * peak).abs() < 1e-9);
    }
}

/// The running sum of the printed Δw, with γ at the midpoint: two radii from the eye they still have their digits. In
/// f32, terms of the size of γ·(m/Q)³, some hundred γ of 0.1 at most, cancel: 1e-4 with a
/// margin; the exact kernel is off by up to 9 % of a ball.
#[test]
fn the_printed_coefficients_are_the_same_cubic() {
    let Some(gpu) = Gpu::for_test() else { return };
    let scene = overlapping(40, cubic(3), 0.12);
    let near = view(2.2, 2.0);
    let picture = draw(&gpu, &scene, &near, Options::default());
    let hits = picture.rays.iter().zip(&picture.hits).filter(|(_, hit)| hit.is_hit());
    let mut errors: Vec<f64> = hits
        .map(|(ray, hit)| (published_cubic(&scene, ray, f64::from(hit.t)).0 - 0.12).abs())
        .collect();
    assert!(errors.len() > 100, "{} hits", errors.len());
    errors.sort_by(f64::total_cmp);
    let p90 = errors[errors.len() * 9 / 10];
    assert!(p90 < 1e-3 * 0.12, "{p90:.2e}");
}

/// Value of the sum of cubics at t, and the sum of their greatest slopes.
fn published_cubic(scene: &Scene, ray: &Ray, t: f64) -> (f64, f64) {
    let direction: DVec3 = ray.direction.as_dvec3();
    let (mut value, mut slope) = (0.0, 0.0);
    for ball in scene.balls() {
        let offset = ball.center.as_dvec3() - ray.origin.as_dvec3();
        let middle = offset.dot(direction) / direction.length_squared();
        let across = (offset - middle * direction).length_squared();
        let squared = f64::from(ball.radius).powi(2);
        if across >= squared {
            continue;
        }
        let half = (squared - across).sqrt();
        let peak = f64::from(ball.strength) * scene.kernel().value(across / squared);
        let part = (1.0 - (t - middle).abs() / half).max(0.0);
        value += peak * part * part * (3.0 - 2.0 * part);
        slope += 1.5 * peak / half;
        // Off-axis errors move γ, too.
        slope += 6.0 * f64::from(ball.strength) / f64::from(ball.radius);
    }
    (value, slope)
}
