//! Arguments that several commands take.

use bench_scenes::Overrides;
use clap::Args;
use experiments::extent::Extent;
use metaball_core::Kernel;
use metaball_core::gpu::AdapterChoice;

use crate::values;

/// What every command takes that draws scenes of the user's.
#[derive(Debug, Args)]
pub(crate) struct PictureArgs {
    /// Pixels across and down.
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = values::size)]
    pub(crate) size: (u32, u32),
    #[command(flatten)]
    pub(crate) adapter: AdapterArgs,
    #[command(flatten)]
    field: FieldArgs,
}

impl PictureArgs {
    pub(crate) fn overrides(&self) -> Overrides {
        self.field.overrides()
    }
}

/// What is changed about a scene's field.
#[derive(Debug, Args)]
pub(crate) struct FieldArgs {
    /// Kernel instead of the scene's own: power (power-1 to power-8), wyvill, perlin, cubic-spline,
    /// quintic-spline, wendland-c2, wendland-c4, wendland-c6, or gaussian-3 with its cut in standard
    /// deviations.
    #[arg(long, value_name = "NAME", value_parser = values::kernel)]
    kernel: Option<Kernel>,
    /// Exponent of a power kernel, 1 to 8.
    #[arg(long, value_name = "N")]
    exponent: Option<i64>,
    /// Threshold instead of the scene's own.
    #[arg(long, value_name = "T")]
    threshold: Option<f32>,
}

impl FieldArgs {
    pub(crate) fn overrides(&self) -> Overrides {
        let &Self { kernel, exponent, threshold } = self;
        Overrides { kernel, exponent, threshold, color: None }
    }
}

/// Which adapter draws.
#[derive(Debug, Args)]
pub(crate) struct AdapterArgs {
    /// Draw with the adapter that has this in its name.
    #[arg(long, value_name = "NAME", conflicts_with = "software")]
    adapter: Option<String>,
    /// Draw with an adapter that computes on the CPU.
    #[arg(long)]
    software: bool,
}

impl AdapterArgs {
    pub(crate) fn choice(&self) -> AdapterChoice {
        self.asked().unwrap_or_default()
    }

    /// The adapter asked for, if any.
    pub(crate) fn asked(&self) -> Option<AdapterChoice> {
        let software = self.software.then_some(AdapterChoice::Software);
        self.adapter.clone().map(AdapterChoice::Named).or(software)
    }
}

/// How much to measure.
pub(crate) fn extent(quick: bool) -> Extent {
    if quick { Extent::Quick } else { Extent::Whole }
}
