//! The three special cases of Kanamori et al. 2008, section 7, in both variants.

use bench_scenes::Case;
use harness::judge::{Exam, terms_of};
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::reference::Oracle;
use metaball_core::{Verdict, View};

use super::agreement::pass;
use super::{draw, on_gpu, renderer, view_of};

/// What must become of a case, beside that no promise is broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// Every clear ray has its own right answer.
    Right,
    /// Some rays were promised nothing and are late or lost, none is a fallback.
    Lost,
    /// Some rays show a support in place of the surface, and say so.
    Fallback,
}

pub(super) fn trials() -> Vec<Trial> {
    use Outcome::{Fallback, Lost, Right};
    let cases = [
        // Figure 9a: one index comes back, the other ball is lost.
        ("coincident", 2.0, Lost, Right),
        ("coincident", 14.0, Lost, Right),
        // Figure 9b: a list of 14, and none.
        ("crowd", 14.0, Right, Right),
        ("crowd", 15.0, Fallback, Right),
        ("crowd", 65.0, Fallback, Right),
        // Figure 9c: peeling goes on until it ends; searching passes them by.
        ("veiled", 65.0, Right, Right),
        ("veiled", 140.0, Right, Right),
    ];
    let mut trials = Vec::new();
    for (case, value, published, robust) in cases {
        for (method, outcome) in [("kanamori", published), ("kanamori-robust", robust)] {
            let name = format!("section_7::{case}={value}::{method}");
            trials.push(on_gpu(name, move |gpu| special_case(gpu, case, value, method, outcome)));
        }
    }
    for case in bench_scenes::cases() {
        let name = format!("section_7::every_{}::kanamori-robust", case.name);
        trials.push(on_gpu(name, move |gpu| every_value(gpu, case)));
    }
    trials
}

/// The robust variant has the oracle's verdict on every clear ray of every value of a case. At a
/// threshold of 1e-12 the surface is 1e-6 of a radius inside the rims, which f32 cannot tell from
/// outside: there, and only there, it may say that it does not know.
fn every_value(gpu: &Gpu, case: &Case) -> Result<(), Failed> {
    let mut renderer = renderer("kanamori-robust")?;
    for &value in case.values {
        let made = case.scene(value)?;
        let view = View::new(made.camera, 24, 18)?;
        let picture = draw(gpu, renderer.as_mut(), &made.scene, &view)?;
        let truths = Oracle::new(&made.scene).first_hits(&picture.rays);
        for (pixel, (truth, hit)) in truths.iter().zip(&picture.hits).enumerate() {
            let is_unknown = hit.verdict == Verdict::Undecided && made.scene.threshold() < 1e-11;
            if truth.verdict != hit.verdict && !truth.is_ambiguous() && !is_unknown {
                let case = &made.name;
                return Err(format!("{case}, pixel {pixel}: {truth:?} against {hit:?}").into());
            }
        }
    }
    Ok(())
}

fn special_case(
    gpu: &Gpu,
    case: &str,
    value: f64,
    method: &str,
    needed: Outcome,
) -> Result<(), Failed> {
    let mut cases = bench_scenes::cases().iter();
    let case = cases.find(|known| known.name == case).ok_or("no such case")?;
    let scene = case.scene(value)?;
    let mut renderer = renderer(method)?;
    let picture = draw(gpu, renderer.as_mut(), &scene.scene, &view_of(&scene)?)?;
    let oracle = Oracle::new(&scene.scene);
    let exam = Exam::new(&scene.scene, &oracle, &picture.rays);
    let findings = exam.judge(&picture.hits, &terms_of(method));
    pass(&findings)?;
    let fallbacks = picture.hits.iter().filter(|hit| hit.fallback).count();
    let found = match (findings.excused, fallbacks) {
        (0, 0) => Outcome::Right,
        (_, 0) => Outcome::Lost,
        _ => Outcome::Fallback,
    };
    if found != needed {
        return Err(format!("needed {needed:?}, found {found:?}: {findings:?}").into());
    }
    Ok(())
}
