//! A scene with its rays, held against the oracle.

use anyhow::Context;
use bench_scenes::{Case, Random, arbitrary, carved, cases};
use fbvh::{Options, Tree};
use glam::Vec3;
use metaball_core::RayQuery;
use metaball_core::gpu::FreeRay;
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Camera, Hit, Ray, Scene, Verdict, View};

use super::adapter::{AdapterScene, AdapterTracer, SIDE};
use super::ray_distribution::{self as distribution, RayDistribution, SurfacePoint, TestRay};
use super::tally::{Check, Query, Tally, Tracer};
use crate::stability::limits::expected;
use crate::stability::outcome::Outcome;

/// A scene that is tried.
#[derive(Debug, Clone, Copy)]
pub enum TestScene {
    /// A stability case at one of its values.
    Case(&'static Case, f64),
    /// A scene of any kind, by seed.
    Arbitrary(u64),
    /// The same with a third of its balls negative.
    Carved(u64),
}

/// Which scenes are tried: the stability cases first, at all values at which nothing but right is
/// expected of the certified tree on the CPU, then without end scenes of any kind, every fourth with negative balls.
pub fn test_scenes(seed: u64, quick: bool) -> impl Iterator<Item = TestScene> {
    let of_case = move |case: &'static Case| {
        let values = if quick { case.quick } else { case.values };
        let holds = move |value: &f64| expected(ON_CPU, case, *value) == Outcome::Right;
        values.iter().copied().filter(holds).map(move |value| TestScene::Case(case, value))
    };
    // Neighbouring seeds have nothing in common, but ranges of them would overlap.
    let first = seed << 32;
    let by_seed = |seed: u64| match seed % CARVED_STEP {
        0 => TestScene::Carved(seed),
        _ => TestScene::Arbitrary(seed),
    };
    cases().iter().flat_map(of_case).chain((first + 1..).map(by_seed))
}

/// Every so-many-th scene by seed has negative balls.
const CARVED_STEP: u64 = 4;

/// The certified tree, as limits name it.
const ON_CPU: &str = "fbvh-certified-cpu";
const ON_ADAPTER: &str = "fbvh-certified";

/// The adapter traces every so-many-th ray too; of these, and on the CPU, every so-many-th queries any hit.
const ADAPTER_STEP: usize = 5;
const ANY_HIT_STEP: usize = 4;

/// Pixels of a picture.
const PIXELS: usize = SIDE as usize * SIDE as usize;

/// Points of the surface that tangents and exits start from, at most.
const MOST_SURFACE_POINTS: usize = 4096;

impl TestScene {
    /// As records name it.
    pub fn name(&self) -> String {
        match self {
            Self::Case(case, value) => format!("{}={value}", case.name),
            Self::Arbitrary(seed) => format!("arbitrary({seed})"),
            Self::Carved(seed) => format!("carved({seed})"),
        }
    }

    /// How many rays it gets of a wanted number: fewer where thousands of balls on each ray would keep the
    /// oracle for minutes.
    pub fn rays(&self, wanted: usize, scene: &Scene) -> usize {
        /// Balls times rays of a case: a second or two.
        const CASE_WORK: usize = 3_000_000;
        match self {
            Self::Case(..) => (wanted / 4).min(CASE_WORK / scene.len().max(1)),
            Self::Arbitrary(_) | Self::Carved(_) => wanted,
        }
    }

    /// Whether the shaders are held to it.
    fn is_for_adapter(&self) -> bool {
        match self {
            Self::Case(case, value) => expected(ON_ADAPTER, case, *value) == Outcome::Right,
            Self::Arbitrary(_) => true,
            // Negative balls are the CPU's alone.
            Self::Carved(_) => false,
        }
    }

    /// Its scene, and a camera to see it with.
    ///
    /// # Errors
    /// When a case makes no scene, which none of its values does.
    pub fn scene(&self) -> anyhow::Result<(Scene, Camera)> {
        match self {
            Self::Case(case, value) => {
                let (bench, view) = case.view(*value)?;
                Ok((bench.scene, *view.camera()))
            }
            Self::Arbitrary(seed) | Self::Carved(seed) => {
                let scene = match self {
                    Self::Carved(_) => carved(*seed)?,
                    _ => arbitrary(*seed)?,
                };
                let camera = distribution::camera(&scene, &mut Random::new(!seed));
                let framing = || Camera::framing(&scene.bounds(), Vec3::ONE);
                let camera = camera.unwrap_or_else(framing);
                Ok((scene, camera))
            }
        }
    }

    /// Sends about so many rays through the certified tree on the CPU, a third of them on the adapter too if
    /// it is to be right there, and counts the answers.
    ///
    /// # Errors
    /// When the tree cannot be built, or the device fails.
    pub fn check(
        &self,
        wanted: usize,
        adapter: Option<&mut AdapterTracer<'_>>,
    ) -> anyhow::Result<Tally> {
        let (scene, camera) = self.scene()?;
        let name = self.name();
        let oracle = Oracle::new(&scene);
        let tree = Tree::build(&scene, &Options::certified()).with_context(|| name.clone())?;
        let tracer = fbvh::Tracer::new(&tree, &scene);
        let mut on_adapter = adapter
            .filter(|_| self.is_for_adapter())
            .map(|adapter| adapter.build(&scene))
            .transpose()
            .with_context(|| name.clone())?;
        let rays = self.rays(wanted, &scene);

        let picture = Picture::new(camera, rays / 6, on_adapter.as_mut())?;
        let mut random = Random::new(seed_of(&name));
        let rays = Rays::new((&scene, &tree, &oracle), picture.rays, rays, &mut random);
        let mut tally = Tally::default();
        let answers = Answers {
            first_hits: first_hits(&tracer, &rays),
            any_hits: tracer.any_hits(&rays.any()),
            exits: tracer.first_exits(&rays.exits())?,
        };
        let check = Check {
            test_scene: &name,
            scene: &scene,
            oracle: &oracle,
            tracer: Tracer::Cpu,
            query: Query::FirstHit,
        };
        rays.count(&check, &answers, &mut tally);
        if let Some(on_adapter) = &mut on_adapter {
            let check = Check { tracer: Tracer::Adapter, ..check };
            rays.count_picture(&check, &picture.hits, &mut tally);
            rays.count_batch(&check, |batch| on_adapter.answers(camera, batch), &mut tally)?;
        }
        Ok(tally)
    }
}

/// The first hit of every ray; of a whole picture as the CPU draws one.
fn first_hits(tracer: &fbvh::Tracer<'_, Scene>, rays: &Rays) -> Vec<Hit> {
    let all = rays.first();
    let (picture, free) = all.split_at(rays.free);
    let mut hits = if picture.len() == PIXELS {
        tracer.picture_hits(picture, SIDE as usize)
    } else {
        tracer.first_hits(picture)
    };
    hits.extend(tracer.first_hits(free));
    hits
}

/// A number from a name (Fowler, Noll and Vo's FNV-1a).
fn seed_of(name: &str) -> u64 {
    name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Pixels of a picture, spread evenly, and what the adapter found there.
struct Picture {
    rays: Vec<Ray>,
    hits: Vec<Hit>,
}

impl Picture {
    fn new(
        camera: Camera,
        most: usize,
        on_adapter: Option<&mut AdapterScene<'_>>,
    ) -> anyhow::Result<Self> {
        let (rays, hits) = match on_adapter {
            Some(on_adapter) => on_adapter.picture(camera)?,
            None => (View::new(camera, SIDE, SIDE)?.rays(), Vec::new()),
        };
        let count = most.min(rays.len());
        let pixels = (0..count).map(|index| index * rays.len() / count);
        let hits = if hits.is_empty() { hits } else { pixels.clone().map(|p| hits[p]).collect() };
        Ok(Self { rays: pixels.map(|pixel| rays[pixel]).collect(), hits })
    }
}

/// The rays of a test scene with the truth about each: a picture's first, exits last.
struct Rays {
    rays: Vec<(TestRay, Truth)>,
    /// Where those of the picture end, and where those that seek an exit begin.
    free: usize,
    exits: usize,
}

/// What a tracer answered: one answer to each of [`Rays::first`], [`Rays::any`] and [`Rays::exits`].
struct Answers {
    first_hits: Vec<Hit>,
    any_hits: Vec<Verdict>,
    exits: Vec<Hit>,
}

impl Rays {
    /// About so many rays, the picture's among them.
    fn new(
        (scene, tree, oracle): (&Scene, &Tree, &Oracle<'_>),
        picture: Vec<Ray>,
        rays: usize,
        random: &mut Random,
    ) -> Self {
        let with_truth = |made: Vec<TestRay>| {
            let rays: Vec<_> = made.iter().map(|made| made.ray).collect();
            made.into_iter().zip(oracle.first_hits(&rays)).collect::<Vec<_>>()
        };
        let free = picture.len();
        let mut made: Vec<_> = picture.into_iter().map(distribution::of_picture).collect();
        if !scene.is_empty() {
            made.extend((0..rays / 6).map(|_| distribution::at_ball(scene, random)));
        }
        let mut all = with_truth(made);

        let point = |(made, truth): &(TestRay, Truth)| SurfacePoint::new(&made.ray, truth);
        let points: Vec<_> = all.iter().filter_map(point).collect();
        let step = points.len().div_ceil(MOST_SURFACE_POINTS).max(1);
        let points: Vec<_> = points.iter().step_by(step).collect();
        let mut made = Vec::new();
        if !points.is_empty() {
            let tangent = |_| distribution::along_surface(random.one_of(&points), random);
            made.extend((0..rays / 3).map(tangent));
        }
        if tree.leaf_count() > 0 && !tree.is_empty() {
            made.extend((0..rays / 5).map(|_| distribution::along_face(scene, tree, random)));
        }
        let exits = all.len() + made.len();
        if !points.is_empty() {
            let exit = |_| distribution::from_inside(random.one_of(&points), random);
            made.extend((0..rays / 8).map(exit));
        }
        all.extend(with_truth(made));
        Self { rays: all, free, exits }
    }

    fn rays_of(rays: &[(TestRay, Truth)]) -> impl Iterator<Item = Ray> {
        rays.iter().map(|(made, _)| made.ray)
    }

    /// Those whose first hit is queried: all.
    fn first(&self) -> Vec<Ray> {
        Self::rays_of(&self.rays).collect()
    }

    /// Those of which any hit is queried.
    fn any(&self) -> Vec<Ray> {
        Self::rays_of(&self.rays[..self.exits]).step_by(ANY_HIT_STEP).collect()
    }

    /// Those whose exit is queried.
    fn exits(&self) -> Vec<Ray> {
        Self::rays_of(&self.rays[self.exits..]).collect()
    }

    /// Counts a tracer's answers to all queries.
    fn count(&self, check: &Check<'_>, answers: &Answers, tally: &mut Tally) {
        for ((ray, truth), hit) in self.rays.iter().zip(&answers.first_hits) {
            tally.count(&Check { query: Query::FirstHit, ..*check }, ray, truth, hit);
        }
        let any = self.rays[..self.exits].iter().step_by(ANY_HIT_STEP);
        for ((ray, truth), &verdict) in any.zip(&answers.any_hits) {
            let hit = Hit { verdict, ..Hit::MISS };
            tally.count(&Check { query: Query::AnyHit, ..*check }, ray, truth, &hit);
        }
        for ((ray, truth), hit) in self.rays[self.exits..].iter().zip(&answers.exits) {
            tally.count(&Check { query: Query::Exit, ..*check }, ray, truth, hit);
        }
    }

    /// Counts the hits of a picture.
    fn count_picture(&self, check: &Check<'_>, hits: &[Hit], tally: &mut Tally) {
        for ((ray, truth), hit) in self.rays[..self.free].iter().zip(hits) {
            tally.count(&Check { query: Query::FirstHit, ..*check }, ray, truth, hit);
        }
    }

    /// Traces some of the free rays as one batch, each with its own query, and counts the answers.
    fn count_batch(
        &self,
        check: &Check<'_>,
        mut answer: impl FnMut(&[FreeRay]) -> anyhow::Result<Vec<Hit>>,
        tally: &mut Tally,
    ) -> anyhow::Result<()> {
        let some: Vec<_> =
            self.rays[self.free..].iter().step_by(ADAPTER_STEP).take(PIXELS).collect();
        let query = |index: usize, ray: &TestRay| match ray.distribution {
            RayDistribution::Exit => RayQuery::Exit,
            _ if index.is_multiple_of(ANY_HIT_STEP) => RayQuery::AnyHit,
            _ => RayQuery::FirstHit,
        };
        let free = |(index, (ray, _)): (usize, &&(TestRay, Truth))| {
            FreeRay::new(&ray.ray, query(index, ray)).expect("a ray from its origin")
        };
        let batch: Vec<_> = some.iter().enumerate().map(free).collect();
        let hits = answer(&batch)?;
        for (index, ((ray, truth), hit)) in some.iter().zip(&hits).enumerate() {
            let query = query(index, ray).into();
            tally.count(&Check { query, ..*check }, ray, truth, hit);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use harness::fronts::WRONG_FRONT;
    use metaball_core::Metaball;

    use super::*;

    /// A scene with its rays and the answers of its own tree.
    struct Sample {
        scene: Scene,
        rays: Rays,
        answers: Answers,
    }

    fn answers(scene: &Scene, rays: &Rays) -> Answers {
        let tree = Tree::build(scene, &Options::certified()).expect("a tree");
        let tracer = fbvh::Tracer::new(&tree, scene);
        Answers {
            first_hits: first_hits(&tracer, rays),
            any_hits: tracer.any_hits(&rays.any()),
            exits: tracer.first_exits(&rays.exits()).expect("certified"),
        }
    }

    fn sample() -> Sample {
        sample_of(TestScene::Arbitrary(3))
    }

    fn sample_of(test_scene: TestScene) -> Sample {
        let (scene, camera) = test_scene.scene().expect("legal");
        let tree = Tree::build(&scene, &Options::certified()).expect("a tree");
        let picture = Picture::new(camera, 500, None).expect("a view");
        let oracle = Oracle::new(&scene);
        let rays = Rays::new((&scene, &tree, &oracle), picture.rays, 3000, &mut Random::new(1));
        let answers = answers(&scene, &rays);
        Sample { scene, rays, answers }
    }

    /// Wrong answers, and the sum of squares of relative errors.
    fn verdict(sample: &Sample, answers: &Answers) -> (u64, f64) {
        let oracle = Oracle::new(&sample.scene);
        let (test_scene, scene, oracle) = ("sample", &sample.scene, &oracle);
        let (tracer, query) = (Tracer::Cpu, Query::FirstHit);
        let mut tally = Tally::default();
        sample.rays.count(&Check { test_scene, scene, oracle, tracer, query }, answers, &mut tally);
        let wrong: u64 = tally.counts.values().map(|count| count.wrong).sum();
        assert_eq!(tally.wrong.len() as u64, wrong.min(200));
        (wrong, tally.errors.values().map(|errors| errors.squares).sum())
    }

    #[test]
    fn negative_balls_are_taken_away_and_missed_where_they_are_not() {
        let sample = sample_of(TestScene::Carved(4));
        assert!(sample.scene.len() > 20 && sample.scene.negative_ball().is_some());
        assert_eq!(verdict(&sample, &sample.answers).0, 0);

        let spoilt = |balls: Vec<Metaball>| {
            let scene = Scene::new(balls, sample.scene.kernel(), sample.scene.threshold());
            verdict(&sample, &answers(&scene.expect("legal"), &sample.rays)).0
        };
        let positive = sample.scene.balls().filter(|ball| !ball.is_negative());
        assert!(spoilt(positive.collect()) > 0, "nothing is taken away");
        let weaker = sample.scene.balls().map(|ball| match ball.is_negative() {
            true => Metaball { strength: 0.9 * ball.strength, ..ball },
            false => ball,
        });
        assert!(spoilt(weaker.collect()) > 0, "a tenth less is taken away");
    }

    #[test]
    fn a_tree_is_right_and_a_spoilt_one_is_not() {
        let sample = sample();
        let right = verdict(&sample, &sample.answers);
        assert_eq!(right.0, 0);

        // The tree without its first ball: leaves are missing or short of a ball.
        let balls = sample.scene.balls().skip(1);
        let without = Scene::new(balls, sample.scene.kernel(), sample.scene.threshold());
        let without = without.expect("legal");
        assert!(verdict(&sample, &answers(&without, &sample.rays)).0 > 0, "a ball is missing");

        let spoilt = |spoil: fn(&mut Hit, &Truth)| {
            let mut answers = answers(&sample.scene, &sample.rays);
            let truths = sample.rays.rays.iter().map(|(_, truth)| truth);
            for (hit, truth) in answers.first_hits.iter_mut().zip(truths) {
                spoil(hit, truth);
            }
            verdict(&sample, &answers)
        };
        let nudged = spoilt(|hit, _| hit.t *= 1.0 + 1e-4);
        assert!(nudged.1 > 1e3 * right.1, "{nudged:?}, {right:?}");
        let shifted =
            spoilt(|hit, truth| hit.t += 2.0 * WRONG_FRONT as f32 * truth.smallest_radius);
        assert!(shifted.0 > 0, "on another front");
        assert!(spoilt(|hit, _| *hit = Hit::MISS).0 > 0, "nothing is hit");

        let mut answers = answers(&sample.scene, &sample.rays);
        answers.any_hits.rotate_right(1);
        assert!(verdict(&sample, &answers).0 > 0, "answers to other rays");
        answers.any_hits.rotate_left(1);
        answers.exits.rotate_right(1);
        assert!(verdict(&sample, &answers).0 > 0, "exits of other rays");
    }

    #[test]
    fn a_batch_is_checked_ray_by_ray() {
        let sample = sample();
        let oracle = Oracle::new(&sample.scene);
        let tree = Tree::build(&sample.scene, &Options::certified()).expect("a tree");
        let tracer = fbvh::Tracer::new(&tree, &sample.scene);
        let answer = |free: &FreeRay| match free.query().expect("a query") {
            RayQuery::Exit => tracer.first_exit(&free.ray()).expect("certified"),
            RayQuery::FirstHit => tracer.first_hit(&free.ray()),
            RayQuery::AnyHit => Hit { verdict: tracer.any_hit(&free.ray()), ..Hit::MISS },
        };
        let wrong = |turned: usize| {
            let check = Check {
                test_scene: "sample",
                scene: &sample.scene,
                oracle: &oracle,
                tracer: Tracer::Adapter,
                query: Query::FirstHit,
            };
            let mut tally = Tally::default();
            let answers = |batch: &[FreeRay]| {
                let mut hits: Vec<_> = batch.iter().map(answer).collect();
                hits.rotate_right(turned);
                Ok(hits)
            };
            sample.rays.count_batch(&check, answers, &mut tally).expect("counted");
            let queries: BTreeSet<_> = tally.counts.keys().map(|key| key.query).collect();
            assert_eq!(queries.len(), 3);
            tally.counts.values().map(|count| count.wrong).sum::<u64>()
        };
        assert_eq!(wrong(0), 0);
        assert!(wrong(1) > 0);
    }

    #[test]
    fn rays_are_as_near_as_meant() {
        let sample = sample();
        let near = |distribution: RayDistribution| {
            let of_it = |(ray, _): &&(TestRay, Truth)| ray.distribution == distribution;
            let made = || sample.rays.rays.iter().filter(of_it);
            let near = made().filter(|(ray, truth)| ray.is_near(truth)).count();
            near as f64 / made().count() as f64
        };
        assert!(near(RayDistribution::Tangent) > 0.3, "{}", near(RayDistribution::Tangent));
        assert!(near(RayDistribution::Face) > 0.6, "{}", near(RayDistribution::Face));
        let exits = &sample.rays.rays[sample.rays.exits..];
        let inside = exits.iter().filter(|(_, truth)| truth.verdict == Verdict::Inside).count();
        assert!(inside * 10 > exits.len() * 9, "{inside} of {}", exits.len());
    }

    #[test]
    fn test_scenes_begin_with_the_cases_and_do_not_end() {
        let all: Vec<_> = test_scenes(1, false).take(400).map(|scene| scene.name()).collect();
        assert!(all.contains(&"coincident=4096".to_owned()));
        assert!(!all.contains(&"distance=1000000".to_owned()), "beyond the stated limits");
        let by_seed = &all[all.len() - 8..];
        let count = |of: &str| by_seed.iter().filter(|name| name.starts_with(of)).count();
        assert_eq!((count("arbitrary("), count("carved(")), (6, 2));
        let first =
            |seed| test_scenes(seed, true).find(|scene| matches!(scene, TestScene::Arbitrary(_)));
        assert_ne!(first(1).map(|scene| scene.name()), first(2).map(|scene| scene.name()));
    }
}
