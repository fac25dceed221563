//! Cut solids against the oracle: the field where a ray enters the region, and the first root behind.

mod scenes;

use fbvh::{ClippedTracer, Options, TraceError, Tracer, Tree};
use glam::{DVec3, Vec3};
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{
    Aabb, Clip, Hit, HostTracer, Kernel, Metaball, NO_LIMIT, Ray, RayQuery, Scene, SurfaceHit,
    Verdict,
};
use proptest::prelude::*;

/// A region by its planes, each an outward normal and a point.
#[derive(Debug, Clone)]
struct Region {
    planes: Vec<(Vec3, Vec3)>,
}

/// Where a ray is in a region.
struct Span {
    start: f64,
    end: f64,
    /// Outward normals of the faces where it starts and ends.
    entry: Option<Vec3>,
    exit: Option<Vec3>,
}

impl Region {
    fn offset((normal, point): (Vec3, Vec3)) -> f32 {
        normal.as_dvec3().dot(point.as_dvec3()) as f32
    }

    fn clip(&self) -> Clip {
        self.planes.iter().fold(Clip::default(), |clip, &plane| {
            clip.and_plane(plane.0, Self::offset(plane).into()).expect("a plane")
        })
    }

    fn span(&self, ray: &Ray) -> Option<Span> {
        let (mut start, mut end) = (f64::from(ray.t_min), f64::from(ray.t_max));
        let (mut entry, mut exit) = (None, None);
        for &plane in &self.planes {
            let normal = plane.0.as_dvec3();
            let height = |t: f64| normal.dot(ray.origin.as_dvec3() + t * ray.direction.as_dvec3());
            let offset = f64::from(Self::offset(plane));
            let rise = height(1.0) - height(0.0);
            let t = (offset - height(0.0)) / rise;
            let unit = Some(plane.0.normalize());
            if rise == 0.0 {
                if height(0.0) > offset {
                    return None;
                }
            } else if rise > 0.0 && t < end {
                (end, exit) = (t, unit);
            } else if rise < 0.0 && t > start {
                (start, entry) = (t, unit);
            }
        }
        (start <= end).then_some(Span { start, end, entry, exit })
    }
}

/// The answers to every query about a ray.
#[derive(Debug, Clone, Copy)]
struct Answers {
    hit: Hit,
    any: Verdict,
    exit: Hit,
}

impl Answers {
    fn of(tracer: &ClippedTracer<'_, Scene>, ray: &Ray) -> Self {
        let exit = tracer.first_exit(ray).expect("a certified tree");
        Self { hit: tracer.first_hit(ray), any: tracer.any_hit(ray), exit }
    }
}

/// What is wrong with the answers about a ray, if the truth is clear.
fn complaint(oracle: &Oracle<'_>, region: &Region, ray: &Ray, answers: &Answers) -> Option<String> {
    let at_start = |verdict, t| Hit { verdict, t, ..Hit::MISS };
    let outside = at_start(Verdict::Inside, ray.t_min);
    let (first, exit, around) = match region.span(ray) {
        None => (Hit::MISS, outside, 1.0),
        Some(Span { start, end, entry, exit: face }) => {
            let part = Ray { t_min: start as f32, t_max: end as f32, ..*ray };
            let truth = oracle.first_hit(&part);
            if truth.is_ambiguous() || exit_is_ambiguous(oracle, &part, &truth) {
                return None;
            }
            let first = match (truth.verdict, entry) {
                (Verdict::Inside, Some(normal)) => {
                    Hit { normal, ..at_start(Verdict::Hit, part.t_min) }
                }
                (verdict, _) => {
                    Hit { normal: truth.normal.as_vec3(), ..at_start(verdict, truth.t as f32) }
                }
            };
            let exit = if entry.is_some() || truth.verdict != Verdict::Inside {
                outside
            } else if truth.exit < f64::from(part.t_max) {
                at_start(Verdict::Hit, truth.exit as f32)
            } else {
                face.map_or(Hit::MISS, |normal| Hit {
                    normal,
                    ..at_start(Verdict::Hit, part.t_max)
                })
            };
            (first, exit, truth.smallest_radius)
        }
    };
    let is_near = |a: f32, b: f32| a == b || (a - b).abs() <= 2e-6 * (b + around);
    let is_same =
        |found: &Hit, right: &Hit| found.verdict == right.verdict && is_near(found.t, right.t);
    // Surface normals vary along the surface; those of faces do not.
    let is_face = |normal: Vec3| region.planes.iter().any(|plane| plane.0.normalize() == normal);
    let has_face = |found: &Hit, right: &Hit| {
        !is_face(right.normal) || found.normal.distance(right.normal) < 1e-6
    };
    let is_right = is_same(&answers.hit, &first)
        && has_face(&answers.hit, &first)
        && answers.any == first.verdict
        && is_same(&answers.exit, &exit)
        && has_face(&answers.exit, &exit);
    (!is_right).then(|| format!("{ray:?}: {answers:?}, needed {first:?} and {exit:?}"))
}

/// The margin says nothing of a field that falls to T where the ray leaves the region.
fn exit_is_ambiguous(oracle: &Oracle<'_>, part: &Ray, truth: &Truth) -> bool {
    let shorter = Ray { t_max: part.t_max * (1.0 - 1e-5), ..*part };
    let longer = Ray { t_max: (part.t_max * (1.0 + 1e-5)).min(NO_LIMIT), ..*part };
    let leaves = |ray: &Ray| oracle.first_hit(ray).exit < f64::from(ray.t_max);
    truth.verdict == Verdict::Inside && leaves(&shorter) != leaves(&longer)
}

/// Whether f64 is promised to decide: balls are near enough, and none is flat where it touches T.
fn is_promised(scene: &Scene, ray: &Ray) -> bool {
    scene.balls().all(|ball| {
        let is_flat = scene.kernel() == Kernel::Perlin && ball.strength == scene.threshold();
        ball.center.distance(ray.origin) < 1e5 * ball.radius && !is_flat
    })
}

fn two_balls() -> Scene {
    let balls = [0.0, 0.8].map(|x| Metaball::new(Vec3::X * x, 1.0));
    Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal")
}

#[test]
fn wrong_answers_are_complained_of() {
    let scene = two_balls();
    let oracle = Oracle::new(&scene);
    let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
    let region = Region { planes: vec![(Vec3::NEG_Z, Vec3::Z * -0.3), (Vec3::Z, Vec3::Z * 0.3)] };
    let clipped =
        |clip| ClippedTracer::new(Tracer::new(&tree, &scene), clip).expect("a certified tree");
    let tracer = clipped(region.clip());
    let moved = Region { planes: vec![(Vec3::NEG_Z, Vec3::Z * -0.301), region.planes[1]] };
    for start in [Vec3::new(0.1, 0.2, -4.0), Vec3::new(0.1, 0.2, 0.1)] {
        let ray = Ray::new(start, Vec3::Z);
        let complaint = |answers: &Answers| complaint(&oracle, &region, &ray, answers);
        let right = Answers::of(&tracer, &ray);
        assert_eq!(complaint(&right), None);
        assert!(complaint(&Answers::of(&clipped(Clip::default()), &ray)).is_some());
        assert!(complaint(&Answers { hit: Hit::MISS, ..right }).is_some());
        assert!(complaint(&Answers { any: Verdict::Miss, ..right }).is_some());
        assert!(complaint(&Answers { exit: Hit::MISS, ..right }).is_some());
    }
    let ray = Ray::new(Vec3::new(0.1, 0.2, -4.0), Vec3::Z);
    let right = Answers::of(&tracer, &ray);
    assert!(complaint(&oracle, &moved, &ray, &right).is_some());
    for wrong in [
        Hit { verdict: Verdict::Inside, ..right.hit },
        Hit { normal: Vec3::Z, ..right.hit },
        Hit { t: right.hit.t + 1e-4, ..right.hit },
    ] {
        assert!(complaint(&oracle, &region, &ray, &Answers { hit: wrong, ..right }).is_some());
    }
}

#[test]
fn a_box_is_its_planes() {
    let scene = two_balls();
    let oracle = Oracle::new(&scene);
    let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
    let bounds = Aabb { min: Vec3::new(-0.4, -0.5, -0.2), max: Vec3::new(1.1, 0.3, 0.6) };
    let axes = Vec3::AXES.map(|axis| [(axis, bounds.max), (-axis, bounds.min)]);
    let region = Region { planes: axes.concat() };
    let clip = Clip::default().and_box(&bounds).expect("a box");
    let tracer = ClippedTracer::new(Tracer::new(&tree, &scene), clip).expect("a certified tree");
    for at in 0..400 {
        let start = Vec3::new((at % 20) as f32 / 8.0 - 1.0, (at / 20) as f32 / 10.0 - 1.0, -3.0);
        for direction in [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.36, 0.48, 0.8)] {
            let ray = Ray::new(start, direction);
            let found = complaint(&oracle, &region, &ray, &Answers::of(&tracer, &ray));
            assert_eq!(found, None);
        }
    }
}

#[test]
fn published_trees_are_not_cut() {
    let scene = two_balls();
    let tree = Tree::build(&scene, &Options::fitted()).expect("legal options");
    let clip = Clip::default().and_plane(Vec3::X, 0.5).expect("a plane");
    let found = tree.kind();
    let refused = ClippedTracer::new(Tracer::new(&tree, &scene), clip).err();
    assert_eq!(refused, Some(TraceError::ClipOfPublished { found }));
    let whole = ClippedTracer::new(Tracer::new(&tree, &scene), Clip::default());
    let ray = Ray::new(Vec3::Z * -4.0, Vec3::Z);
    let hit = whole.expect("nothing is cut").first_hit(&ray);
    assert_eq!(hit, Tracer::new(&tree, &scene).first_hit(&ray));
}

/// Answers as light asks for them.
fn answered(tracer: &ClippedTracer<'_, Scene>, query: RayQuery, rays: &[Ray]) -> Vec<SurfaceHit> {
    let mut answers = vec![SurfaceHit::MISS; rays.len()];
    tracer.answer(query, rays, &mut tracer.scratch(), &mut answers);
    answers
}

/// Starts at hits on faces, so many clearances along the normal, that lie on another side of a face than
/// they should: out of the region for rays that leave the solid, in it for those that go in.
fn starts_on_the_wrong_side(clearances: f32) -> usize {
    let scene = two_balls();
    let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
    let normal = Vec3::new(0.3, -0.4, 1.1);
    let clip = Clip::default().and_plane(normal, 0.123).expect("a plane");
    let tracer = ClippedTracer::new(Tracer::new(&tree, &scene), clip.clone()).expect("certified");
    let mut wrong = 0;
    for at in 0..1000u16 {
        let aside = Vec3::new(f32::from(at % 40) - 20.0, f32::from(at / 40) - 12.0, 0.0) / 60.0;
        let eye = Vec3::new(1.7, 2.3, 9.1) * f32::from(at % 7 + 1);
        let ray = Ray::new(eye, (aside - eye).normalize());
        let [found] = answered(&tracer, RayQuery::FirstHit, &[ray])[..] else {
            panic!("an answer")
        };
        assert!(clip.section(&ray).has_on_face(&found.hit), "{found:?}");
        let point = ray.origin + found.hit.t * ray.direction;
        let start = |side: f32| {
            point + side * clearances * tracer.clearance(&ray, &found) * found.hit.normal
        };
        let out = clip.section(&Ray::new(start(1.0), found.hit.normal));
        let within = clip.section(&Ray::new(start(-1.0), -found.hit.normal));
        wrong += usize::from(!out.ray.is_empty()) + usize::from(within.entry.is_some());
    }
    wrong
}

#[test]
fn rays_leave_a_face_on_their_side() {
    assert_eq!(starts_on_the_wrong_side(1.0), 0);
    assert!(starts_on_the_wrong_side(0.0) > 200);
}

fn point(half: f32) -> impl Strategy<Value = Vec3> {
    [-half..half, -half..half, -half..half].prop_map(Vec3::from)
}

/// Up to four planes, along the axes or not, through points among the balls.
fn region() -> impl Strategy<Value = Region> {
    let axes = prop::sample::select(vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z]);
    let any = point(2.0).prop_filter("a normal", |normal| normal.length() > 0.1);
    let plane = (prop_oneof![axes, any], point(3.0));
    prop::collection::vec(plane, 0..5).prop_map(|planes| Region { planes })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// From outside and inside of the region and the solid; alone, in packets, and in a picture.
    #[test]
    fn cut_solids_are_the_oracles(
        scene in scenes::any_signed_scene(40),
        region in region(),
        eye in point(6.0),
        targets in prop::collection::vec(point(3.0), 32),
        t_min in prop::sample::select(vec![0.0f32, 0.0, 3.0]),
    ) {
        let oracle = Oracle::new(&scene);
        let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
        let clip = region.clip();
        let tracer = ClippedTracer::new(Tracer::new(&tree, &scene), clip).expect("certified");
        let centers: Vec<Vec3> = scene.balls().map(|ball| ball.center).collect();
        let rays: Vec<Ray> = targets.iter().enumerate().map(|(at, &target)| {
            let center = centers.get(at / 4).copied().unwrap_or(target);
            let (start, end) = if at % 4 == 0 { (center, target) } else { (eye, center) };
            let offset = DVec3::from(end + 0.05 * (at % 4) as f32) - DVec3::from(start);
            Ray { t_min, ..Ray::new(start, offset.normalize_or(DVec3::X).as_vec3()) }
        }).collect();
        let [lit, shadows, onward] = RayQuery::ALL.map(|query| answered(&tracer, query, &rays));
        let lit = lit.iter().map(|found| found.hit).collect();
        let hits = [tracer.first_hits(&rays), tracer.picture_hits(&rays, 8), lit];
        let (any, exits) = (tracer.any_hits(&rays), tracer.first_exits(&rays).expect("certified"));
        for (at, ray) in rays.iter().enumerate() {
            let alone = Answers::of(&tracer, ray);
            let waves = (shadows[at].hit.verdict, onward[at].hit);
            for hit in [alone.hit, hits[0][at], hits[1][at], hits[2][at]] {
                for (any, exit) in [(alone.any, alone.exit), (any[at], exits[at]), waves] {
                    let answers = Answers { hit, any, exit };
                    let verdicts = [hit.verdict, any, exit.verdict];
                    if !is_promised(&scene, ray) && verdicts.contains(&Verdict::Undecided) {
                        continue;
                    }
                    let found = complaint(&oracle, &region, ray, &answers);
                    prop_assert!(found.is_none(), "{found:?}");
                }
            }
        }
    }
}
