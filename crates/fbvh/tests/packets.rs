//! Many rays at once against single rays and against the oracle: through the certified tree rays go in
//! packets of eight, and no answer may show it.

mod scenes;

use fbvh::{Classes, Options, Structure, Tracer, Tree};
use glam::{DVec3, Vec3};
use metaball_core::reference::Oracle;
use metaball_core::{Hit, Kernel, Metaball, NO_LIMIT, Ray, Scene, Verdict};
use proptest::prelude::*;

/// The certified tree as it comes, and cut as small as it goes.
fn trees(scene: &Scene) -> [Tree; 2] {
    let small = Classes { leaf_size: 1, smallest_side: 0.3 };
    let small = Options { structure: Structure::Certified(small), ..Options::certified() };
    [Options::certified(), small]
        .map(|options| Tree::build(scene, &options).expect("legal options"))
}

/// What is wrong with a hit where a ray alone has another: they are the same to the last bit.
fn difference(ray: &Ray, hit: &Hit, single: &Hit) -> Option<String> {
    (hit != single).then(|| format!("{ray:?}: {hit:?} in a packet, alone {single:?}"))
}

/// What is wrong with the answers to rays in packets.
fn complaint(tracer: &Tracer<'_, Scene>, rays: &[Ray], width: usize) -> Option<String> {
    let singles: Vec<Hit> = rays.iter().map(|ray| tracer.first_hit(ray)).collect();
    let pictured = tracer.picture_hits(rays, width);
    for hits in [tracer.first_hits(rays), pictured] {
        if hits.len() != rays.len() {
            return Some(format!("{} hits of {} rays", hits.len(), rays.len()));
        }
        let mut answers = rays.iter().zip(&hits).zip(&singles);
        let found = answers.find_map(|((ray, hit), single)| difference(ray, hit, single));
        if found.is_some() {
            return found;
        }
    }
    let anywhere: Vec<Verdict> = rays.iter().map(|ray| tracer.any_hit(ray)).collect();
    (tracer.any_hits(rays) != anywhere).then(|| format!("any hits of {rays:?}"))
}

/// What is wrong with a hit, if the truth about its ray is clear and f64 is promised to decide.
fn falsehood(scene: &Scene, oracle: &Oracle<'_>, ray: &Ray, hit: &Hit) -> Option<String> {
    let truth = oracle.first_hit(ray);
    let is_far = scene.balls().any(|ball| ball.center.distance(ray.origin) >= 1e5 * ball.radius);
    if truth.is_ambiguous() || hit.verdict == Verdict::Undecided && is_far {
        return None;
    }
    let error = (f64::from(hit.t) - truth.t).abs();
    let is_near = !hit.is_hit() || error <= 1e-6 * (truth.t + f64::from(truth.smallest_radius));
    (hit.verdict != truth.verdict || !is_near).then(|| format!("{ray:?}: {hit:?}, {truth:?}"))
}

/// Where rays start, in parts of the way to what they aim at: most at their origin.
const START_SHARES: [f32; 8] = [0.0, 0.0, 0.0, 0.0, 0.7, 0.99, 1.0, 1.2];

/// A ray from a point to about another, as f32 has it.
fn towards(start: Vec3, end: Vec3) -> Ray {
    let offset = DVec3::from(end) - DVec3::from(start);
    Ray::new(start, offset.normalize_or(DVec3::X).as_vec3())
}

#[test]
fn differences_are_complained_of() {
    let balls = [0.0, 0.8].map(|x| Metaball::new(Vec3::X * x, 1.0));
    let scene = Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal");
    let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
    let tracer = Tracer::new(&tree, &scene);
    let ray = Ray::new(Vec3::new(0.1, 0.2, -4.0), Vec3::Z);
    let hit = tracer.first_hit(&ray);
    let oracle = Oracle::new(&scene);
    assert_eq!(difference(&ray, &hit, &hit), None);
    assert!(difference(&ray, &Hit { t: hit.t.next_up(), ..hit }, &hit).is_some());
    assert_eq!(falsehood(&scene, &oracle, &ray, &hit), None);
    let later = Hit { t: hit.t * 1.0001, ..hit };
    for wrong in [later, Hit::MISS, Hit { verdict: Verdict::Inside, ..hit }] {
        assert!(difference(&ray, &wrong, &hit).is_some());
        assert!(falsehood(&scene, &oracle, &ray, &wrong).is_some());
    }
    assert!(difference(&ray, &Hit { normal: Vec3::Y, ..hit }, &hit).is_some());
    // Within the solid, and behind it.
    for t_min in [hit.t + 0.1, hit.t + 4.0] {
        let later = Ray { t_min, ..ray };
        assert_eq!(falsehood(&scene, &oracle, &later, &tracer.first_hit(&later)), None);
        assert!(falsehood(&scene, &oracle, &later, &hit).is_some());
    }
}

/// In packets of eight, of fewer and of none, and in pictures of odd sizes.
#[test]
fn any_number_of_rays_will_do() {
    let balls =
        (0..60).map(|at| Metaball::new(Vec3::new((at % 8) as f32, (at / 8) as f32, 0.0), 0.9));
    let scene = Scene::new(balls, Kernel::QUARTIC, 0.3).expect("legal");
    for tree in trees(&scene) {
        let tracer = Tracer::new(&tree, &scene);
        for (width, height) in [(0, 0), (1, 1), (7, 1), (8, 1), (9, 3), (5, 5), (3, 11), (33, 9)] {
            let ray = |at: usize| {
                let (x, y) = ((at % width) as f32, (at / width) as f32);
                towards(Vec3::new(3.0, 3.0, -9.0), Vec3::new(0.25 * x, 0.9 * y, 0.0))
            };
            let rays: Vec<Ray> = (0..width * height).map(ray).collect();
            assert_eq!(complaint(&tracer, &rays, width), None, "{width} × {height}");
            // Not a whole number of rows.
            assert_eq!(complaint(&tracer, &rays, width + 2), None, "{width} × {height}");
        }
    }
}

/// Rays in the planes of boxes, whose directions have zeros of either sign.
#[test]
fn rays_along_faces_hit_together() {
    let grid = (0..125).map(|at| {
        Metaball::new(Vec3::new((at % 5) as f32, (at / 5 % 5) as f32, (at / 25) as f32), 1.0)
    });
    let scene = Scene::new(grid, Kernel::QUARTIC, 0.5).expect("legal");
    for tree in trees(&scene) {
        let tracer = Tracer::new(&tree, &scene);
        for direction in [Vec3::Z, Vec3::new(-0.0, -0.0, 1.0)] {
            let start = |at: usize| Vec3::new((at % 5) as f32, (at / 5) as f32, -3.0);
            let rays: Vec<Ray> = (0..25).map(|at| Ray::new(start(at), direction)).collect();
            assert!(tracer.first_hits(&rays).iter().all(|hit| hit.verdict == Verdict::Hit));
            assert_eq!(complaint(&tracer, &rays, 5), None);
        }
    }
}

/// Rays that touch the surface, or almost, side by side; of a ball alone and of many that coincide.
#[test]
fn grazing_rays_are_distinguished() {
    let mut clear = 0;
    for (kernel, copies) in Kernel::all().flat_map(|kernel| [(kernel, 1), (kernel, 50)]) {
        let ball = Metaball { center: Vec3::new(1.0, -2.0, 0.5), radius: 1.5, strength: 1.25 };
        let threshold = 0.4 * copies as f32;
        let scene = Scene::new(vec![ball; copies], kernel, threshold).expect("legal");
        let core = kernel.core_radius(&ball, 0.4).expect("0.4 is below 1.25");
        let oracle = Oracle::new(&scene);
        let rays: Vec<Ray> = (0..64)
            .map(|step| {
                let share = 10f64.powf(-0.2 * f64::from(step / 2));
                let off = core * (1.0 + if step % 2 == 0 { share } else { -share });
                let target = ball.center + (off as f32) * Vec3::Y;
                Ray::new(target - 7.0 * Vec3::Z, Vec3::Z)
            })
            .collect();
        for tree in trees(&scene) {
            let tracer = Tracer::new(&tree, &scene);
            for (ray, hit) in rays.iter().zip(tracer.first_hits(&rays)) {
                assert_eq!(falsehood(&scene, &oracle, ray, &hit), None, "{kernel} {copies}");
                clear += usize::from(!oracle.first_hit(ray).is_ambiguous());
            }
            assert_eq!(complaint(&tracer, &rays, 8), None, "{kernel} {copies}");
        }
    }
    assert!(clear > 1000, "{clear}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Neighbours about each of some targets, with a stray among them, rays that end early, rays that
    /// start late, and rays that start inside; at any scale and distance.
    #[test]
    fn packets_change_no_answer(
        scene in scenes::any_signed_scene(40),
        scale in prop::sample::select(vec![1e-4f32, 1.0, 1e6]),
        eye in [-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0],
        distance in prop::sample::select(vec![5.0f32, 100.0, 1e4]),
        apart in prop::sample::select(vec![0.0f32, 1e-3, 0.05, 0.5]),
        targets in prop::collection::vec([-3.0f32..3.0, -3.0f32..3.0, -3.0f32..3.0], 8),
        strays in prop::collection::vec(0usize..64, 4),
        t_max in prop::sample::select(vec![NO_LIMIT, NO_LIMIT, 4.0]),
        t_min in prop::collection::vec(prop::sample::select(START_SHARES.to_vec()), 64),
    ) {
        let balls: Vec<Metaball> = scene
            .balls()
            .map(|ball| Metaball { center: scale * ball.center, radius: scale * ball.radius, ..ball })
            .collect();
        let scene = Scene::new(balls.clone(), scene.kernel(), scene.threshold()).expect("legal");
        let oracle = Oracle::new(&scene);
        let eye = scale * distance * Vec3::from(eye);
        let rays: Vec<Ray> = (0..8 * targets.len())
            .map(|at| {
                let (target, neighbour) = (at / 8, at % 8);
                let center = balls.get(target).map_or(Vec3::ZERO, |ball| ball.center);
                let goal = if target % 2 == 0 { center } else { scale * Vec3::from(targets[target]) };
                let offset = Vec3::new((neighbour % 4) as f32, (neighbour / 4) as f32, 0.3);
                let stray = strays.contains(&at);
                let goal = if stray { -goal } else { goal + apart * scale * offset };
                let start = if target == 7 { center } else { eye };
                let t_min = t_min[at] * start.distance(goal);
                Ray { t_min, t_max: t_min + t_max * scale, ..towards(start, goal) }
            })
            .map(|ray| Ray { t_max: ray.t_max.min(NO_LIMIT), ..ray })
            .collect();
        for tree in trees(&scene) {
            let tracer = Tracer::new(&tree, &scene);
            let found = complaint(&tracer, &rays, 8);
            prop_assert!(found.is_none(), "{found:?}");
            for (ray, hit) in rays.iter().zip(tracer.first_hits(&rays)) {
                let found = falsehood(&scene, &oracle, ray, &hit);
                prop_assert!(found.is_none(), "{found:?}");
            }
        }
    }
}

/// A ball so small and so far away that a few floats of t lie in it, before a large one that the ray just
/// misses.
#[test]
fn balls_no_larger_than_some_floats_are_hit() {
    let small = Metaball::new(Vec3::new(0.0, 0.0, 0.707_606_8), 0.001);
    let scene = Scene::new([Metaball::new(Vec3::ZERO, 1.0), small], Kernel::QUARTIC, 0.25);
    let scene = scene.expect("legal");
    let direction = Vec3::new(-0.669_523_66, -0.742_784_86, -0.002_954_555);
    let ray = Ray::new(Vec3::new(2931.501, 3252.274, 13.643_609), direction);
    let truth = Oracle::new(&scene).first_hit(&ray);
    assert!(truth.verdict == Verdict::Hit && truth.exit - truth.t < 0.002);
    for tree in trees(&scene) {
        let tracer = Tracer::new(&tree, &scene);
        let hit = tracer.first_hit(&ray);
        assert_eq!(falsehood(&scene, &Oracle::new(&scene), &ray, &hit), None);
        assert_eq!(complaint(&tracer, &[ray; 8], 8), None);
        assert!(hit.is_hit() && (f64::from(hit.t) - truth.t).abs() < 2.5e-4);
    }
}
