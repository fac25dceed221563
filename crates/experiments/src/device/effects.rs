//! The part `effects`: what shadows, occlusion and mirrors cost, in frame times.

use std::path::Path;

use harness::machine::Provenance;
use harness::numbers::decimal;
use harness::output::write_json;
use harness::record::Adapter;
use metaball_core::gpu::Gpu;
use serde::Serialize;

use super::Scale;
use crate::console::{self, ProgressBar};
use crate::tables::gourmel::light::effect::Effect;
use crate::tables::gourmel::light::run::{self, EffectRun, Wanted};
use crate::tables::gourmel::run::CameraPath;

/// Name and version of the format of `effects.json`.
const SCHEMA: &str = "metaball-effects/1";

/// The whole file.
#[derive(Debug, Serialize)]
struct EffectTimes {
    #[serde(flatten)]
    provenance: Provenance,
    adapter: Adapter,
    width: u32,
    height: u32,
    runs: Vec<EffectRun>,
}

const EFFECTS: [Effect; 4] =
    [Effect::Cast, Effect::Shadows, Effect::ShadowedMirrors(3), Effect::Occlusion(16)];

/// Measures scene by scene, and writes the file after each.
///
/// # Errors
/// When nothing could be measured, or the file cannot be written.
pub(super) fn measure(gpu: &Gpu, scale: Scale, out: &Path) -> anyhow::Result<()> {
    let (scenes, methods, path): (&[&str], &[&str], _) = match scale {
        Scale::Whole => (
            &["molecule", "tornado-4k", "dam-break"],
            &["fbvh-certified", "fbvh"],
            CameraPath { size: (640, 480), cameras: 20 },
        ),
        Scale::Rehearsal => {
            (&["two-merging"], &["fbvh-certified"], CameraPath { size: (16, 12), cameras: 2 })
        }
    };
    let wanted: Vec<_> = methods
        .iter()
        .flat_map(|&method| EFFECTS.map(|effect| Wanted { method, effect }))
        .collect();
    let (width, height) = path.size;
    let mut times = EffectTimes {
        provenance: Provenance::here(SCHEMA),
        adapter: Adapter::of(Some(gpu)),
        width,
        height,
        runs: Vec::new(),
    };
    for spec in scenes {
        let progress = ProgressBar::new(run::steps(path) * wanted.len() as u64);
        for run in run::measure(gpu, spec, &wanted, path, &progress)? {
            match run {
                Ok(run) => {
                    console::line(&line(&run));
                    times.runs.push(run);
                }
                Err(error) => console::note(&format!("{error:#}")),
            }
        }
        write_json(&out.join("effects.json"), &times)?;
    }
    anyhow::ensure!(!times.runs.is_empty(), "nothing could be measured");
    Ok(())
}

fn line(run: &EffectRun) -> String {
    let EffectRun { scene, method, effect, frame_ms, .. } = run;
    format!("{scene}, {method}, {effect}: {} ms", decimal(frame_ms.median))
}
