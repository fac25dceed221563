//! Secondary rays as the effects of real pictures make them.

use experiments::lit_twins::floor_below;
use glam::Vec3;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::reference::Oracle;
use metaball_core::{Camera, Metaball, NO_LIMIT, Scene, Verdict, View};
use metaball_light::gpu::PathTracer;
use metaball_light::{Effects, Lamp, Occlusion, Surface};

use super::CERTIFIED;
use super::answers::{Answered, answers};
use super::judge::judge;
use crate::trials::{SIZE, load, on_adapter, on_gpu, view_of};

/// Scenes whose effects are followed: merging and tangled ones, strengths, all at one scale; far from the
/// origin; and radii of a thousandth beside one.
pub(super) const SCENES: [&str; 4] =
    ["random-200", "strengths-100", "far-from-origin", "radius-ratio-1000"];

/// An effect, by its last rays.
#[derive(Debug, Clone, Copy)]
pub(super) enum Effect {
    Shadow,
    Occlusion,
    Reflection { level: u32 },
    Refraction { level: u32 },
}

pub(super) const EFFECTS: [(&str, Effect); 6] = [
    ("shadows", Effect::Shadow),
    ("occlusion", Effect::Occlusion),
    ("first_reflection", Effect::Reflection { level: 1 }),
    ("third_reflection", Effect::Reflection { level: 3 }),
    ("first_refraction", Effect::Refraction { level: 1 }),
    ("third_refraction", Effect::Refraction { level: 3 }),
];

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for scene in SCENES {
        for (name, effect) in EFFECTS {
            let test = move |gpu: &'static Gpu| certified_is_right(gpu, scene, effect);
            trials.push(on_gpu(format!("light::{scene}::{name}"), test));
        }
    }
    for method in ["bvh", "fbvh"] {
        for (name, effect) in &EFFECTS[..3] {
            let test = move |gpu: &'static Gpu| published_invents_nothing(gpu, method, *effect);
            trials.push(on_gpu(format!("light::{method}::{name}"), test));
        }
    }
    for exponent in [-4, 7] {
        let test = move |gpu: &'static Gpu| certified_is_right_at_scale(gpu, exponent);
        trials.push(on_gpu(format!("light::any_scale::1e{exponent}"), test));
    }
    trials
}

/// The last rays of an effect's picture.
pub(super) fn last_rays(
    gpu: &Gpu,
    method: &str,
    scene: &Scene,
    view: &View,
    effect: Effect,
) -> Result<Vec<Answered>, Failed> {
    let mut effects = Effects::phong(view.camera());
    match effect {
        Effect::Shadow => {
            effects.shadows = true;
            effects.lamps = vec![Lamp { diameter: 2.0, ..Lamp::studio(view.camera())[0] }];
            effects.floor = Some(floor_below(scene));
        }
        Effect::Occlusion => effects.occlusion = Some(Occlusion { rays: 2, reach: NO_LIMIT }),
        Effect::Reflection { level } => {
            effects.surface = Surface::Opaque { reflectivity: 0.3 };
            effects.bounces = level;
        }
        Effect::Refraction { level } => {
            effects.surface = Surface::Fluid { refraction: 1.33, absorption: Vec3::ZERO };
            effects.bounces = level;
        }
    }
    let mut renderer = on_adapter(method)?;
    renderer.build(gpu, scene)?;
    let mut tracer = PathTracer::new(gpu, scene, view, effects, 1, 7)?;
    tracer.add_sample(renderer.as_mut())?;
    match effect {
        Effect::Shadow | Effect::Occlusion => answers(gpu, tracer.last_shadow_rays()),
        Effect::Reflection { .. } | Effect::Refraction { .. } => {
            answers(gpu, tracer.last_path_rays())
        }
    }
}

fn certified_is_right(gpu: &Gpu, scene: &'static str, effect: Effect) -> Result<(), Failed> {
    let bench = load(scene)?;
    let (scene, view) = (&bench.scene, view_of(&bench)?);
    let findings = judge(scene, &last_rays(gpu, CERTIFIED, scene, &view, effect)?);
    findings.pass()?;
    findings.few_are_spoilt()
}

/// A published tree may miss what its paper's assumption does not cover, as with primary rays. It may not
/// see what is not there: neither a surface before the first, nor its own.
fn published_invents_nothing(gpu: &Gpu, method: &str, effect: Effect) -> Result<(), Failed> {
    let bench = load("random-200")?;
    let answers = last_rays(gpu, method, &bench.scene, &view_of(&bench)?, effect)?;
    let found: Vec<_> = answers.into_iter().filter(|one| one.hit.is_hit()).collect();
    let oracle = Oracle::new(&bench.scene);
    let invented = |one: &&Answered| {
        let truth = oracle.first_hit(&one.ray);
        let is_early = f64::from(one.hit.t) < truth.t - 0.05 * f64::from(truth.smallest_radius);
        !truth.is_ambiguous() && (truth.verdict == Verdict::Miss || is_early)
    };
    let count = found.iter().filter(invented).count();
    if found.len() < 10 || count > 0 {
        return Err(format!("{count} of {} hits are of nothing", found.len()).into());
    }
    Ok(())
}

/// The same scene in other units: shadows and reflections start on their side of the surface.
fn certified_is_right_at_scale(gpu: &Gpu, exponent: i32) -> Result<(), Failed> {
    let bench = load("random-200")?;
    let scale = 10.0f32.powi(exponent);
    let scaled = |ball: Metaball| Metaball {
        center: scale * ball.center,
        radius: scale * ball.radius,
        ..ball
    };
    let scene = &bench.scene;
    let scene = Scene::new(scene.balls().map(scaled), scene.kernel(), scene.threshold())?;
    let camera = bench.camera;
    let eye = scale * camera.eye();
    let ahead = eye + scale * camera.forward();
    let degrees = 2.0 * camera.half_height().atan().to_degrees();
    let camera = Camera::look_at(eye, ahead, camera.up(), degrees)?;
    let view = View::new(camera, SIZE.0, SIZE.1)?;
    for effect in [Effect::Shadow, Effect::Reflection { level: 1 }, Effect::Refraction { level: 2 }]
    {
        let findings = judge(&scene, &last_rays(gpu, CERTIFIED, &scene, &view, effect)?);
        findings.pass()?;
        findings.few_are_spoilt()?;
    }
    Ok(())
}
