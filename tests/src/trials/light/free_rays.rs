//! Free rays of the host's own, where answers are hardest.

use bench_scenes::{BenchScene, cases};
use glam::{Vec3, Vec3Swizzles};
use libtest_mimic::{Failed, Trial};
use metaball_core::RayQuery;
use metaball_core::gpu::{FreeRay, Gpu};
use metaball_core::reference::Oracle;
use metaball_core::{Kernel, Metaball, NO_LIMIT, Ray, Scene, Verdict};

use super::answers::trace;
use super::judge::judge;
use crate::trials::{load, on_gpu, view_of};

pub(super) fn trials() -> Vec<Trial> {
    vec![
        on_gpu("light::rays_from_anywhere".to_owned(), |gpu| {
            rays_from_anywhere(gpu, &load("random-200")?, usize::MAX)
        }),
        on_gpu("light::rays_from_within_a_pool".to_owned(), |gpu| {
            rays_from_anywhere(gpu, &load("pool-10k")?, 600)
        }),
        on_gpu("light::rays_from_within_coincident_balls".to_owned(), |gpu| {
            let case = cases().iter().find(|case| case.name == "coincident");
            rays_from_anywhere(gpu, &case.ok_or("no such case")?.scene(4096.0)?, 240)
        }),
        on_gpu("light::rays_that_graze".to_owned(), rays_that_graze),
        on_gpu("light::exits_at_faces_of_boxes".to_owned(), exits_at_faces_of_boxes),
    ]
}

/// A point of the unit cube; those of successive indices fill it evenly (Roberts' sequence R3).
fn in_cube(index: usize) -> Vec3 {
    (index as f32 * Vec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5)).fract()
}

fn free_ray(ray: &Ray, query: RayQuery) -> FreeRay {
    FreeRay::new(ray, query).expect("a ray from its origin")
}

/// Rays with starts and directions all over the scene, one a pixel or so many, in the solid and out of it, some
/// of them short, and some no longer than rounding.
fn rays_from_anywhere(gpu: &Gpu, bench: &BenchScene, most: usize) -> Result<(), Failed> {
    let (scene, view) = (&bench.scene, view_of(bench)?);
    let oracle = Oracle::new(scene);
    let threshold = f64::from(scene.threshold());
    let bounds = scene.bounds();
    let rays: Vec<_> = (0..view.pixels().min(most))
        .map(|index| {
            let toward = (index as f32 * Vec3::new(0.235_4, 0.915_7, 0.430_1)).fract() - 0.5;
            let origin = bounds.min + in_cube(index) * bounds.extent();
            let ray = Ray::new(origin, toward.normalize_or(Vec3::X));
            // Half of the others start outside: they are out at once, though the ray meets the solid.
            let is_inside = || oracle.field(origin.as_dvec3()) > 1.01 * threshold;
            if index % 3 == 0 && (index % 2 == 0 || is_inside()) {
                return free_ray(&ray, RayQuery::Exit);
            }
            let width = bounds.extent().x;
            let t_max = [NO_LIMIT, 0.2 * width, 1e-9 * width][index % 5 % 3];
            let query = [RayQuery::FirstHit, RayQuery::AnyHit][index / 2 % 2];
            free_ray(&Ray { t_max, ..ray }, query)
        })
        .collect();

    let answers = trace(gpu, scene, &view, &rays)?;
    let exits = answers.iter().filter(|one| one.query == RayQuery::Exit).count();
    let findings = judge(scene, &answers);
    if answers.len() != rays.len() || exits < 10 {
        return Err(format!("{} rays of {}, {exits} exits", answers.len(), rays.len()).into());
    }
    findings.pass()
}

/// Rays past two balls that merge, closer and closer to where they would touch them, on both sides: there the
/// field comes near T, or a little above, over a short interval. One ball or both reach it.
fn rays_that_graze(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("two-merging")?;
    let (scene, view) = (&bench.scene, view_of(&bench)?);
    let oracle = Oracle::new(scene);
    let bounds = scene.bounds();
    let far = bounds.extent().length();
    let grazing = |index: usize| {
        let share = in_cube(index);
        let through = bounds.center() + 0.4 * (share - 0.5) * bounds.extent();
        let direction = ((share.zxy() * 8.0).fract() - 0.5).normalize_or(Vec3::X);
        let across = direction.any_orthonormal_vector();
        let moved = move |by: f32| Ray::new(through + by * across - far * direction, direction);
        let (mut low, mut high) = (0.0, far);
        for _ in 0..24 {
            let middle = 0.5 * (low + high);
            let is_hit = oracle.first_hit(&moved(middle)).verdict == Verdict::Hit;
            (low, high) = if is_hit { (middle, high) } else { (low, middle) };
        }
        (0..16u8).map(move |step| {
            let share = 10.0f32.powf(-1.0 - 0.5 * f32::from(step / 4));
            let ray = moved(low * if step % 2 == 0 { 1.0 + share } else { 1.0 - share });
            free_ray(&ray, [RayQuery::FirstHit, RayQuery::AnyHit][usize::from(step / 2 % 2)])
        })
    };
    let rays: Vec<_> = (0..400.min(view.pixels() / 16)).flat_map(grazing).collect();
    let findings = judge(scene, &trace(gpu, scene, &view, &rays)?);
    let clear = rays.len() - findings.ambiguous - findings.undecided;
    if clear * 2 < rays.len() || findings.hits * 4 < clear || findings.hits * 4 > 3 * clear {
        return Err(format!("{clear} of {} clear, {} hits", rays.len(), findings.hits).into());
    }
    findings.pass()
}

/// Rays out of lone balls in rows, close to where they touch their boxes: there the field is as good as T at
/// the box's face, and behind it is no box, or that of the next ball, whose surface must not be taken for the
/// exit.
fn exits_at_faces_of_boxes(gpu: &Gpu) -> Result<(), Failed> {
    let view = view_of(&load("two-merging")?)?;
    for threshold in [0.25f32, 0.999, 0.9999] {
        let reach = (1.0 - threshold.sqrt()).sqrt();
        let apart = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|axis| 40.0 * axis);
        let centers = apart.iter().flat_map(|&center| [center, -center]).skip(1);
        let balls = centers.map(|center| Metaball::new(center, 1.0));
        let scene = Scene::new(balls, Kernel::QUARTIC, threshold)?;
        let from_beneath = |index: usize| {
            let share = in_cube(index);
            let axis = [Vec3::X, Vec3::Y, Vec3::Z][index % 3] * [1.0, -1.0][index / 3 % 2];
            // Closer and closer to the middle of the face, from all over the ball.
            let aside =
                10.0f32.powf(-1.0 - 3.0 * share.y) * (share.zxy() - 0.5) * (1.0 - axis.abs());
            // One in four continues to the next ball of the row.
            let start_aside = if index.is_multiple_of(4) {
                aside
            } else {
                (share.yzx() - 0.5) * (1.0 - axis.abs())
            };
            let origin = reach * ((share.x - 0.5) * axis + start_aside);
            let direction = (reach * (axis + aside) - origin).normalize();
            free_ray(&Ray::new(origin, direction), RayQuery::Exit)
        };
        let rays: Vec<_> = (0..view.pixels().min(3000)).map(from_beneath).collect();
        let findings = judge(&scene, &trace(gpu, &scene, &view, &rays)?);
        findings.pass()?;
        if findings.undecided * 500 > rays.len() {
            let undecided = findings.undecided;
            return Err(format!("T {threshold}: {undecided} of {} undecided", rays.len()).into());
        }
    }
    Ok(())
}
