//! What the two commands of this paper have in common: pictures from cameras along a path, the heading
//! of what they write, and how they go through the scenes.

use std::fmt::Display;

use anyhow::Context;
use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use super::run::CameraPath;
use crate::console::ProgressBar;
use crate::extent::Extent;
use crate::page::{cpu_remark, fact};
use crate::tables::Options;
use crate::tables::heading::Heading;

/// The head of a file of measurements along camera paths.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PathHeading {
    /// As every file of tables.
    #[serde(flatten)]
    pub heading: Heading,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Cameras along each scene's path.
    pub cameras: usize,
}

impl PathHeading {
    /// Of a file in that format, before anything is measured.
    pub(super) fn new(schema: &str, gpu: &Gpu, extent: Extent, path: CameraPath) -> Self {
        let quick = "Quick: scenes of a few hundred balls instead of the paper's.".to_owned();
        let quick = (extent == Extent::Quick).then_some(quick);
        let remarks = quick.into_iter().chain(cpu_remark(Some(gpu))).collect();
        let CameraPath { size: (width, height), cameras } = path;
        Self { heading: Heading::new(schema, Some(gpu), remarks), width, height, cameras }
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
                    Err(error) => self.heading.remarks.push(format!("{error:#}")),
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
        self.heading.facts()
            + &fact("Picture", &format!("{} × {} pixels", self.width, self.height))
            + &fact("Frames", &frames)
    }
}

/// Pictures that the adapter draws in bearable time; `on_cpu` is the size for one that computes on the CPU.
pub(super) fn camera_path(options: &Options, gpu: &Gpu, on_cpu: (u32, u32)) -> CameraPath {
    let (size, cameras) = match options.extent {
        Extent::Quick => ((64, 48), 2),
        Extent::Whole if gpu.report().is_software() => (on_cpu, 4),
        Extent::Whole => ((640, 480), 16),
    };
    CameraPath { size: options.size.unwrap_or(size), cameras }
}
