//! Light on the CPU beside light on the adapter: the same answers to the very rays that the adapter's
//! path tracer made, and the same pictures.

use experiments::lit_twins::{LitDifference, lit_difference, lit_effects};
use fbvh::{Options, Tracer, Tree};
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::{Hit, HostTracer, RayQuery, Scene, SurfaceHit, Verdict};

use super::CERTIFIED;
use super::answers::Answered;
use super::effects::{EFFECTS, Effect, SCENES, last_rays};
use crate::trials::{load, on_gpu, view_of};

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for scene in SCENES {
        for (name, effect) in EFFECTS {
            let test = move |gpu: &'static Gpu| same_answers(gpu, scene, effect);
            trials.push(on_gpu(format!("light::host::{scene}::{name}"), test));
        }
    }
    for scene in ["random-200", "colors-100", "strengths-100", "eye-inside-surface"] {
        let test = move |gpu: &'static Gpu| same_pictures(gpu, scene);
        trials.push(on_gpu(format!("light::host::pictures::{scene}"), test));
    }
    trials.push(on_gpu("light::host::canary".to_owned(), other_answers_and_pictures_are_rejected));
    trials
}

/// An answer of the CPU, and its clearance.
#[derive(Debug, Clone, Copy)]
struct Found {
    hit: Hit,
    clearance: f32,
}

/// How answers differ.
#[derive(Debug, Default)]
struct Differences {
    verdicts: usize,
    /// Distances that differ by more than two floats.
    distances: usize,
    /// Of those, points that are farther apart along the normal than the hit's clearance.
    points: usize,
    compared: usize,
}

impl Differences {
    fn between(answered: &[Answered], found: &[Found]) -> Self {
        let mut differences = Self::default();
        for (Answered { ray, query, hit }, Found { hit: found, clearance }) in
            answered.iter().zip(found)
        {
            if hit.verdict == Verdict::Undecided {
                continue;
            }
            differences.compared += 1;
            if hit.verdict != found.verdict {
                differences.verdicts += 1;
            } else if *query != RayQuery::AnyHit && hit.verdict == Verdict::Hit {
                // Of the distance, and of the start of the ray, which it is counted from.
                let size = hit.t.abs().max(ray.origin.abs().max_element());
                let two = 2.0 * f32::EPSILON * size;
                let apart = (hit.t - found.t).abs();
                let along_normal = apart * found.normal.dot(ray.direction).abs();
                differences.distances += usize::from(apart > two);
                differences.points += usize::from(apart > two && along_normal > *clearance);
            }
        }
        differences
    }

    /// Where a ray grazes the surface, the adapter's f32 knows t less well than its point.
    fn pass(&self) -> Result<(), Failed> {
        let are_few = 50 * self.distances <= self.compared;
        let is_right = self.verdicts == 0 && self.points == 0 && are_few && self.compared > 50;
        is_right.then_some(()).ok_or_else(|| format!("{self:?}").into())
    }
}

fn on_host(scene: &Scene, answered: &[Answered]) -> Result<Vec<Found>, Failed> {
    let tree = Tree::build(scene, &Options::certified())?;
    let tracer = Tracer::new(&tree, scene);
    let mut scratch = tracer.scratch();
    let one = |one: &Answered| {
        let mut found = [SurfaceHit::MISS];
        tracer.answer(one.query, &[one.ray], &mut scratch, &mut found);
        Found { hit: found[0].hit, clearance: tracer.clearance(&one.ray, &found[0]) }
    };
    Ok(answered.iter().map(one).collect())
}

fn same_answers(gpu: &Gpu, scene: &str, effect: Effect) -> Result<(), Failed> {
    let bench = load(scene)?;
    let answered = last_rays(gpu, CERTIFIED, &bench.scene, &view_of(&bench)?, effect)?;
    Differences::between(&answered, &on_host(&bench.scene, &answered)?).pass()
}

fn same_pictures(gpu: &Gpu, scene: &str) -> Result<(), Failed> {
    let bench = load(scene)?;
    let (scene, view) = (&bench.scene, view_of(&bench)?);
    let mut failures = Vec::new();
    for effect in lit_effects(scene, &view) {
        let difference = lit_difference(gpu, scene, &view, &effect, (7, 7))?;
        let LitDifference { effect, pixels, apart, lacking, .. } = difference;
        if !difference.is_small() {
            failures.push(format!("{effect}: {apart} of {pixels} pixels"));
        }
        // From an eye in the solid, mirrored rays start beyond the surface that they seek.
        let is_from_within = bench.name == "eye-inside-surface";
        if !is_from_within && lacking > pixels / 100 {
            failures.push(format!("{effect}: the adapter lacks {lacking} pixels"));
        }
    }
    failures.is_empty().then_some(()).ok_or_else(|| failures.join("; ").into())
}

fn other_answers_and_pictures_are_rejected(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("random-200")?;
    let (scene, view) = (&bench.scene, view_of(&bench)?);
    let answered = last_rays(gpu, CERTIFIED, scene, &view, Effect::Reflection { level: 1 })?;
    let mut found = on_host(scene, &answered)?;
    for found in &mut found {
        found.hit.t *= 1.0 + 4e-6;
    }
    if Differences::between(&answered, &found).pass().is_ok() {
        return Err("distances off by four in a million passed".into());
    }
    found.rotate_right(1);
    if Differences::between(&answered, &found).pass().is_ok() {
        return Err("answers to other rays passed".into());
    }
    let [.., mirrors, _] = lit_effects(scene, &view);
    let difference = lit_difference(gpu, scene, &view, &mirrors, (8, 7))?;
    if difference.is_small() {
        return Err(format!("another seed: only {} pixels are apart", difference.apart).into());
    }
    Ok(())
}
