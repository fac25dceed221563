//! One scene with its rays, held against the oracle.

use anyhow::Context;
use bench_scenes::{Case, Random, arbitrary, cases};
use fbvh::{Options, Tree};
use glam::Vec3;
use metaball_core::gpu::{FreeRay, RayQuery};
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Camera, Hit, Ray, Scene, Verdict, View};

use super::aim::{self, Aim, Aimed, Anchor};
use super::card::{Card, SIDE, Session};
use super::tally::{Exam, Question, Tally, Tracer};
use crate::stability::cell::Outcome;
use crate::stability::limits::expected;

/// A scene that is tried.
#[derive(Debug, Clone, Copy)]
pub enum Shard {
    /// A stability case at one of its values.
    Case(&'static Case, f64),
    /// A scene of any kind, by seed.
    Arbitrary(u64),
}

/// Which scenes are tried: the stability cases first, at all values at which nothing but right is
/// expected of the certified tree, then without end scenes of any kind.
pub fn shards(seed: u64, quick: bool) -> impl Iterator<Item = Shard> {
    let of_case = move |case: &'static Case| {
        let values = if quick { case.quick } else { case.values };
        let holds = move |value: &f64| expected(CERTIFIED, case, *value) == Outcome::Right;
        values.iter().copied().filter(holds).map(move |value| Shard::Case(case, value))
    };
    // Seeds beside each other have nothing in common, but ranges of them would overlap.
    let first = seed << 32;
    cases().iter().flat_map(of_case).chain((first..).map(Shard::Arbitrary))
}

const CERTIFIED: &str = "fbvh-certified";

/// Every how many rays are asked of the adapter too, and every how many whether there is any hit.
const ADAPTER_STEP: usize = 5;
const ANY_HIT_STEP: usize = 4;

/// Pixels of a picture.
const PIXELS: usize = SIDE as usize * SIDE as usize;

/// Points of the surface that tangents and exits set out from, at most.
const MOST_ANCHORS: usize = 4096;

impl Shard {
    /// As records name it.
    pub fn name(&self) -> String {
        match self {
            Self::Case(case, value) => format!("{}={value}", case.name),
            Self::Arbitrary(seed) => format!("arbitrary({seed})"),
        }
    }

    /// How many rays it gets of a wanted number: fewer where thousands of balls on each ray would keep the
    /// oracle for minutes.
    pub fn rays(&self, wanted: usize, scene: &Scene) -> usize {
        /// Balls times rays of a case: a second or two.
        const CASE_WORK: usize = 3_000_000;
        match self {
            Self::Case(..) => (wanted / 4).min(CASE_WORK / scene.len().max(1)),
            Self::Arbitrary(_) => wanted,
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
            Self::Arbitrary(seed) => {
                let scene = arbitrary(*seed)?;
                let camera = aim::camera(&scene, &mut Random::new(!seed));
                let framing = || Camera::framing(&scene.bounds(), Vec3::ONE);
                let camera = camera.unwrap_or_else(framing);
                Ok((scene, camera))
            }
        }
    }

    /// Sends about so many rays through the certified tree on the CPU, a third of them on the adapter too,
    /// and counts the answers.
    ///
    /// # Errors
    /// When the tree cannot be built, or the device fails.
    pub fn hold(&self, wanted: usize, card: Option<&mut Card<'_>>) -> anyhow::Result<Tally> {
        let (scene, camera) = self.scene()?;
        let name = self.name();
        let oracle = Oracle::new(&scene);
        let tree = Tree::build(&scene, &Options::certified()).with_context(|| name.clone())?;
        let tracer = fbvh::Tracer::new(&tree, &scene);
        let mut session =
            card.map(|card| card.build(&scene)).transpose().with_context(|| name.clone())?;
        let rays = self.rays(wanted, &scene);

        let picture = Picture::new(camera, rays / 6, session.as_mut())?;
        let mut random = Random::new(seed_of(&name));
        let rays = Rays::new((&scene, &tree, &oracle), picture.rays, rays, &mut random);
        let mut tally = Tally::default();
        let answers = Answers {
            first_hits: first_hits(&tracer, &rays),
            any_hits: tracer.any_hits(&rays.any()),
            exits: tracer.first_exits(&rays.exits())?,
        };
        let exam = Exam {
            shard: &name,
            scene: &scene,
            oracle: &oracle,
            tracer: Tracer::Cpu,
            question: Question::FirstHit,
        };
        rays.count(&exam, &answers, &mut tally);
        if let Some(session) = &mut session {
            let exam = Exam { tracer: Tracer::Adapter, ..exam };
            rays.count_picture(&exam, &picture.hits, &mut tally);
            rays.count_batch(&exam, |batch| session.answers(camera, batch), &mut tally)?;
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
    fn new(camera: Camera, most: usize, session: Option<&mut Session<'_>>) -> anyhow::Result<Self> {
        let (rays, hits) = match session {
            Some(session) => session.picture(camera)?,
            None => (View::new(camera, SIDE, SIDE)?.rays(), Vec::new()),
        };
        let count = most.min(rays.len());
        let pixels = (0..count).map(|index| index * rays.len() / count);
        let hits = if hits.is_empty() { hits } else { pixels.clone().map(|p| hits[p]).collect() };
        Ok(Self { rays: pixels.map(|pixel| rays[pixel]).collect(), hits })
    }
}

/// The rays of a shard with the truth about each: a picture's first, exits last.
struct Rays {
    rays: Vec<(Aimed, Truth)>,
    /// Where those of the picture end, and where those that seek the way out begin.
    free: usize,
    exits: usize,
}

/// What a tracer said: one answer to each of [`Rays::first`], [`Rays::any`] and [`Rays::exits`].
struct Answers {
    first_hits: Vec<Hit>,
    any_hits: Vec<Verdict>,
    exits: Vec<Hit>,
}

impl Rays {
    /// Aims about so many rays, the picture's among them.
    fn new(
        (scene, tree, oracle): (&Scene, &Tree, &Oracle<'_>),
        picture: Vec<Ray>,
        rays: usize,
        random: &mut Random,
    ) -> Self {
        let ask = |aimed: Vec<Aimed>| {
            let rays: Vec<_> = aimed.iter().map(|aimed| aimed.ray).collect();
            aimed.into_iter().zip(oracle.first_hits(&rays)).collect::<Vec<_>>()
        };
        let free = picture.len();
        let mut aimed: Vec<_> = picture.into_iter().map(aim::of_picture).collect();
        if !scene.is_empty() {
            aimed.extend((0..rays / 6).map(|_| aim::at_ball(scene, random)));
        }
        let mut all = ask(aimed);

        let anchor = |(aimed, truth): &(Aimed, Truth)| Anchor::new(&aimed.ray, truth);
        let anchors: Vec<_> = all.iter().filter_map(anchor).collect();
        let anchors: Vec<_> =
            anchors.iter().step_by(anchors.len().div_ceil(MOST_ANCHORS).max(1)).collect();
        let mut aimed = Vec::new();
        if !anchors.is_empty() {
            aimed
                .extend((0..rays / 3).map(|_| aim::along_surface(random.one_of(&anchors), random)));
        }
        if tree.leaf_count() > 0 && !tree.is_empty() {
            aimed.extend((0..rays / 5).map(|_| aim::along_face(scene, tree, random)));
        }
        let exits = all.len() + aimed.len();
        if !anchors.is_empty() {
            aimed.extend((0..rays / 8).map(|_| aim::way_out(random.one_of(&anchors), random)));
        }
        all.extend(ask(aimed));
        Self { rays: all, free, exits }
    }

    fn rays_of(rays: &[(Aimed, Truth)]) -> impl Iterator<Item = Ray> {
        rays.iter().map(|(aimed, _)| aimed.ray)
    }

    /// Those that are asked where they first hit: all.
    fn first(&self) -> Vec<Ray> {
        Self::rays_of(&self.rays).collect()
    }

    /// Those that are asked whether there is any hit.
    fn any(&self) -> Vec<Ray> {
        Self::rays_of(&self.rays[..self.exits]).step_by(ANY_HIT_STEP).collect()
    }

    /// Those that are asked for the way out.
    fn exits(&self) -> Vec<Ray> {
        Self::rays_of(&self.rays[self.exits..]).collect()
    }

    /// Counts a tracer's answers to all questions.
    fn count(&self, exam: &Exam<'_>, answers: &Answers, tally: &mut Tally) {
        for ((aimed, truth), hit) in self.rays.iter().zip(&answers.first_hits) {
            tally.count(&Exam { question: Question::FirstHit, ..*exam }, aimed, truth, hit);
        }
        let any = self.rays[..self.exits].iter().step_by(ANY_HIT_STEP);
        for ((aimed, truth), &verdict) in any.zip(&answers.any_hits) {
            let hit = Hit { verdict, ..Hit::MISS };
            tally.count(&Exam { question: Question::AnyHit, ..*exam }, aimed, truth, &hit);
        }
        for ((aimed, truth), hit) in self.rays[self.exits..].iter().zip(&answers.exits) {
            tally.count(&Exam { question: Question::Exit, ..*exam }, aimed, truth, hit);
        }
    }

    /// Counts the hits of a picture.
    fn count_picture(&self, exam: &Exam<'_>, hits: &[Hit], tally: &mut Tally) {
        for ((aimed, truth), hit) in self.rays[..self.free].iter().zip(hits) {
            tally.count(&Exam { question: Question::FirstHit, ..*exam }, aimed, truth, hit);
        }
    }

    /// Asks some of the free rays as one batch, each its own question, and counts the answers.
    fn count_batch(
        &self,
        exam: &Exam<'_>,
        mut answer: impl FnMut(&[FreeRay]) -> anyhow::Result<Vec<Hit>>,
        tally: &mut Tally,
    ) -> anyhow::Result<()> {
        let some: Vec<_> =
            self.rays[self.free..].iter().step_by(ADAPTER_STEP).take(PIXELS).collect();
        let question = |index: usize, aimed: &Aimed| match aimed.aim {
            Aim::Exit => RayQuery::Exit,
            _ if index.is_multiple_of(ANY_HIT_STEP) => RayQuery::AnyHit,
            _ => RayQuery::FirstHit,
        };
        let ask = |(index, (aimed, _)): (usize, &&(Aimed, Truth))| {
            FreeRay::new(&aimed.ray, question(index, aimed))
        };
        let batch: Vec<_> = some.iter().enumerate().map(ask).collect();
        let hits = answer(&batch)?;
        for (index, ((aimed, truth), hit)) in some.iter().zip(&hits).enumerate() {
            let question = match question(index, aimed) {
                RayQuery::FirstHit => Question::FirstHit,
                RayQuery::AnyHit => Question::AnyHit,
                RayQuery::Exit => Question::Exit,
            };
            tally.count(&Exam { question, ..*exam }, aimed, truth, hit);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use harness::fronts::WRONG_FRONT;

    /// A scene of seed 3 with its rays and the answers of its own tree.
    struct Trial {
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

    fn trial() -> Trial {
        let (scene, camera) = Shard::Arbitrary(3).scene().expect("legal");
        let tree = Tree::build(&scene, &Options::certified()).expect("a tree");
        let picture = Picture::new(camera, 500, None).expect("a view");
        let oracle = Oracle::new(&scene);
        let rays = Rays::new((&scene, &tree, &oracle), picture.rays, 3000, &mut Random::new(1));
        let answers = answers(&scene, &rays);
        Trial { scene, rays, answers }
    }

    /// Wrong answers, and the sum of squares of relative errors.
    fn verdict(trial: &Trial, answers: &Answers) -> (u64, f64) {
        let oracle = Oracle::new(&trial.scene);
        let (shard, scene, oracle) = ("trial", &trial.scene, &oracle);
        let (tracer, question) = (Tracer::Cpu, Question::FirstHit);
        let mut tally = Tally::default();
        trial.rays.count(&Exam { shard, scene, oracle, tracer, question }, answers, &mut tally);
        let wrong: u64 = tally.counts.values().map(|count| count.wrong).sum();
        assert_eq!(tally.wrong.len() as u64, wrong.min(200));
        (wrong, tally.errors.values().map(|errors| errors.squares).sum())
    }

    #[test]
    fn a_tree_is_right_and_a_spoilt_one_is_not() {
        let trial = trial();
        let right = verdict(&trial, &trial.answers);
        assert_eq!(right.0, 0);

        // The tree without its first ball: leaves are missing or short of a ball.
        let balls = trial.scene.balls().skip(1);
        let without = Scene::new(balls, trial.scene.kernel(), trial.scene.threshold());
        let without = without.expect("legal");
        assert!(verdict(&trial, &answers(&without, &trial.rays)).0 > 0, "a ball is missing");

        let spoilt = |spoil: fn(&mut Hit, &Truth)| {
            let mut answers = answers(&trial.scene, &trial.rays);
            let truths = trial.rays.rays.iter().map(|(_, truth)| truth);
            for (hit, truth) in answers.first_hits.iter_mut().zip(truths) {
                spoil(hit, truth);
            }
            verdict(&trial, &answers)
        };
        let nudged = spoilt(|hit, _| hit.t *= 1.0 + 1e-4);
        assert!(nudged.1 > 1e3 * right.1, "{nudged:?}, {right:?}");
        let shifted =
            spoilt(|hit, truth| hit.t += 2.0 * WRONG_FRONT as f32 * truth.smallest_radius);
        assert!(shifted.0 > 0, "on another front");
        assert!(spoilt(|hit, _| *hit = Hit::MISS).0 > 0, "nothing is hit");

        let mut answers = answers(&trial.scene, &trial.rays);
        answers.any_hits.rotate_right(1);
        assert!(verdict(&trial, &answers).0 > 0, "answers to other rays");
        answers.any_hits.rotate_left(1);
        answers.exits.rotate_right(1);
        assert!(verdict(&trial, &answers).0 > 0, "ways out of other rays");
    }

    #[test]
    fn a_batch_is_held_ray_by_ray() {
        let trial = trial();
        let oracle = Oracle::new(&trial.scene);
        let tree = Tree::build(&trial.scene, &Options::certified()).expect("a tree");
        let tracer = fbvh::Tracer::new(&tree, &trial.scene);
        let answer = |free: &FreeRay| match free.query().expect("asked") {
            RayQuery::Exit => tracer.first_exit(&free.ray()).expect("certified"),
            RayQuery::FirstHit => tracer.first_hit(&free.ray()),
            RayQuery::AnyHit => Hit { verdict: tracer.any_hit(&free.ray()), ..Hit::MISS },
        };
        let wrong = |turned: usize| {
            let exam = Exam {
                shard: "trial",
                scene: &trial.scene,
                oracle: &oracle,
                tracer: Tracer::Adapter,
                question: Question::FirstHit,
            };
            let mut tally = Tally::default();
            let answers = |batch: &[FreeRay]| {
                let mut hits: Vec<_> = batch.iter().map(answer).collect();
                hits.rotate_right(turned);
                Ok(hits)
            };
            trial.rays.count_batch(&exam, answers, &mut tally).expect("counted");
            let questions: BTreeSet<_> = tally.counts.keys().map(|key| key.question).collect();
            assert_eq!(questions.len(), 3);
            tally.counts.values().map(|count| count.wrong).sum::<u64>()
        };
        assert_eq!(wrong(0), 0);
        assert!(wrong(1) > 0);
    }

    #[test]
    fn aims_are_met() {
        let trial = trial();
        let near = |aim: Aim| {
            let aimed = || trial.rays.rays.iter().filter(|(aimed, _)| aimed.aim == aim);
            let near = aimed().filter(|(aimed, truth)| aimed.is_near(truth)).count();
            near as f64 / aimed().count() as f64
        };
        assert!(near(Aim::Tangent) > 0.3, "{}", near(Aim::Tangent));
        assert!(near(Aim::Face) > 0.6, "{}", near(Aim::Face));
        let exits = &trial.rays.rays[trial.rays.exits..];
        let inside = exits.iter().filter(|(_, truth)| truth.verdict == Verdict::Inside).count();
        assert!(inside * 10 > exits.len() * 9, "{inside} of {}", exits.len());
    }

    #[test]
    fn shards_begin_with_the_cases_and_do_not_end() {
        let all: Vec<_> = shards(1, false).take(400).map(|shard| shard.name()).collect();
        assert!(all.contains(&"coincident=4096".to_owned()));
        assert!(!all.contains(&"distance=1000000".to_owned()), "beyond the stated limits");
        assert_eq!(all.last().map(|name| name.starts_with("arbitrary(")), Some(true));
        let first = |seed| shards(seed, true).find(|shard| matches!(shard, Shard::Arbitrary(_)));
        assert_ne!(first(1).map(|shard| shard.name()), first(2).map(|shard| shard.name()));
    }
}
