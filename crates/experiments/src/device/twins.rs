//! The part `light`: lit pictures of the adapter beside those of the CPU.

use std::path::Path;

use anyhow::Context;
use bench_scenes::{Overrides, load};
use harness::machine::Provenance;
use harness::output::write_json;
use harness::record::Adapter;
use metaball_core::View;
use metaball_core::gpu::Gpu;
use serde::Serialize;

use super::Scale;
use crate::console;
use crate::lit_twins::{LitDifference, lit_difference, lit_effects};

/// Name and version of the format of `light.json`.
const SCHEMA: &str = "metaball-light/1";

/// The whole file.
#[derive(Debug, Serialize)]
struct LitTwins {
    #[serde(flatten)]
    provenance: Provenance,
    adapter: Adapter,
    width: u32,
    height: u32,
    scenes: Vec<LitScene>,
}

#[derive(Debug, Serialize)]
struct LitScene {
    scene: &'static str,
    differences: Vec<LitDifference>,
}

/// Compares scene by scene, and writes the file after each.
///
/// # Errors
/// When pictures differ, the device fails, or the file cannot be written.
pub(super) fn measure(gpu: &Gpu, scale: Scale, out: &Path) -> anyhow::Result<()> {
    let (scenes, (width, height), effects): (&[&str], _, _) = match scale {
        Scale::Whole => {
            (&["random-200", "colors-100", "strengths-100", "molecule"], (320, 240), usize::MAX)
        }
        Scale::Rehearsal => (&["two-merging"], (32, 24), 2),
    };
    let (provenance, adapter) = (Provenance::here(SCHEMA), Adapter::of(Some(gpu)));
    let mut twins = LitTwins { provenance, adapter, width, height, scenes: Vec::new() };
    for &scene in scenes {
        let bench = load(scene, &Overrides::default())?;
        let view = View::new(bench.camera, width, height)?;
        let mut differences = Vec::new();
        for effect in lit_effects(&bench.scene, &view).into_iter().take(effects) {
            let difference = lit_difference(gpu, &bench.scene, &view, &effect, (7, 7));
            let difference = difference.with_context(|| format!("{scene}, {}", effect.0))?;
            console::line(&line(scene, &difference));
            differences.push(difference);
        }
        twins.scenes.push(LitScene { scene, differences });
        write_json(&out.join("light.json"), &twins)?;
    }
    let differences = twins.scenes.iter().flat_map(|scene| &scene.differences);
    let large = differences.filter(|difference| !difference.is_small()).count();
    anyhow::ensure!(large == 0, "pictures that differ: needed none, found {large}");
    Ok(())
}

fn line(scene: &str, difference: &LitDifference) -> String {
    let LitDifference { effect, pixels, apart, most_apart, lacking } = difference;
    format!(
        "{scene}, {effect}: {apart} of {pixels} pixels apart, {most_apart} may be; {lacking} lacking"
    )
}
