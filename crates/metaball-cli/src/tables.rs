//! The command `tables`: a subcommand for each paper or question.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand};
use experiments::tables::{
    Options, TEN_MINUTES, auto, gourmel, illes, kanamori, peers, specialisation,
};

use crate::shared::{AdapterArgs, extent};
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
    Kanamori(TimedTablesArgs),
    /// Illés and Szécsi: table 1 at 1024 × 768 pixels, how its phases grow, lists, figure 7, errors by
    /// kernel, memory.
    Illes(TimedTablesArgs),
    /// No paper: fbvh-certified on the CPU against programs that one would take instead (POV-Ray's blob, VTK
    /// with Mitsuba, Embree; what is missing is skipped, and how to install it said), primary rays and lit
    /// pictures, power kernel α = 2.
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
    /// Pixels across and down, instead of the tables' own.
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    size: Option<(u32, u32)>,
    /// Folder for the page and the numbers.
    #[arg(long, value_name = "DIR", default_value = "out/tables")]
    out: PathBuf,
    #[command(flatten)]
    adapter: AdapterArgs,
}

/// What tables take that measure what fits into a time.
#[derive(Debug, Args)]
pub(crate) struct TimedTablesArgs {
    /// Everything, however long it takes; else what fits into ten minutes, and the rest is named.
    #[arg(long, conflicts_with = "quick")]
    full: bool,
    #[command(flatten)]
    tables: TablesArgs,
}

impl TablesArgs {
    fn options(self) -> Options {
        let Self { quick, size, out, adapter } = self;
        Options { extent: extent(quick), size, adapter: adapter.choice(), out }
    }
}

impl TimedTablesArgs {
    fn time(&self) -> Option<Duration> {
        (!self.full).then_some(TEN_MINUTES)
    }
}

impl TablesCommand {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Gourmel(tables) => gourmel::tables(&tables.options()),
            Self::GourmelLight(tables) => gourmel::light::tables(&tables.options()),
            Self::Kanamori(timed) => {
                let time = timed.time();
                kanamori::tables(&timed.tables.options(), time)
            }
            Self::Illes(timed) => {
                let time = timed.time();
                illes::tables(&timed.tables.options(), time)
            }
            Self::Peers { scenes, quick, size, out } => {
                peers::tables(&peers::Options { scenes, extent: extent(quick), size, out })
            }
            Self::Auto { scenes, tables } => auto::tables(&tables.options(), &scenes),
            Self::Specialisation { scenes, tables } => {
                specialisation::tables(&tables.options(), &scenes)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use experiments::extent::Extent;

    use super::*;
    use crate::{Command, parse};

    #[test]
    fn what_fits_and_everything() {
        let Ok(Command::Tables { of: TablesCommand::Kanamori(timed) }) =
            parse("metaball tables kanamori --full --size 64x48")
        else {
            panic!("a legal command line");
        };
        assert!(timed.full && timed.time().is_none());
        let options = timed.tables.options();
        assert_eq!(options.extent, Extent::Whole);
        assert_eq!((options.size, options.out), (Some((64, 48)), PathBuf::from("out/tables")));
        assert!(parse("metaball tables kanamori --full --quick").is_err());
        assert!(parse("metaball tables auto --full").is_err());
        assert!(parse("metaball tables").is_err());
    }
}
