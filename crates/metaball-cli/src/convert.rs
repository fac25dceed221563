//! The command `convert`.

use std::path::PathBuf;

use clap::Args;
use metaball::convert_file;
use particle_files::ReadOptions;

use crate::reading::TableArgs;
use crate::says::{line, say_notes, speaker};

#[derive(Debug, Args)]
pub(crate) struct ConvertArgs {
    /// The file to read, in any format; - for standard input.
    input: PathBuf,
    /// The file to write: .xyz (all frames, columns and the cell), .csv, .npy, .ply or .vtp.
    output: PathBuf,
    #[command(flatten)]
    reading: TableArgs,
}

impl ConvertArgs {
    pub(crate) fn run(&self) -> anyhow::Result<()> {
        let options = self.reading.put_into(ReadOptions::default());
        let (format, notes) = convert_file(&self.input, &self.output, &options)?;
        let says = speaker([self.output.as_path()].into_iter());
        say_notes(says, &notes);
        line(says, "written", &format!("{format} to {}", self.output.display()));
        Ok(())
    }
}
