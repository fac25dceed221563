//! What the two commands of this paper have in common: the heading of what they write, how they go
//! through the scenes, and writing.

use std::fmt::Display;

use anyhow::{Context, ensure};
use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use super::run::Shoot;
use crate::console::{self, ProgressBar};
use crate::page::{fact, run_facts};
use crate::tables::{Extent, Order};
use harness::machine::Provenance;
use harness::output::write_json;
use harness::record::Adapter;
use picture_files::write_atomically;

/// What a file of measurements begins with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Heading {
    /// Where it comes from, and its format.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What drew.
    pub adapter: Adapter,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Cameras along each scene's path.
    pub cameras: usize,
    /// What a reader should know.
    pub remarks: Vec<String>,
}

impl Heading {
    /// Of a file in that format, before anything is measured.
    pub(super) fn new(schema: &str, gpu: &Gpu, extent: Extent, shoot: Shoot) -> Self {
        let quick = (extent == Extent::Quick)
            .then_some("Quick: scenes of a few hundred balls in the place of the paper's.");
        let software = gpu
            .report()
            .is_software()
            .then_some("Drawn on the CPU: these times say nothing of a GPU.");
        Self {
            provenance: Provenance::here(schema),
            adapter: Adapter::from(gpu.report()),
            width: shoot.size.0,
            height: shoot.size.1,
            cameras: shoot.cameras,
            remarks: [quick, software].into_iter().flatten().map(str::to_owned).collect(),
        }
    }

    /// Measures what is wanted of each scene, `steps` of progress for each. What fails is a remark.
    pub(super) fn measure<W, R>(
        &mut self,
        scenes: impl IntoIterator<Item = (impl Display, Vec<W>)>,
        steps: u64,
        measure: impl Fn(&str, &[W], &ProgressBar) -> anyhow::Result<Vec<anyhow::Result<R>>>,
    ) -> Vec<R> {
        let scenes: Vec<_> =
            scenes.into_iter().map(|(spec, wanted)| (spec.to_string(), wanted)).collect();
        let wanted: usize = scenes.iter().map(|(_, wanted)| wanted.len()).sum();
        let progress = ProgressBar::new(wanted as u64 * steps);
        let (mut done, mut runs) = (0, Vec::new());
        for (spec, wanted) in &scenes {
            let measured = measure(spec, wanted, &progress)
                .with_context(|| format!("scene {spec}"))
                .unwrap_or_else(|error| vec![Err(error)]);
            for run in measured {
                match run {
                    Ok(run) => runs.push(run),
                    Err(error) => self.remarks.push(format!("{error:#}")),
                }
            }
            done += wanted.len() as u64 * steps;
            progress.reach(done);
        }
        runs
    }

    /// The facts at the top of a page: the content of a `<dl>`.
    pub(super) fn facts(&self) -> String {
        let frames = format!("one from each of {} cameras along the path", self.cameras);
        run_facts(&self.provenance, Some(&self.adapter))
            + &fact("Picture", &format!("{} × {} pixels", self.width, self.height))
            + &fact("Frames", &frames)
    }
}

/// Pictures that the adapter draws in bearable time; `on_cpu` is the size for one that computes on the CPU.
pub(super) fn shoot(order: &Order, gpu: &Gpu, on_cpu: (u32, u32)) -> Shoot {
    let (size, cameras) = match order.extent {
        Extent::Quick => ((64, 48), 2),
        Extent::Whole if gpu.report().is_software() => (on_cpu, 4),
        Extent::Whole => ((640, 480), 16),
    };
    Shoot { size: order.size.unwrap_or(size), cameras }
}

/// Writes `NAME.json` and `NAME.html`.
///
/// # Errors
/// When a file cannot be written, or nothing was measured.
pub(super) fn write(
    order: &Order,
    name: &str,
    measurements: &impl Serialize,
    page: &str,
    runs: usize,
) -> anyhow::Result<()> {
    let path = order.out.join(format!("{name}.html"));
    write_json(&order.out.join(format!("{name}.json")), measurements)?;
    write_atomically(&path, page.as_bytes())?;
    console::line(&format!("\n{}", path.display()));
    ensure!(runs > 0, "nothing could be measured; see the page");
    Ok(())
}
