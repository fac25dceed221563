//! The CPU tracer against closed forms and against the oracle.

mod scenes;

use approx::assert_relative_eq;
use bench_scenes::{BenchScene, Overrides, load};
use fbvh::{
    Boxes, Classes, Fitting, Kind, Options, Reading, SecantSearch, Structure, TraceError, Tracer,
    Tree, Work,
};
use glam::{DVec3, Vec3};
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Camera, Hit, Kernel, Metaball, NO_LIMIT, Ray, Scene, Verdict, View};
use proptest::prelude::*;

const CLIPPED: SecantSearch = SecantSearch::DEFAULT;
const LITERAL: SecantSearch = SecantSearch { reading: Reading::Literal, ..CLIPPED };

/// The published structures, the fitted one with nothing of section 5.3 and with all, and the
/// certified one as it comes and cut as small as it goes.
fn structures() -> [Options; 6] {
    let fitted = |boxes, discard_up_to| Options {
        structure: Structure::Fitted(Fitting { boxes, discard_up_to }),
        // Small enough to make trees of a handful of balls.
        traversal_cost: 2.0,
        ..Options::fitted()
    };
    [
        Options::modified_bvh(),
        Options { traversal_cost: 2.0, ..Options::fitted() },
        fitted(Boxes::Cut, 0),
        fitted(Boxes::PerBall, 1000),
        Options::certified(),
        Options {
            structure: Structure::Certified(Classes { leaf_size: 1, smallest_side: 0.3 }),
            ..Options::certified()
        },
    ]
}

/// A tracer whose leaves are searched so where the tree is a published one.
fn tracer<'a>(tree: &'a Tree, scene: &'a Scene, search: SecantSearch) -> Tracer<'a, Scene> {
    let tracer = Tracer::new(tree, scene);
    match tree.kind() {
        Kind::Certified => tracer,
        _ => tracer.with_search(search).expect("a published tree"),
    }
}

fn trace(scene: &Scene, options: &Options, search: SecantSearch, ray: &Ray) -> Hit {
    let tree = Tree::build(scene, options).expect("legal options");
    tracer(&tree, scene, search).first_hit(ray)
}

#[test]
fn one_ball_is_a_sphere() {
    for kernel in Kernel::all() {
        let ball = Metaball { center: Vec3::new(1.0, -2.0, 0.5), radius: 1.5, strength: 1.25 };
        let scene = Scene::new([ball], kernel, 0.4).expect("legal");
        let core = kernel.core_radius(&ball, 0.4).expect("0.4 is below 1.25");
        for options in structures() {
            for search in [CLIPPED, LITERAL] {
                let ray = Ray::new(ball.center - 5.0 * Vec3::Z, Vec3::Z);
                let hit = trace(&scene, &options, search, &ray);
                assert_eq!(hit.verdict, Verdict::Hit);
                // 1e-5 of T over the field's slope, which for α = 8, the flattest at the core
                // radius, is 0.9 T a unit; and as much again for f32.
                assert_relative_eq!(f64::from(hit.t), 5.0 - core, epsilon = 5e-5);
                assert_relative_eq!(hit.normal, -Vec3::Z, epsilon = 1e-4);

                let inside = Ray::new(ball.center, Vec3::Z);
                let hit = trace(&scene, &options, search, &inside);
                assert_eq!((hit.verdict, hit.t), (Verdict::Inside, 0.0));
                let away = Ray::new(ray.origin, -Vec3::Z);
                assert_eq!(trace(&scene, &options, search, &away), Hit::MISS);
            }
        }
    }
}

#[test]
fn an_opaque_thing_ends_the_ray() {
    let scene = Scene::new([Metaball::new(Vec3::ZERO, 1.0)], Kernel::QUARTIC, 0.25).expect("legal");
    // The quartic is 0.25 at ρ² = 0.5: t = 3 − 0.7071.
    for options in structures() {
        for search in [CLIPPED, LITERAL] {
            let verdict = |t_max| {
                let ray = Ray { t_max, ..Ray::new(-3.0 * Vec3::X, Vec3::X) };
                trace(&scene, &options, search, &ray).verdict
            };
            assert_eq!(verdict(2.29), Verdict::Miss);
            // Ends inside the solid, before the centre's projection.
            assert_eq!(verdict(2.30), Verdict::Hit);
            assert_eq!(verdict(NO_LIMIT), Verdict::Hit);
        }
    }
}

/// Rays along the axes whose directions have zeros, in the planes of boxes that were split there.
#[test]
fn rays_along_faces_hit() {
    let grid = (0..125).map(|at| {
        Metaball::new(Vec3::new((at % 5) as f32, (at / 5 % 5) as f32, (at / 25) as f32), 1.0)
    });
    let scene = Scene::new(grid, Kernel::QUARTIC, 0.5).expect("legal");
    for options in structures() {
        for row in 0..25 {
            let start = Vec3::new((row % 5) as f32, (row / 5) as f32, -3.0);
            for direction in [Vec3::Z, Vec3::new(-0.0, -0.0, 1.0)] {
                let hit = trace(&scene, &options, CLIPPED, &Ray::new(start, direction));
                assert_eq!(hit.verdict, Verdict::Hit, "{start} {:?}", options.kind());
            }
        }
    }
}

#[test]
fn batches_are_single_rays_and_counting_changes_nothing() {
    let balls = (0..300).map(|at| {
        let angle = at as f32 * 0.7;
        Metaball::new(Vec3::new(angle.cos(), 0.01 * at as f32, angle.sin()), 0.3)
    });
    let scene = Scene::new(balls, Kernel::Wyvill, 0.2).expect("legal");
    let rays = rays_at(&scene, 40);
    for options in structures() {
        let tree = Tree::build(&scene, &options).expect("legal options");
        let tracer = Tracer::new(&tree, &scene);
        let mut work = Work::default();
        let one_by_one: Vec<Hit> =
            rays.iter().map(|ray| tracer.first_hit_counting(ray, &mut work)).collect();
        assert_eq!(tracer.first_hits(&rays), one_by_one);
        assert!(one_by_one.iter().any(Hit::is_hit) && work.nodes > work.leaf_tests);
        assert!(work.leaf_tests > 0 && work.balls >= work.leaf_tests && work.iterations > 0);
    }
}

/// Rays of a camera that frames the scene, so many in a row and in a column.
fn rays_at(scene: &Scene, pixels: u32) -> Vec<Ray> {
    let camera = Camera::framing(&scene.bounds(), Vec3::new(0.5, 0.3, 1.0));
    (0..pixels * pixels)
        .map(|pixel| {
            let direction = camera.exact_direction(pixel % pixels, pixel / pixels, pixels, pixels);
            Ray::new(camera.eye(), direction.as_vec3())
        })
        .collect()
}

/// Whether the paper's assumption holds for this ray: a centre projects into the first interval
/// inside, well away from its ends, of a ball whose support the projection is in. (A ball that the
/// ray does not meet is in no list that the ray reads.) The modified BVH needs more: its
/// lists are complete only in the supports of own balls, so that ball's must reach back to the hit.
/// The certified tree assumes nothing.
fn assumption_holds(scene: &Scene, ray: &Ray, truth: &Truth, kind: Kind) -> bool {
    if kind == Kind::Certified {
        return true;
    }
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    scene.balls().any(|ball| {
        let center = ball.center.as_dvec3();
        // At the end of the ray, if the projection is beyond.
        let t = ((center - origin).dot(direction)).min(f64::from(ray.t_max));
        let slack = 1e-3 * (truth.exit - truth.t);
        let holds = |t: f64| {
            let radius = f64::from(ball.radius) * (1.0 - 1e-3);
            (origin + t * direction).distance_squared(center) < radius * radius
        };
        t > truth.t + slack
            && t < truth.exit - slack
            && holds(t)
            && (kind == Kind::Fitted || holds(truth.t))
    })
}

/// How far from the first hit a tracer may find it.
///
/// The search ends where |F − T| ≤ 1e-5 T as computed; the computation is off by at most
/// (n + 8) w Σ q, plus, per ball, a position off by 4 w (distance + R), which moves v by twice that
/// over R and the kernel by its slope, at most 8 (α = 8), times as much. The point is where F is
/// within that of T: between the true crossings of T(1 ± ε), which the oracle finds.
fn tolerated_share(scene: &Scene, ray: &Ray, truth: &Truth) -> f64 {
    const ROUNDOFF: f64 = 1.0 / (1 << 24) as f64;
    let point = ray.origin.as_dvec3() + truth.t * ray.direction.as_dvec3();
    let near: Vec<Metaball> = scene
        .balls()
        .filter(|ball| ball.center.as_dvec3().distance(point) < 1.5 * f64::from(ball.radius))
        .collect();
    let strengths: f64 = near.iter().map(|ball| f64::from(ball.strength)).sum();
    let smallest = near.iter().map(|ball| f64::from(ball.radius)).fold(f64::INFINITY, f64::min);
    let position = 4.0 * ROUNDOFF * (truth.t / smallest + 1.0);
    let computed = ((near.len() + 8) as f64 * ROUNDOFF + 16.0 * position) * strengths;
    f64::from(CLIPPED.tolerance) + 2.0 * computed / f64::from(scene.threshold())
}

/// What is wrong with a hit, unless arithmetic or the paper's assumption excuses it.
fn complaint(
    scene: &Scene,
    oracle: &Oracle<'_>,
    ray: &Ray,
    hit: &Hit,
    (kind, reading): (Kind, Reading),
) -> Option<String> {
    let truth = oracle.first_hit(ray);
    let share = tolerated_share(scene, ray, &truth);
    if truth.margin <= share.max(Truth::AMBIGUOUS) {
        return None;
    }
    let at = |t: f64| oracle.field(ray.origin.as_dvec3() + t * ray.direction.as_dvec3());
    let threshold = f64::from(scene.threshold());
    let field = at(f64::from(hit.t));

    // Whatever the reading: nothing is hit that is not solid, nor where nothing is.
    if hit.is_hit() && (!truth_is_hit(&truth) || field < threshold * (1.0 - share)) {
        return Some(format!("a hit in thin air: field {field} at {}, {truth:?}", hit.t));
    }
    if (hit.verdict == Verdict::Inside) != (truth.verdict == Verdict::Inside) {
        return Some(format!("{:?} where {truth:?}", hit.verdict));
    }
    if !truth_is_hit(&truth) || !assumption_holds(scene, ray, &truth, kind) {
        return None;
    }
    if !hit.is_hit() {
        return Some(format!("missed: {truth:?}"));
    }
    // Read literally, a leaf of the Fitted BVH may end the ray with a root outside its box, where
    // its list is incomplete: behind the surface. That is what makes `clipped` worth having.
    if kind == Kind::Fitted && reading == Reading::Literal {
        return None;
    }
    let behind = f64::from(hit.t) > truth.exit;
    (behind || field > threshold * (1.0 + share) && hit.verdict == Verdict::Hit)
        .then(|| format!("wrong front: field {field} at {}, {truth:?}", hit.t))
}

fn truth_is_hit(truth: &Truth) -> bool {
    truth.verdict != Verdict::Miss
}

#[test]
fn wrong_hits_are_complained_of() {
    let balls = [0.0, 0.8].map(|x| Metaball::new(Vec3::X * x, 1.0));
    let scene = Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal");
    let oracle = Oracle::new(&scene);
    let ray = Ray::new(Vec3::new(0.1, 0.2, -4.0), Vec3::Z);
    let right = trace(&scene, &Options::fitted(), CLIPPED, &ray);
    let complains = |ray: &Ray, hit: Hit| {
        complaint(&scene, &oracle, ray, &hit, (Kind::Fitted, Reading::Clipped)).is_some()
    };
    assert!(!complains(&ray, right));
    assert!(complains(&ray, Hit::MISS));
    assert!(complains(&ray, Hit { t: right.t - 1e-3, ..right }));
    assert!(complains(&ray, Hit { t: right.t + 1e-3, ..right }));
    assert!(complains(&ray, Hit { verdict: Verdict::Inside, t: 0.0, ..right }));
    assert!(complains(&Ray { direction: Vec3::X, ..ray }, right));
    assert!(complains(&Ray { t_min: right.t + 0.1, ..ray }, right));
    assert!(complains(&Ray { t_min: right.t + 4.0, ..ray }, right));
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn hits_are_the_oracles(
        scene in scenes::any_scene(40),
        eye in [-6.0f32..6.0, -6.0f32..6.0, -6.0f32..6.0],
        targets in prop::collection::vec([-3.0f32..3.0, -3.0f32..3.0, -3.0f32..3.0], 20),
        t_min in prop::sample::select(vec![0.0f32, 0.0, 2.0, 5.0]),
        t_max in prop::sample::select(vec![NO_LIMIT, NO_LIMIT, 4.0]),
    ) {
        let oracle = Oracle::new(&scene);
        let eye = Vec3::from(eye);
        for options in structures() {
            let tree = Tree::build(&scene, &options).expect("legal options");
            for search in [CLIPPED, LITERAL] {
                let tracer = tracer(&tree, &scene, search);
                for &target in &targets {
                    let direction = (DVec3::from(Vec3::from(target)) - DVec3::from(eye)).normalize_or(DVec3::X);
                    let ray = Ray { t_min, t_max, ..Ray::new(eye, direction.as_vec3()) };
                    let hit = tracer.first_hit(&ray);
                    let variant = (options.kind(), search.reading);
                    if let Some(complaint) = complaint(&scene, &oracle, &ray, &hit, variant) {
                        prop_assert!(false, "{options:?} {search:?} {ray:?}: {complaint}");
                    }
                }
            }
        }
    }
}

/// The answers to every query about a ray of a certified tree.
struct Answers {
    hit: Hit,
    any: Verdict,
    exit: Hit,
}

impl Answers {
    fn of(tracer: &Tracer<'_, Scene>, ray: &Ray) -> Self {
        let exit = tracer.first_exit(ray).expect("a certified tree");
        Self { hit: tracer.first_hit(ray), any: tracer.any_hit(ray), exit }
    }
}

/// What is wrong with the answers about a ray, if the truth is clear.
///
/// A root is refined in f64, so t is right to its own rounding to f32, 6e-8 of itself; 1e-6 allows for
/// rays that graze, whose crossing is known to less.
fn false_answer(
    (scene, oracle): (&Scene, &Oracle<'_>),
    ray: &Ray,
    &Answers { hit, any, exit }: &Answers,
) -> Option<String> {
    let truth = oracle.first_hit(ray);
    if truth.is_ambiguous() {
        return None;
    }
    // Certainty is promised to 1e4 radii. Beyond, f64 may not decide, and then must say so; as it may not
    // where a ball of strength T touches T at its centre: if Perlin's kernel, 1 − 10ρ³ there, has neither
    // slope nor curvature, or if another ball's support begins at that point, before which the field is T
    // to its last bits.
    let radii = |ball: Metaball| ball.center.distance(ray.origin) / ball.radius;
    let is_flat = |ball: Metaball| {
        let begins_there = |other: Metaball| other.center.distance(ball.center) == other.radius;
        ball.strength == scene.threshold()
            && (scene.kernel() == Kernel::Perlin || scene.balls().any(begins_there))
    };
    let promised = scene.balls().all(|ball| radii(ball) < 1e5 && !is_flat(ball));
    if !promised && [hit.verdict, any, exit.verdict].contains(&Verdict::Undecided) {
        return None;
    }
    let near =
        |t: f64, right: f64| (t - right).abs() <= 1e-6 * (right + f64::from(truth.smallest_radius));
    if hit.verdict != truth.verdict || any != truth.verdict {
        return Some(format!("first {:?}, any {any:?}: {truth:?}", hit.verdict));
    }
    if hit.is_hit() && !near(f64::from(hit.t), truth.t) {
        return Some(format!("{hit:?}: {truth:?}"));
    }
    if truth.verdict != Verdict::Inside {
        let is_at_start = (exit.verdict, exit.t) == (Verdict::Inside, ray.t_min);
        return (!is_at_start).then(|| format!("{exit:?}: {truth:?}"));
    }
    if truth.exit >= f64::from(ray.t_max) {
        return (exit != Hit::MISS).then(|| format!("{exit:?}: {truth:?}"));
    }
    // The margin says nothing of a field that falls to T before, and rises again.
    let field_at = |t: f64| oracle.field(ray.origin.as_dvec3() + t * ray.direction.as_dvec3());
    let first = f64::from(exit.t).min(truth.exit);
    let share = (field_at(first) / f64::from(scene.threshold()) - 1.0).abs();
    let right = near(f64::from(exit.t), truth.exit) || share <= Truth::AMBIGUOUS;
    (exit.verdict != Verdict::Hit || !right).then(|| format!("{exit:?}: {truth:?}"))
}

#[test]
fn false_answers_are_complained_of() {
    let scene = |radius| {
        let balls = [0.0, 0.8].map(|x| Metaball::new(Vec3::X * x, radius));
        Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal")
    };
    let (right, wrong) = (scene(1.0), scene(1.01));
    let tree = Tree::build(&right, &Options::certified()).expect("legal options");
    let tracer = Tracer::new(&tree, &right);
    for (start, t_inside) in [(Vec3::new(0.1, 0.2, -4.0), 4.0), (Vec3::ZERO, 0.3)] {
        let ray = Ray::new(start, Vec3::Z);
        let complaint = |scene: &Scene, ray: &Ray, answers: &Answers| {
            false_answer((scene, &Oracle::new(scene)), ray, answers)
        };
        let answers = Answers::of(&tracer, &ray);
        assert_eq!(complaint(&right, &ray, &answers), None);
        assert!(complaint(&wrong, &ray, &answers).is_some());
        for t_min in [t_inside, t_inside + 4.0] {
            let later = Ray { t_min, ..ray };
            assert_eq!(complaint(&right, &later, &Answers::of(&tracer, &later)), None);
            assert!(complaint(&right, &later, &answers).is_some());
        }
    }
    let published = Tree::build(&right, &Options::fitted()).expect("legal options");
    let tracer = Tracer::new(&published, &right);
    let ray = Ray::new(Vec3::new(0.1, 0.2, -4.0), Vec3::Z);
    assert_eq!(tracer.any_hit(&ray), Verdict::Hit);
    assert_eq!(tracer.any_hit(&Ray { t_max: 2.0, ..ray }), Verdict::Miss);
}

/// A ball of strength T touches T at its centre, and another ball's support begins there: f64 does not
/// tell where the field begins to be above T, and says so.
#[test]
fn a_touch_where_a_support_begins_is_decided_or_said_to_be_undecided() {
    let kernel = Kernel::power(1).expect("legal");
    let (large, small) = (Vec3::new(-1.0, 2.0, 0.0), Vec3::new(-1.0, 2.0, 1.0));
    let balls = [Metaball::new(small, 1.0), Metaball::new(large, 2.0)];
    let scene = Scene::new(balls, kernel, 1.0).expect("legal");
    let oracle = Oracle::new(&scene);
    let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
    let tracer = Tracer::new(&tree, &scene);
    for step in 0..200 {
        let step = step as f32;
        let start =
            5.0 * Vec3::new((0.377 * step).sin(), (0.811 * step).cos(), (1.37 * step).sin());
        let ray = Ray::new(start, (large - start).normalize());
        assert_eq!(false_answer((&scene, &oracle), &ray, &Answers::of(&tracer, &ray)), None);
    }
}

#[test]
fn what_a_tree_does_not_have_is_an_error() {
    let scene = Scene::new([Metaball::new(Vec3::ZERO, 1.0)], Kernel::QUARTIC, 0.25).expect("legal");
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    for options in structures() {
        let tree = Tree::build(&scene, &options).expect("legal options");
        let tracer = Tracer::new(&tree, &scene);
        let (exit, exits) = (tracer.first_exit(&ray), tracer.first_exits(&[ray]));
        let with_search = tracer.with_search(CLIPPED);
        let found = tree.kind();
        if found == Kind::Certified {
            assert_eq!(exits, exit.map(|hit| vec![hit]));
            assert_eq!(with_search.err(), Some(TraceError::SecantOfCertified { found }));
        } else {
            assert_eq!(exit, Err(TraceError::ExitOfPublished { found }));
            assert_eq!(exits, Err(TraceError::ExitOfPublished { found }));
            assert!(with_search.is_ok());
        }
    }
}

/// As the shaders have it: a ray that starts outside is at its exit, one that ends inside has none.
#[test]
fn exits_of_rays_that_start_outside_are_at_their_start() {
    let scene = Scene::new([Metaball::new(Vec3::ZERO, 1.0)], Kernel::QUARTIC, 0.25).expect("legal");
    let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
    let tracer = Tracer::new(&tree, &scene);
    // The quartic is 0.25 at r = 0.7071: outside of every leaf, and in the corner of one.
    for start in [Vec3::X, Vec3::splat(0.6)] {
        let exit = tracer.first_exit(&Ray::new(start, Vec3::NEG_X)).expect("a certified tree");
        assert_eq!((exit.verdict, exit.t), (Verdict::Inside, 0.0), "{start}");
    }
    let ends = Ray { t_max: 0.5, ..Ray::new(Vec3::ZERO, Vec3::X) };
    assert_eq!(tracer.first_exit(&ends), Ok(Hit::MISS));
}

/// Where a ray starts on the face of a leaf, rounding decides on which side of it. That it starts in the
/// solid does not depend on that.
#[test]
fn starts_on_faces_of_leaves_are_as_far_inside() {
    let BenchScene { scene, camera, .. } =
        load("scattered:200:30", &Overrides::default()).expect("a generator");
    let oracle = Oracle::new(&scene);
    let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
    let tracer = Tracer::new(&tree, &scene);
    let mut inside = 0;
    for ray in View::new(camera, 40, 30).expect("a size").rays() {
        let (origin, inverse) = (ray.origin.as_dvec3(), ray.direction.as_dvec3().recip());
        for leaf in tree.leaves() {
            let to_min = (leaf.bounds().min.as_dvec3() - origin) * inverse;
            let to_max = (leaf.bounds().max.as_dvec3() - origin) * inverse;
            let (enter, leave) = (to_min.min(to_max), to_min.max(to_max));
            if enter.max_element() > leave.min_element() || enter.max_element() <= 0.0 {
                continue;
            }
            let start = Ray { t_min: enter.max_element() as f32, ..ray };
            let answers = Answers::of(&tracer, &start);
            let complaint = false_answer((&scene, &oracle), &start, &answers);
            assert!(complaint.is_none(), "{start:?}: {complaint:?}");
            inside += usize::from(answers.any == Verdict::Inside);
        }
    }
    assert!(inside > 1000, "{inside}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// At any scale, from any distance, and from inside: most targets are centres of balls, and a
    /// third of the rays start there. Each ray ends early once, and starts late once.
    #[test]
    fn certain_answers_are_the_oracles(
        scene in scenes::any_signed_scene(40),
        scale in prop::sample::select(vec![1e-4f32, 1.0, 1e6]),
        eye in [-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0],
        distance in prop::sample::select(vec![5.0f32, 100.0, 1e4]),
        targets in prop::collection::vec([-3.0f32..3.0, -3.0f32..3.0, -3.0f32..3.0], 24),
    ) {
        let balls: Vec<Metaball> = scene
            .balls()
            .map(|ball| Metaball {
                center: scale * ball.center,
                radius: scale * ball.radius,
                ..ball
            })
            .collect();
        let scene = Scene::new(balls.clone(), scene.kernel(), scene.threshold()).expect("legal");
        let oracle = Oracle::new(&scene);
        let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
        let tracer = Tracer::new(&tree, &scene);
        let far = scale * distance * Vec3::from(eye);
        for (at, &target) in targets.iter().enumerate() {
            let target = scale * Vec3::from(target);
            let center = balls.get(at).map_or(target, |ball| ball.center);
            let (start, end) = if at % 3 == 0 { (center, target) } else { (far, center) };
            let offset = DVec3::from(end) - DVec3::from(start);
            let ray = Ray::new(start, offset.normalize_or(DVec3::X).as_vec3());
            let t_min = [0.5, 0.9, 1.0, 1.1, 2.0][at % 5] * offset.length() as f32;
            let later = Ray { t_min, ..ray };
            let part = Ray { t_max: t_min + scale, ..later };
            for ray in [ray, Ray { t_max: scale, ..ray }, later, part] {
                let answers = Answers::of(&tracer, &ray);
                let complaint = false_answer((&scene, &oracle), &ray, &answers);
                prop_assert!(complaint.is_none(), "{ray:?}: {complaint:?}");
            }
        }
    }
}
