//! Every method, and every variant of one, against the oracle on every scene, and each against every
//! other.

use harness::configuration::Configuration;
use harness::configuration::variants::stability_configurations;
use harness::judge::Findings;
use harness::renderer::Renderer;
use libtest_mimic::{Failed, Trial};
use metaball_core::Scene;
use metaball_core::gpu::{Gpu, RenderError};

use super::fixtures::{fixture, picture};
use super::{on_gpu, scenes};

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for scene in scenes() {
        let configurations = stability_configurations();
        for (index, ours) in configurations.iter().enumerate() {
            for theirs in configurations[index + 1..].iter().cloned() {
                let name = format!("agreement::{scene}::{}~{}", ours.name, theirs.name);
                let ours = ours.clone();
                trials.push(on_gpu(name, move |gpu| with_each_other(gpu, scene, &ours, &theirs)));
            }
        }
        for configuration in configurations {
            let name = format!("agreement::{scene}::{}", configuration.name);
            trials.push(on_gpu(name, move |gpu| with_oracle(gpu, scene, &configuration)));
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

fn with_oracle(
    gpu: &Gpu,
    scene: &'static str,
    configuration: &Configuration,
) -> Result<(), Failed> {
    let fixture = fixture(gpu, scene)?;
    if let Some(reason) = configuration.technique.refusal(&fixture.scene.scene) {
        return refuses(gpu, configuration.renderer(false), &fixture.scene.scene, reason);
    }
    pass(
        &fixture
            .judge
            .judge(&picture(gpu, scene, configuration)?, &configuration.technique.terms()),
    )
}

fn refuses(gpu: &Gpu, renderer: Renderer, scene: &Scene, reason: &str) -> Result<(), Failed> {
    match renderer.build(Some(gpu), scene).map(|(_, report)| report) {
        Err(RenderError::Unsupported { reason: found, .. }) if found.contains(reason) => Ok(()),
        outcome => Err(format!("needed a refusal with {reason:?}, found {outcome:?}").into()),
    }
}

fn with_each_other(
    gpu: &Gpu,
    scene: &'static str,
    ours: &Configuration,
    theirs: &Configuration,
) -> Result<(), Failed> {
    let fixture = fixture(gpu, scene)?;
    let is_refused = |configuration: &Configuration| {
        configuration.technique.refusal(&fixture.scene.scene).is_some()
    };
    if is_refused(ours) || is_refused(theirs) {
        // There is one picture at most; that the other is refused is tested with the oracle.
        return Ok(());
    }
    let (first, second) = (picture(gpu, scene, ours)?, picture(gpu, scene, theirs)?);
    let promise = |configuration: &Configuration| configuration.technique.promise();
    pass(&fixture.judge.compare((&first, promise(ours)), (&second, promise(theirs))))
}
