//! Rays that go on from a surface, as the effects of real pictures make them, against the oracle.
//!
//! The method puts a ray's start beside the surface, and all that counts is whether the answer is true
//! of the ray as it was sent: a start on the wrong side would be seen as a ray that starts inside.

use bench_scenes::{BenchScene, cases};
use glam::{Vec3, Vec3Swizzles};
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::{
    FrameStatus, FreeRay, Gpu, RayBatch, RayQuery, RenderError, Targets, render_with,
};
use metaball_core::reference::Oracle;
use metaball_core::{Hit, Kernel, Metaball, NO_LIMIT, Ray, Scene, Verdict, View};
use metaball_light::{Effects, Environment, Floor, Lamp, Occlusion, PathTracer, Surface};

use super::{load, on_gpu, renderer, view_of};

/// Scenes whose effects are followed: merging and tangled ones, strengths, all at one scale; far from the
/// origin; and radii of a thousandth beside one.
const SCENES: [&str; 4] = ["random-200", "strengths-100", "far-from-origin", "radius-ratio-1000"];

const CERTIFIED: &str = "fbvh-certified";

/// An effect, by what its last rays ask.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Shadow,
    Occlusion,
    Reflection { level: u32 },
    Refraction { level: u32 },
}

const KINDS: [(&str, Kind); 6] = [
    ("shadows", Kind::Shadow),
    ("occlusion", Kind::Occlusion),
    ("first_reflection", Kind::Reflection { level: 1 }),
    ("third_reflection", Kind::Reflection { level: 3 }),
    ("first_refraction", Kind::Refraction { level: 1 }),
    ("third_refraction", Kind::Refraction { level: 3 }),
];

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for scene in SCENES {
        for (name, kind) in KINDS {
            let test = move |gpu: &'static Gpu| certified(gpu, scene, kind);
            trials.push(on_gpu(format!("light::{scene}::{name}"), test));
        }
    }
    for method in ["bvh", "fbvh"] {
        for (name, kind) in &KINDS[..3] {
            let test = move |gpu: &'static Gpu| published(gpu, method, *kind);
            trials.push(on_gpu(format!("light::{method}::{name}"), test));
        }
    }
    for exponent in [-4, 7] {
        let test = move |gpu: &'static Gpu| any_scale(gpu, exponent);
        trials.push(on_gpu(format!("light::any_scale::1e{exponent}"), test));
    }
    trials.push(on_gpu("light::rays_from_anywhere".to_owned(), |gpu| {
        rays_from_anywhere(gpu, &load("random-200")?, usize::MAX)
    }));
    trials.push(on_gpu("light::rays_from_within_a_pool".to_owned(), |gpu| {
        rays_from_anywhere(gpu, &load("pool-10k")?, 600)
    }));
    trials.push(on_gpu("light::rays_from_within_a_crowd".to_owned(), |gpu| {
        let crowd = cases().iter().find(|case| case.name == "coincident").ok_or("no such case")?;
        rays_from_anywhere(gpu, &crowd.scene(4096.0)?, 240)
    }));
    trials.push(on_gpu("light::rays_that_graze".to_owned(), rays_that_graze));
    trials.push(on_gpu("light::ways_out_at_faces_of_boxes".to_owned(), ways_out_at_faces_of_boxes));
    trials.push(on_gpu("light::frames_without_end_are_given_up".to_owned(), given_up));
    trials.push(on_gpu("light::canary::wrong_answers".to_owned(), rejects_wrong_answers));
    trials.push(on_gpu("light::canary::starts_on_the_surface".to_owned(), rejects_no_clearance));
    trials.push(on_gpu("light::same_seed_same_picture".to_owned(), same_seed_same_picture));
    trials.push(on_gpu("light::refused_without_rays".to_owned(), refused_without_rays));
    trials.push(on_gpu("light::one_surface_is_enough".to_owned(), one_surface_is_enough));
    trials
}

/// A free ray that was asked, and its answer.
struct Asked {
    ray: Ray,
    query: RayQuery,
    hit: Hit,
}

/// The last rays of an effect's picture.
fn follow(
    gpu: &Gpu,
    method: &str,
    scene: &Scene,
    view: &View,
    kind: Kind,
) -> Result<Vec<Asked>, Failed> {
    let mut effects = Effects::phong(view.camera());
    match kind {
        Kind::Shadow => {
            effects.shadows = true;
            effects.lamps = vec![Lamp { diameter: 2.0, ..Lamp::studio(view.camera())[0] }];
            effects.floor = Some(floor_below(scene));
        }
        Kind::Occlusion => effects.occlusion = Some(Occlusion { rays: 2, reach: NO_LIMIT }),
        Kind::Reflection { level } => {
            effects.surface = Surface::Opaque { reflectivity: 0.3 };
            effects.bounces = level;
        }
        Kind::Refraction { level } => {
            effects.surface = Surface::Fluid { refraction: 1.33, absorption: Vec3::ZERO };
            effects.bounces = level;
        }
    }
    let mut renderer = renderer(method)?;
    renderer.build(gpu, scene)?;
    let mut tracer = PathTracer::new(gpu, scene, view, effects, 1, 7)?;
    tracer.add_sample(renderer.as_mut())?;
    match kind {
        Kind::Shadow | Kind::Occlusion => answers(gpu, tracer.last_shadow_rays()),
        Kind::Reflection { .. } | Kind::Refraction { .. } => answers(gpu, tracer.last_path_rays()),
    }
}

/// Tiles at the lowest point of all supports.
fn floor_below(scene: &Scene) -> Floor {
    let bounds = scene.bounds();
    let diagonal = bounds.extent().length();
    Floor {
        middle: bounds.center().with_y(bounds.min.y),
        reach: 3.0 * diagonal,
        color: Vec3::splat(0.5),
        tile: 0.3 * diagonal,
    }
}

fn answers(gpu: &Gpu, batch: &RayBatch) -> Result<Vec<Asked>, Failed> {
    let (rays, hits) = (batch.read_rays(gpu)?, batch.read_hits(gpu)?);
    let asked =
        |(ray, hit): (FreeRay, Hit)| Some(Asked { ray: ray.ray(), query: ray.query()?, hit });
    Ok(rays.into_iter().zip(hits).filter_map(asked).collect())
}

/// What was found among answers.
#[derive(Debug, Default)]
struct Findings {
    asked: usize,
    hits: usize,
    ambiguous: usize,
    undecided: usize,
    starts_inside: usize,
    violations: Vec<String>,
}

/// Holds each answer against the truth about the ray as it was sent.
fn judge(scene: &Scene, asked: &[Asked]) -> Findings {
    let oracle = Oracle::new(scene);
    let mut findings = Findings { asked: asked.len(), ..Findings::default() };
    for Asked { ray, query, hit } in asked {
        findings.hits += usize::from(hit.is_hit());
        if hit.verdict == Verdict::Undecided {
            findings.undecided += 1;
            continue;
        }
        let wrong = match query {
            RayQuery::Exit => exit_is_wrong(&oracle, scene, ray, hit),
            RayQuery::FirstHit | RayQuery::AnyHit => {
                let truth = oracle.first_hit(ray);
                if truth.is_ambiguous() {
                    findings.ambiguous += 1;
                    continue;
                }
                findings.starts_inside += usize::from(truth.verdict == Verdict::Inside);
                let is_late = *query == RayQuery::FirstHit
                    && hit.is_hit()
                    && (f64::from(hit.t) - truth.t).abs() > 0.05 * f64::from(truth.smallest_radius);
                (hit.is_hit() != (truth.verdict != Verdict::Miss) || is_late)
                    .then(|| format!("needed {truth:?}"))
            }
        };
        if let Some(needed) = wrong {
            findings.violations.push(format!("{needed}, found {hit:?} of {query:?} {ray:?}"));
        }
    }
    findings
}

/// An exit is where the field falls below T: it is above on the way there, and below beyond. The oracle
/// finds the first sheet that a ray leaves.
fn exit_is_wrong(oracle: &Oracle<'_>, scene: &Scene, ray: &Ray, hit: &Hit) -> Option<String> {
    let truth = oracle.first_hit(ray);
    if truth.is_ambiguous() {
        return None;
    }
    let radius = scene.supports().iter().map(|ball| ball.radius).fold(f32::INFINITY, f32::min);
    let is_wrong = match truth.verdict {
        // Started outside: the space that is sought is there.
        Verdict::Miss | Verdict::Hit => hit.t != 0.0,
        _ => !hit.is_hit() || (f64::from(hit.t) - truth.exit).abs() > 0.05 * f64::from(radius),
    };
    is_wrong.then(|| format!("needed an exit at {} of {truth:?}", truth.exit))
}

fn pass(findings: &Findings) -> Result<(), Failed> {
    let shown = findings.violations.iter().take(5).cloned().collect::<Vec<_>>().join("\n  ");
    if !findings.violations.is_empty() {
        let count = findings.violations.len();
        return Err(format!("{count} of {} answers wrong\n  {shown}", findings.asked).into());
    }
    Ok(())
}

fn certified(gpu: &Gpu, scene: &'static str, kind: Kind) -> Result<(), Failed> {
    let scene = load(scene)?;
    let findings =
        judge(&scene.scene, &follow(gpu, CERTIFIED, &scene.scene, &view_of(&scene)?, kind)?);
    pass(&findings)?;
    sound(&findings)
}

/// Rays of the host's own, one a pixel or so many, with starts and directions all over the scene, in the solid
/// and out of it, some of them short, and some no longer than rounding.
fn rays_from_anywhere(gpu: &Gpu, bench: &BenchScene, most: usize) -> Result<(), Failed> {
    let (scene, view) = (&bench.scene, view_of(bench)?);
    let oracle = Oracle::new(scene);
    let threshold = f64::from(scene.threshold());
    let bounds = scene.bounds();
    let rays: Vec<_> = (0..view.pixels().min(most))
        .map(|index| {
            let place = (index as f32 * Vec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5)).fract();
            let toward = (index as f32 * Vec3::new(0.235_4, 0.915_7, 0.430_1)).fract() - 0.5;
            let origin = bounds.min + place * bounds.extent();
            let ray = Ray::new(origin, toward.normalize_or(Vec3::X));
            // Half of the others start outside: they are out at once, though the ray comes to the solid.
            let is_inside = || oracle.field(origin.as_dvec3()) > 1.01 * threshold;
            if index % 3 == 0 && (index % 2 == 0 || is_inside()) {
                return FreeRay::new(&ray, RayQuery::Exit);
            }
            let width = bounds.extent().x;
            let t_max = [NO_LIMIT, 0.2 * width, 1e-9 * width][index % 5 % 3];
            let query = [RayQuery::FirstHit, RayQuery::AnyHit][index / 2 % 2];
            FreeRay::new(&Ray { t_max, ..ray }, query)
        })
        .collect();

    let asked = ask(gpu, scene, &view, &rays)?;
    let exits = asked.iter().filter(|one| one.query == RayQuery::Exit).count();
    let findings = judge(scene, &asked);
    if asked.len() != rays.len() || exits < 10 {
        return Err(format!("{} rays of {}, {exits} exits", asked.len(), rays.len()).into());
    }
    pass(&findings)
}

/// Rays past two balls that merge, closer and closer to where they would touch them, on both sides: there the
/// field comes near T, or a little above, for a short way. One ball or both reach it.
fn rays_that_graze(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("two-merging")?;
    let (scene, view) = (&bench.scene, view_of(&bench)?);
    let oracle = Oracle::new(scene);
    let bounds = scene.bounds();
    let far = bounds.extent().length();
    let grazing = |index: usize| {
        let share = (index as f32 * Vec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5)).fract();
        let through = bounds.center() + 0.4 * (share - 0.5) * bounds.extent();
        let direction = ((share.zxy() * 8.0).fract() - 0.5).normalize_or(Vec3::X);
        let across = direction.any_orthonormal_vector();
        let beside = move |way: f32| Ray::new(through + way * across - far * direction, direction);
        let (mut low, mut high) = (0.0, far);
        for _ in 0..24 {
            let middle = 0.5 * (low + high);
            let is_hit = oracle.first_hit(&beside(middle)).verdict == Verdict::Hit;
            (low, high) = if is_hit { (middle, high) } else { (low, middle) };
        }
        (0..16u8).map(move |step| {
            let share = 10.0f32.powf(-1.0 - 0.5 * f32::from(step / 4));
            let ray = beside(low * if step % 2 == 0 { 1.0 + share } else { 1.0 - share });
            FreeRay::new(&ray, [RayQuery::FirstHit, RayQuery::AnyHit][usize::from(step / 2 % 2)])
        })
    };
    let rays: Vec<_> = (0..400.min(view.pixels() / 16)).flat_map(grazing).collect();
    let findings = judge(scene, &ask(gpu, scene, &view, &rays)?);
    let clear = rays.len() - findings.ambiguous - findings.undecided;
    if clear * 2 < rays.len() || findings.hits * 4 < clear || findings.hits * 4 > 3 * clear {
        return Err(format!("{clear} of {} clear, {} hits", rays.len(), findings.hits).into());
    }
    pass(&findings)
}

/// Rays out of lone balls in rows, to close beside where they touch their boxes: there the field is as good
/// as T at the box's face, and behind it is no box, or that of the next ball, which must not be taken for where
/// the ray comes out.
fn ways_out_at_faces_of_boxes(gpu: &Gpu) -> Result<(), Failed> {
    let view = view_of(&load("two-merging")?)?;
    for threshold in [0.25f32, 0.999, 0.9999] {
        let reach = (1.0 - threshold.sqrt()).sqrt();
        let apart = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|axis| 40.0 * axis);
        let balls = apart.iter().flat_map(|&place| [place, -place]).skip(1);
        let scene =
            Scene::new(balls.map(|place| Metaball::new(place, 1.0)), Kernel::QUARTIC, threshold)?;
        let from_beneath = |index: usize| {
            let share = (index as f32 * Vec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5)).fract();
            let axis = [Vec3::X, Vec3::Y, Vec3::Z][index % 3] * [1.0, -1.0][index / 3 % 2];
            // Closer and closer to the middle of the face, from all over the ball.
            let aside =
                10.0f32.powf(-1.0 - 3.0 * share.y) * (share.zxy() - 0.5) * (1.0 - axis.abs());
            // One in four goes on to the next ball of the row.
            let beside = if index.is_multiple_of(4) {
                aside
            } else {
                (share.yzx() - 0.5) * (1.0 - axis.abs())
            };
            let origin = reach * ((share.x - 0.5) * axis + beside);
            let direction = (reach * (axis + aside) - origin).normalize();
            FreeRay::new(&Ray::new(origin, direction), RayQuery::Exit)
        };
        let rays: Vec<_> = (0..view.pixels().min(3000)).map(from_beneath).collect();
        let findings = judge(&scene, &ask(gpu, &scene, &view, &rays)?);
        pass(&findings)?;
        if findings.undecided * 500 > rays.len() {
            let undecided = findings.undecided;
            return Err(format!("T {threshold}: {undecided} of {} undecided", rays.len()).into());
        }
    }
    Ok(())
}

/// Has the certified tree answer rays of the host's own.
fn ask(gpu: &Gpu, scene: &Scene, view: &View, rays: &[FreeRay]) -> Result<Vec<Asked>, Failed> {
    let mut renderer = renderer(CERTIFIED)?;
    renderer.build(gpu, scene)?;
    let targets = Targets::new(gpu, view.width(), view.height(), false, false)?;
    let batch = RayBatch::new(gpu, &targets)?;
    batch.write_rays(gpu, rays)?;
    render_with(gpu, renderer.as_mut(), &targets, view, |renderer, frame| {
        let name = renderer.name();
        let reason = "needed a tracer of any ray, found none".to_owned();
        let none = RenderError::Unsupported { method: name, reason };
        let tracer = renderer.ray_tracer().ok_or(none)?;
        RayQuery::ALL.iter().try_for_each(|&ask| tracer.encode_answers(frame, &batch, ask))
    })?;
    answers(gpu, &batch)
}

/// A frame of which some ray never says that it is finished ends as an error, after a few attempts.
fn given_up(gpu: &Gpu) -> Result<(), Failed> {
    let mut renderer = renderer(CERTIFIED)?;
    renderer.build(gpu, &load("two-merging")?.scene)?;
    let status = FrameStatus { unfinished: 1, needed: [0; 4] };
    for _ in 0..20 {
        if !renderer.grow(gpu, &status)? {
            return Ok(());
        }
    }
    Err("needed an end, found none after 20 attempts".into())
}

/// A published tree may miss what its paper's assumption does not cover, as with primary rays. It may not
/// see what is not there: neither a surface before the first, nor its own.
fn published(gpu: &Gpu, method: &str, kind: Kind) -> Result<(), Failed> {
    let scene = load("random-200")?;
    let asked = follow(gpu, method, &scene.scene, &view_of(&scene)?, kind)?;
    let found: Vec<_> = asked.into_iter().filter(|one| one.hit.is_hit()).collect();
    let oracle = Oracle::new(&scene.scene);
    let invented = |one: &&Asked| {
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

/// There was something to test, and hardly a ray was lost to rounding: one in a hundred of those that
/// graze, which are the first to be ambiguous.
fn sound(findings: &Findings) -> Result<(), Failed> {
    let lost = findings.undecided + findings.starts_inside;
    if findings.asked < 10 || lost * 100 > findings.asked {
        let Findings { asked, hits, ambiguous, undecided, starts_inside, .. } = findings;
        return Err(format!(
            "{asked} rays, {hits} hits, {ambiguous} ambiguous: {undecided} undecided and \
             {starts_inside} on the wrong side"
        )
        .into());
    }
    Ok(())
}

/// The same scene in other units: shadows and reflections start on their side of the surface.
fn any_scale(gpu: &Gpu, exponent: i32) -> Result<(), Failed> {
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
    let camera = metaball_core::Camera::look_at(eye, ahead, camera.up(), degrees)?;
    let view = View::new(camera, super::SIZE.0, super::SIZE.1)?;
    for kind in [Kind::Shadow, Kind::Reflection { level: 1 }, Kind::Refraction { level: 2 }] {
        let findings = judge(&scene, &follow(gpu, CERTIFIED, &scene, &view, kind)?);
        pass(&findings)?;
        sound(&findings)?;
    }
    Ok(())
}

fn rejects_wrong_answers(gpu: &Gpu) -> Result<(), Failed> {
    let scene = load("random-200")?;
    for kind in [Kind::Shadow, Kind::Reflection { level: 1 }, Kind::Refraction { level: 1 }] {
        let mut asked = follow(gpu, CERTIFIED, &scene.scene, &view_of(&scene)?, kind)?;
        let last = asked.last().ok_or("no rays")?.hit;
        let mut carried = last;
        for one in &mut asked {
            std::mem::swap(&mut one.hit, &mut carried);
        }
        if pass(&judge(&scene.scene, &asked)).is_ok() {
            return Err(format!("{kind:?}: answers to other rays passed").into());
        }
    }
    Ok(())
}

/// Started at the hit itself, as many rays begin on the wrong side as on the right one.
fn rejects_no_clearance(gpu: &Gpu) -> Result<(), Failed> {
    let scene = load("random-200")?;
    let view = view_of(&scene)?;
    let picture = super::draw(gpu, renderer(CERTIFIED)?.as_mut(), &scene.scene, &view)?;
    let found = picture.rays.iter().zip(&picture.hits).filter(|(_, hit)| hit.is_hit());
    let oracle = Oracle::new(&scene.scene);
    let starts: Vec<_> =
        found.map(|(ray, hit)| Ray::new(ray.origin + hit.t * ray.direction, hit.normal)).collect();
    let inside = oracle.first_hits(&starts);
    let inside = inside.iter().filter(|truth| truth.verdict == Verdict::Inside).count();
    if inside * 10 < starts.len() {
        return Err(format!("{inside} of {} starts inside: clearance is idle", starts.len()).into());
    }
    Ok(())
}

fn same_seed_same_picture(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("two-merging")?;
    let view = view_of(&bench)?;
    let film = |seed| {
        let effects = Effects {
            surface: Surface::Fluid { refraction: 1.33, absorption: Vec3::ONE },
            bounces: 4,
            environment: Environment::Sky,
            ..Effects::phong(&bench.camera)
        };
        let mut renderer = renderer(CERTIFIED)?;
        renderer.build(gpu, &bench.scene)?;
        let mut tracer = PathTracer::new(gpu, &bench.scene, &view, effects, 2, seed)?;
        tracer.add_sample(renderer.as_mut())?;
        tracer.add_sample(renderer.as_mut())?;
        Ok::<_, Failed>(tracer.film()?)
    };
    let first = film(1)?;
    if first != film(1)? {
        return Err("one seed, two pictures".into());
    }
    if first == film(2)? {
        return Err("two seeds, one picture: nothing is sampled".into());
    }
    Ok(())
}

/// What ends at the first surface is drawn from any method's primary hits: as from free rays where every
/// ray goes through its pixel's middle, and nearly so where samples are spread.
fn one_surface_is_enough(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("colors-100")?;
    let view = view_of(&bench)?;
    let effects = Effects {
        surface: Surface::Opaque { reflectivity: 0.3 },
        floor: Some(floor_below(&bench.scene)),
        ..Effects::phong(&bench.camera)
    };
    let film = |method, samples| {
        let mut renderer = renderer(method)?;
        renderer.build(gpu, &bench.scene)?;
        let mut tracer = PathTracer::new(gpu, &bench.scene, &view, effects.clone(), samples, 7)?;
        for _ in 0..samples {
            tracer.add_sample(renderer.as_mut())?;
        }
        Ok::<_, Failed>(tracer.film()?.light)
    };
    for (samples, tolerance) in [(1, 1e-3), (16, 0.02)] {
        let wanted = film(CERTIFIED, samples)?;
        for method in ["kanamori-robust", "illes-exact"] {
            let found = film(method, samples)?;
            let apart: f32 =
                found.iter().zip(&wanted).map(|(a, b)| (*a - *b).abs().max_element()).sum();
            let mean = apart / wanted.len() as f32;
            if mean > tolerance {
                return Err(format!("{method}, {samples} samples: {mean} apart").into());
            }
        }
    }
    let darkness = vec![Vec3::ZERO; view.pixels()];
    if film(CERTIFIED, 1)?.iter().zip(&darkness).all(|(a, b)| (*a - *b).length() < 0.02) {
        return Err("there is nothing to compare".into());
    }
    Ok(())
}

fn refused_without_rays(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("two-merging")?;
    let view = view_of(&bench)?;
    let fluid = Surface::Fluid { refraction: 1.33, absorption: Vec3::ZERO };
    let phong = Effects::phong(&bench.camera);
    let refused = [
        ("illes", Effects { shadows: true, ..phong.clone() }),
        ("kanamori", Effects { bounces: 1, ..phong.clone() }),
        ("fbvh", Effects { surface: fluid, ..phong }),
    ];
    for (method, effects) in refused {
        let mut renderer = renderer(method)?;
        renderer.build(gpu, &bench.scene)?;
        let mut tracer = PathTracer::new(gpu, &bench.scene, &view, effects, 1, 0)?;
        match tracer.add_sample(renderer.as_mut()) {
            Err(error) if error.to_string().starts_with(&format!("method {method}: needed")) => {}
            outcome => return Err(format!("{method}: needed a refusal, found {outcome:?}").into()),
        }
    }
    Ok(())
}
