//! The part `agreement`: every method, and every variant of one, on every small scene, held to what it
//! promises there.

use std::path::Path;

use bench_scenes::{BenchScene, Overrides, known, load};
use harness::canvas::Canvas;
use harness::configuration::Configuration;
use harness::configuration::sweeps::presets;
use harness::configuration::variants::stability_configurations;
use harness::judge::{Findings, Judge};
use harness::machine::Provenance;
use harness::output::write_json;
use harness::record::Adapter;
use metaball_core::View;
use metaball_core::gpu::{Gpu, RenderError, Targets};
use metaball_core::reference::Oracle;
use serde::Serialize;

use super::Scale;
use crate::console;

/// Name and version of the format of `agreement.json`.
const SCHEMA: &str = "metaball-agreement/1";

/// The whole file.
#[derive(Debug, Serialize)]
struct Agreement {
    #[serde(flatten)]
    provenance: Provenance,
    adapter: Adapter,
    width: u32,
    height: u32,
    verdicts: Vec<Verdict>,
}

/// A configuration on a scene.
#[derive(Debug, Serialize)]
struct Verdict {
    scene: String,
    configuration: String,
    /// Why it drew nothing, where it did not; nothing that it promises is broken then.
    refused: Option<String>,
    violations: usize,
    excused: usize,
    ambiguous: usize,
    measured: usize,
    /// The first violations, in words.
    first: Vec<String>,
}

/// Judges scene by scene, and writes the file after each.
///
/// # Errors
/// When a promise is broken, a scene does not load, the device fails, or the file cannot be written.
pub(super) fn measure(gpu: Option<&Gpu>, scale: Scale, out: &Path) -> anyhow::Result<()> {
    let (scenes, (width, height), mut configurations) = match scale {
        Scale::Whole => (scenes(), (160, 120), stability_configurations()),
        Scale::Rehearsal => (vec!["two-merging"], (32, 24), presets(REHEARSED)),
    };
    configurations.retain(|configuration| gpu.is_some() || !configuration.needs_adapter());
    let mut agreement = Agreement {
        provenance: Provenance::here(SCHEMA),
        adapter: Adapter::of(gpu),
        width,
        height,
        verdicts: Vec::new(),
    };
    for name in scenes {
        let bench = load(name, &Overrides::default())?;
        let verdicts = judge_scene(gpu, &bench, (width, height), &configurations)?;
        console::line(&line(name, &verdicts));
        agreement.verdicts.extend(verdicts);
        write_json(&out.join("agreement.json"), &agreement)?;
    }
    let is_broken = |verdict: &&Verdict| verdict.violations > 0;
    let broken: Vec<_> = agreement.verdicts.iter().filter(is_broken).collect();
    for Verdict { scene, configuration, first, .. } in &broken {
        console::line(&format!("{scene}, {configuration}: {}", first.join("; ")));
    }
    anyhow::ensure!(broken.is_empty(), "promises broken: needed none, found {}", broken.len());
    Ok(())
}

const REHEARSED: &[&str] = &["fbvh-certified", "fbvh-certified-cpu"];

fn scenes() -> Vec<&'static str> {
    let wanted = known().iter().filter(|scene| scene.small || scene.name == "molecule");
    wanted.map(|scene| scene.name).collect()
}

fn judge_scene(
    gpu: Option<&Gpu>,
    bench: &BenchScene,
    (width, height): (u32, u32),
    configurations: &[Configuration],
) -> anyhow::Result<Vec<Verdict>> {
    let scene = &bench.scene;
    let view = View::new(bench.camera, width, height)?;
    let colors = scene.colors().is_some();
    let targets = gpu.map(|gpu| Targets::new(gpu, width, height, colors, false)).transpose()?;
    let canvas = Canvas::new(gpu, targets.as_ref());
    let (oracle, rays) = (Oracle::new(scene), canvas.rays(&view)?);
    let judge = Judge::new(scene, &oracle, &rays);
    let mut verdicts = Vec::new();
    for configuration in configurations {
        let drawn = canvas.picture(&mut configuration.renderer(false), scene, &view);
        let (findings, refused) = match drawn {
            Ok(hits) => (judge.judge(&hits, &configuration.technique.terms()), None),
            Err(error @ RenderError::DeviceLost { .. }) => return Err(error.into()),
            Err(error) => (Findings::default(), Some(error.to_string())),
        };
        verdicts.push(Verdict {
            scene: bench.name.clone(),
            configuration: configuration.name.clone(),
            refused,
            violations: findings.violations.len(),
            excused: findings.excused,
            ambiguous: findings.ambiguous,
            measured: findings.measured,
            first: findings.violations.into_iter().take(3).collect(),
        });
    }
    Ok(verdicts)
}

fn line(scene: &str, verdicts: &[Verdict]) -> String {
    let refused = verdicts.iter().filter(|verdict| verdict.refused.is_some()).count();
    let broken: usize = verdicts.iter().map(|verdict| verdict.violations).sum();
    format!(
        "{scene}: {} configurations, {refused} of them refuse the scene; {broken} rays are wrong \
         against a promise",
        verdicts.len()
    )
}
