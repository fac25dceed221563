//! The command `tables`: a subcommand for each paper or question.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use experiments::tables::{
    Extent, Order, TEN_MINUTES, auto, gourmel, illes, kanamori, peers, specialisation,
};

use crate::shared::AdapterArgs;
use crate::values;

/// Whose tables are measured.
#[derive(Debug, Subcommand)]
pub(crate) enum TablesCommand {
    /// Gourmel et al. 2010: tables 1, 3, 4 and 5, both heuristics, and plots of frame time; 640 × 480
    /// pixels, 320 × 240 on a software adapter.
    Gourmel(TablesArgs),
    /// Gourmel et al. 2010: table 2, what shadows and reflections cost, and table 1 under each scene's own
    /// effects; 640 × 480 pixels, 160 × 120 on a software adapter.
    GourmelLight(TablesArgs),
    /// Kanamori et al. 2008: table 1 against the CPU, the optimisations of section 5, time against
    /// error, figure 8 and the scenes of section 6.
    Kanamori {
        /// Everything, however long it takes; else what fits into ten minutes, and the rest is named.
        #[arg(long, conflicts_with = "quick")]
        full: bool,
        #[command(flatten)]
        tables: TablesArgs,
    },
    /// Illés and Szécsi: table 1 at 1024 × 768 pixels, how its phases grow, lists, figure 7, errors by
    /// kernel, memory.
    Illes {
        /// Everything, however long it takes; else what fits into ten minutes, and the rest is named.
        #[arg(long, conflicts_with = "quick")]
        full: bool,
        #[command(flatten)]
        tables: TablesArgs,
    },
    /// No paper: fbvh-certified on the CPU against POV-Ray's blob, time and error, power kernel α = 2.
    Peers {
        /// Known names, generators, or files; five scenes of 5,547 to 128,000 balls when left out.
        #[arg(value_name = "SCENE")]
        scenes: Vec<String>,
        /// Hundreds of balls, small pictures: seconds, to see that everything works.
        #[arg(long)]
        quick: bool,
        /// Pixels across and down; 640x480 when left out.
        #[arg(long, value_name = "WxH", value_parser = values::size)]
        size: Option<(u32, u32)>,
        /// Folder for peers.html and peers.json.
        #[arg(long, value_name = "DIR", default_value = "out/tables")]
        out: PathBuf,
    },
    /// No paper: what auto chooses for two errors, beside the quickest of all that it could have chosen;
    /// 320 × 240 pixels.
    Auto {
        /// Known names, generators, or files; eight scenes when left out.
        #[arg(value_name = "SCENE")]
        scenes: Vec<String>,
        #[command(flatten)]
        tables: TablesArgs,
    },
    /// No paper: frame time, memory and code with shaders made for a scene, against shaders that read
    /// its kernel, exponent, radii, strengths or colours, or count their work; 160 × 120 pixels.
    Specialisation {
        /// Known names, generators, or files; four scenes of 4,000 to 30,720 balls when left out.
        #[arg(value_name = "SCENE")]
        scenes: Vec<String>,
        #[command(flatten)]
        tables: TablesArgs,
    },
}

/// What tables take that are drawn with an adapter.
#[derive(Debug, Args)]
pub(crate) struct TablesArgs {
    /// Small scenes, small pictures: at most a minute, to see that everything works.
    #[arg(long)]
    quick: bool,
    /// Pixels across and down, in the place of the tables' own.
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    size: Option<(u32, u32)>,
    /// Folder for the page and the numbers.
    #[arg(long, value_name = "DIR", default_value = "out/tables")]
    out: PathBuf,
    #[command(flatten)]
    device: AdapterArgs,
}

impl TablesArgs {
    fn order(self) -> Order {
        let Self { quick, size, out, device } = self;
        Order { extent: extent(quick), size, adapter: device.choice(), out }
    }
}

fn extent(quick: bool) -> Extent {
    if quick { Extent::Quick } else { Extent::Whole }
}

impl TablesCommand {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        let time = |full: bool| (!full).then_some(TEN_MINUTES);
        match self {
            Self::Gourmel(tables) => gourmel::tables(&tables.order()),
            Self::GourmelLight(tables) => gourmel::light::tables(&tables.order()),
            Self::Kanamori { full, tables } => kanamori::tables(&tables.order(), time(full)),
            Self::Illes { full, tables } => illes::tables(&tables.order(), time(full)),
            Self::Peers { scenes, quick, size, out } => {
                peers::tables(&peers::Order { scenes, extent: extent(quick), size, out })
            }
            Self::Auto { scenes, tables } => auto::tables(&tables.order(), &scenes),
            Self::Specialisation { scenes, tables } => {
                specialisation::tables(&tables.order(), &scenes)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Command, parse};

    #[test]
    fn what_fits_and_everything() {
        let Ok(Command::Tables { of: TablesCommand::Kanamori { full, tables } }) =
            parse("metaball tables kanamori --full --size 64x48")
        else {
            panic!("a legal command line");
        };
        let order = tables.order();
        assert!(full && order.extent == Extent::Whole);
        assert_eq!((order.size, order.out), (Some((64, 48)), PathBuf::from("out/tables")));
        assert!(parse("metaball tables kanamori --full --quick").is_err());
        assert!(parse("metaball tables auto --full").is_err());
        assert!(parse("metaball tables").is_err());
    }
}
