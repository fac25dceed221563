//! Light on the CPU beside light on the adapter: the same answers to the very rays that the adapter's
//! path tracer made, and the same pictures.

use fbvh::{Options, Tracer, Tree};
use glam::Vec3;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::{Hit, HostTracer, Image, NO_LIMIT, RayQuery, Scene, SurfaceHit, Verdict, View};
use metaball_light::{Effects, Film, Lamp, Occlusion, Surface, cpu, gpu};

use super::CERTIFIED;
use super::answers::Answered;
use super::effects::{EFFECTS, Effect, SCENES, floor_below, last_rays};
use crate::trials::{load, on_adapter, on_gpu, view_of};

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

/// Pictures of every effect.
fn effects(scene: &Scene, view: &View) -> [(&'static str, Effects); 6] {
    let base = Effects::phong(view.camera());
    let soft = Lamp { diameter: 4.0, ..Lamp::studio(view.camera())[0] };
    let radius = 0.5 * scene.bounds().extent().length();
    let water =
        Surface::Fluid { refraction: 1.33, absorption: Vec3::new(0.9, 0.28, 0.12) / radius };
    let mirror = Surface::Opaque { reflectivity: 0.3 };
    let floor = Some(floor_below(scene));
    [
        ("cel", Effects { bands: 4, floor, ..base.clone() }),
        ("hard shadows", Effects { shadows: true, floor, ..base.clone() }),
        ("soft shadows", Effects { shadows: true, lamps: vec![soft], floor, ..base.clone() }),
        (
            "occlusion",
            Effects { occlusion: Some(Occlusion { rays: 8, reach: NO_LIMIT }), ..base.clone() },
        ),
        ("mirrors", Effects { surface: mirror, bounces: 3, shadows: true, ..base.clone() }),
        ("water", Effects { surface: water, bounces: 8, floor, ..base }),
    ]
}

const SAMPLES: u32 = 2;

/// The adapter's picture, and the pixels that it lacks, having left a ray of theirs undecided.
fn gpu_picture(
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    effects: &Effects,
    seed: u32,
) -> Result<(Image, Vec<u32>), Failed> {
    let mut renderer = on_adapter(CERTIFIED)?;
    renderer.build(gpu, scene)?;
    let mut tracer = gpu::PathTracer::new(gpu, scene, view, effects.clone(), SAMPLES, seed)?;
    for _ in 0..SAMPLES {
        tracer.add_sample(renderer.as_mut())?;
    }
    Ok((tracer.film()?.develop(0.0), tracer.unfinished()?))
}

fn cpu_picture(scene: &Scene, view: &View, effects: &Effects) -> Result<Image, Failed> {
    let tree = Tree::build(scene, &Options::certified())?;
    let tracer = Tracer::new(&tree, scene);
    let picture = cpu::PathTracer::new(&tracer, scene, view, effects, SAMPLES, 7)?;
    let rows = picture.rows(0..view.height());
    let film = Film { width: view.width(), height: view.height(), light: rows.light };
    Ok(film.develop(0.0))
}

/// Pixels of which a channel differs by more than one step of 255, among those that both have.
fn pixels_apart((one, lacking): &(Image, Vec<u32>), other: &Image) -> usize {
    let pixels = one.rgba.chunks(4).zip(other.rgba.chunks(4));
    let is_apart = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
    let apart = (0..).zip(pixels).filter(|(_, pair)| is_apart(*pair));
    apart.filter(|(pixel, _)| lacking.binary_search(pixel).is_err()).count()
}

/// Paths of a fluid meet many surfaces, and where one passes an edge on another side it ends elsewhere:
/// those pictures are held to 99 of 100 pixels, all others to 999 of 1000.
fn same_pictures(gpu: &Gpu, scene: &str) -> Result<(), Failed> {
    let bench = load(scene)?;
    let (scene, view) = (&bench.scene, view_of(&bench)?);
    let mut failures = Vec::new();
    for (name, effects) in effects(scene, &view) {
        let wanted = gpu_picture(gpu, scene, &view, &effects, 7)?;
        let apart = pixels_apart(&wanted, &cpu_picture(scene, &view, &effects)?);
        let share = if name == "water" { 100 } else { 1000 };
        if apart > view.pixels().div_ceil(share) {
            failures.push(format!("{name}: {apart} of {} pixels", view.pixels()));
        }
        // From an eye in the solid, mirrored rays start beyond the surface that they seek.
        let is_from_within = bench.name == "eye-inside-surface";
        if !is_from_within && wanted.1.len() > view.pixels() / 100 {
            failures.push(format!("{name}: the adapter lacks {} pixels", wanted.1.len()));
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
    let [.., (_, mirrors), _] = effects(scene, &view);
    let wanted = gpu_picture(gpu, scene, &view, &mirrors, 8)?;
    let apart = pixels_apart(&wanted, &cpu_picture(scene, &view, &mirrors)?);
    if apart <= view.pixels().div_ceil(100) {
        return Err(format!("another seed: only {apart} pixels are apart").into());
    }
    Ok(())
}
