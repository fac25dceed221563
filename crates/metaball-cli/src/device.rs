//! The command `device`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};
use experiments::device::{self, OwnPart, Scale, run_part};

use crate::shared::AdapterArgs;

#[derive(Debug, Args)]
pub(crate) struct DeviceArgs {
    /// How long it may take in all.
    #[arg(long, value_name = "M", default_value = "8", value_parser = clap::value_parser!(u16).range(1..))]
    minutes: u16,
    /// Small scenes, small pictures, and canaries that must fail: to see that everything works.
    #[arg(long)]
    rehearse: bool,
    /// One part alone, in this process: what the command starts a process for.
    #[arg(long, value_name = "NAME", hide = true)]
    part: Option<PartName>,
    /// Without an adapter, in one part alone.
    #[arg(long, hide = true, requires = "part", conflicts_with_all = ["adapter", "software"])]
    cpu: bool,
    /// Folder for device.json, summary.txt, and a folder for each part.
    #[arg(long, value_name = "DIR", default_value = "out/device")]
    out: PathBuf,
    #[command(flatten)]
    adapter: AdapterArgs,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum PartName {
    Adapter,
    Agreement,
    Light,
    Sizes,
    Effects,
    Panic,
    Hang,
}

impl From<PartName> for OwnPart {
    fn from(name: PartName) -> Self {
        match name {
            PartName::Adapter => Self::Adapter,
            PartName::Agreement => Self::Agreement,
            PartName::Light => Self::Light,
            PartName::Sizes => Self::Sizes,
            PartName::Effects => Self::Effects,
            PartName::Panic => Self::Panic,
            PartName::Hang => Self::Hang,
        }
    }
}

impl DeviceArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        let Self { minutes, rehearse, part, cpu, out, adapter } = self;
        let scale = if rehearse { Scale::Rehearsal } else { Scale::Whole };
        let adapter = adapter.choice();
        match part {
            Some(part) => run_part(part.into(), scale, (!cpu).then_some(&adapter), &out),
            None => {
                let time = Duration::from_secs(60 * u64::from(minutes));
                device::device(&device::Options { scale, time, adapter, out })
            }
        }
    }
}
