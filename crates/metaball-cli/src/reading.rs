//! How a file is read: its options.

use std::path::PathBuf;

use clap::Args;
use particle_files::{ColorBy, ReadOptions, Rule, Selection, Substance, Unit};

use crate::formula::FormulaArgs;

#[derive(Debug, Args)]
#[command(next_help_heading = "Reading a file (what was read and guessed is said)")]
pub(crate) struct ReadingArgs {
    /// What the particles are: molecule (van der Waals radii and colours of elements) or particles.
    #[arg(long = "as", value_name = "WHAT")]
    substance: Option<Substance>,
    /// The radius at which every particle alone shows, in the file's unit.
    #[arg(long, value_name = "R", conflicts_with = "support_radius")]
    radius: Option<f32>,
    /// The support radius of every particle, where its kernel ends, in the file's unit.
    #[arg(long, value_name = "R")]
    support_radius: Option<f32>,
    /// Multiply all radii.
    #[arg(long, value_name = "S")]
    radius_scale: Option<f32>,
    #[command(flatten)]
    table: TableArgs,
    /// Colour by a column: a colour map for numbers, from the least to the greatest or FROM..TO; a colour
    /// for each word (element, chain, residue, type). A legend is written beside the picture.
    #[arg(long, value_name = "COLUMN[=FROM..TO]")]
    color_by: Option<ColorBy>,
    /// Draw the periodic cell so often along each edge.
    #[arg(long, value_name = "X,Y,Z", value_parser = repeat)]
    repeat: Option<[u32; 3]>,
    /// Let surfaces go on across the faces of the periodic cell, and cut them there.
    #[arg(long)]
    periodic: bool,
    /// Show particles far from the others too.
    #[arg(long)]
    frame_all: bool,
    #[command(flatten)]
    formula: FormulaArgs,
}

/// Which particles of a file are read.
#[derive(Debug, Args)]
pub(crate) struct TableArgs {
    /// The unit of the file's lengths, for molecules: A, nm or m.
    #[arg(long, value_name = "UNIT")]
    units: Option<Unit>,
    /// The frame of a file that holds many, counted from 0.
    #[arg(long, value_name = "N")]
    frame: Option<u32>,
    /// The model of a structure, by its number in the file.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    model: Option<i64>,
    /// The structure file that says what the particles of a trajectory are: its columns are theirs.
    #[arg(long, value_name = "FILE")]
    topology: Option<PathBuf>,
    /// Names of a table's columns, in their order.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    columns: Option<Vec<String>>,
    /// Keep only these particles: water, hydrogen, COLUMN=VALUE,… or COLUMN=FROM..TO (residue=ALA,GLY,
    /// chain=A, type=1, mass=0.5..2); may be repeated: what any of them names is kept.
    #[arg(long, value_name = "RULE")]
    keep: Vec<Rule>,
    /// Leave these particles out, as for --keep.
    #[arg(long, value_name = "RULE")]
    drop: Vec<Rule>,
}

impl ReadingArgs {
    pub(crate) fn options(&self) -> ReadOptions {
        self.table.put_into(ReadOptions {
            substance: self.substance,
            radius: self.radius,
            support_radius: self.support_radius,
            radius_scale: self.radius_scale,
            formula: self.formula.options(),
            color_by: self.color_by.clone(),
            repeat: self.repeat,
            periodic: self.periodic,
            frame_all: self.frame_all,
            ..ReadOptions::default()
        })
    }
}

impl TableArgs {
    /// The options with these in them.
    pub(crate) fn put_into(&self, options: ReadOptions) -> ReadOptions {
        ReadOptions {
            units: self.units,
            frame: self.frame,
            model: self.model,
            topology: self.topology.clone(),
            columns: self.columns.clone(),
            selection: Selection { keep: self.keep.clone(), drop: self.drop.clone() },
            ..options
        }
    }
}

fn repeat(text: &str) -> Result<[u32; 3], String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    numbers
        .and_then(|numbers| numbers.try_into().ok())
        .filter(|numbers: &[u32; 3]| !numbers.contains(&0))
        .ok_or_else(|| "needed three numbers above 0 such as 2,2,1".to_owned())
}
