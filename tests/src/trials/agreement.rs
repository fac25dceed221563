//! Every method against the oracle on every scene, and every method against every other.

use harness::methods::METHODS;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::reference::Oracle;

use super::{draw, load, on_gpu, renderer, scenes, view_of};
use crate::judge::{Exam, Findings, Terms};
use crate::promise::promise_of;

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for scene in scenes() {
        for method in METHODS {
            let name = format!("agreement::{scene}::{}", method.name);
            trials.push(on_gpu(name, move |gpu| with_oracle(gpu, scene, method.name)));
        }
        for (index, ours) in METHODS.iter().enumerate() {
            for theirs in &METHODS[index + 1..] {
                let name = format!("agreement::{scene}::{}~{}", ours.name, theirs.name);
                trials.push(on_gpu(name, move |gpu| {
                    with_each_other(gpu, scene, ours.name, theirs.name)
                }));
            }
        }
    }
    trials
}

/// What a method is held to.
pub(super) fn terms_of(method: &str) -> Terms {
    // The default tolerance of the secant search.
    Terms { promise: promise_of(method), residual: 1e-4 }
}

/// Fails with the first few violations.
pub(super) fn pass(findings: &Findings) -> Result<(), Failed> {
    if findings.violations.is_empty() {
        return Ok(());
    }
    let shown = findings.violations.iter().take(5).cloned().collect::<Vec<_>>().join("\n  ");
    Err(format!("{} violations\n  {shown}", findings.violations.len()).into())
}

fn with_oracle(gpu: &Gpu, scene: &str, method: &str) -> Result<(), Failed> {
    let scene = load(scene)?;
    let mut renderer = renderer(method)?;
    let picture = draw(gpu, renderer.as_mut(), &scene.scene, &view_of(&scene)?)?;
    let oracle = Oracle::new(&scene.scene);
    let exam = Exam::new(&scene.scene, &oracle, &picture.rays);
    pass(&exam.judge(&picture.hits, &terms_of(method)))
}

fn with_each_other(gpu: &Gpu, scene: &str, ours: &str, theirs: &str) -> Result<(), Failed> {
    let scene = load(scene)?;
    let view = view_of(&scene)?;
    let drawn = |method| {
        let mut renderer = renderer(method)?;
        draw(gpu, renderer.as_mut(), &scene.scene, &view)
    };
    let (first, second) = (drawn(ours)?, drawn(theirs)?);
    let oracle = Oracle::new(&scene.scene);
    let exam = Exam::new(&scene.scene, &oracle, &first.rays);
    pass(&exam.compare((&first.hits, promise_of(ours)), (&second.hits, promise_of(theirs))))
}
