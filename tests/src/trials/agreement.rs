//! Every method against the oracle on every scene, and every method against every other.

use harness::judge::promise::promise_of;
use harness::judge::refusals::{Refusal, refusal_of};
use harness::judge::{Findings, terms_of};
use harness::methods::METHODS;
use libtest_mimic::{Failed, Trial};
use metaball_core::Scene;
use metaball_core::gpu::{Gpu, IsoRenderer, RenderError};

use super::gallery::{picture, room};
use super::{on_gpu, renderer, scenes};

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

/// Fails with the first few violations.
pub(super) fn pass(findings: &Findings) -> Result<(), Failed> {
    if findings.violations.is_empty() {
        return Ok(());
    }
    let shown = findings.violations.iter().take(5).cloned().collect::<Vec<_>>().join("\n  ");
    Err(format!("{} violations\n  {shown}", findings.violations.len()).into())
}

fn with_oracle(gpu: &Gpu, scene: &'static str, method: &'static str) -> Result<(), Failed> {
    let room = room(gpu, scene)?;
    if let Some(refusal) = refusal_of(method, &room.scene.scene) {
        return refuses(gpu, renderer(method)?.as_mut(), &room.scene.scene, refusal);
    }
    pass(&room.exam.judge(&picture(gpu, scene, method)?, &terms_of(method)))
}

fn refuses(
    gpu: &Gpu,
    renderer: &mut dyn IsoRenderer,
    scene: &Scene,
    refusal: &Refusal,
) -> Result<(), Failed> {
    match renderer.build(gpu, scene) {
        Err(RenderError::Unsupported { reason, .. }) if reason.contains(refusal.reason) => Ok(()),
        outcome => Err(format!("needed {refusal:?}, found {outcome:?}").into()),
    }
}

fn with_each_other(
    gpu: &Gpu,
    scene: &'static str,
    ours: &'static str,
    theirs: &'static str,
) -> Result<(), Failed> {
    let room = room(gpu, scene)?;
    if [ours, theirs].iter().any(|method| refusal_of(method, &room.scene.scene).is_some()) {
        // There is one picture at most; that the other is refused is tested with the oracle.
        return Ok(());
    }
    let (first, second) = (picture(gpu, scene, ours)?, picture(gpu, scene, theirs)?);
    pass(&room.exam.compare((&first, promise_of(ours)), (&second, promise_of(theirs))))
}
