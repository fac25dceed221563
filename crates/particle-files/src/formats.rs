//! The formats of particle files: a file here for each, and a line in each list below.

mod alternatives;
mod atoms;
mod balls;
mod bgeo;
mod csv;
mod dcd;
mod frames;
mod gro;
mod lammps_data;
mod lammps_dump;
mod mmcif;
mod models;
mod npy;
mod npz;
mod pdb;
mod pdbqt;
mod ply;
mod pqr;
#[cfg(test)]
mod testing;
mod trr;
mod vtk;
mod vtk_xml;
mod xtc;
mod xyz;

use std::fmt;
use std::ops::Range;

use crate::error::Flaw;
use crate::notes::Notes;
use crate::roles::Role;
use crate::table::Table;

pub use balls::pack_balls;
pub use frames::{PackedFrames, pack_frames};

/// How the bytes of a file give particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Equal balls with positions of 16 bits, as [`pack_balls`] writes them.
    Balls,
    /// The Protein Data Bank's format of keys and loops.
    Mmcif,
    /// The Protein Data Bank's format of fixed columns.
    Pdb,
    /// PDB with charges and radii.
    Pqr,
    /// PDB with charges and the types of AutoDock.
    Pdbqt,
    /// GROMACS' format of fixed columns.
    Gro,
    /// XYZ and extended XYZ: a count, a comment, and one line for each particle.
    Xyz,
    /// LAMMPS dumps as text.
    LammpsDump,
    /// LAMMPS data files.
    LammpsData,
    /// Points of legacy VTK files.
    Vtk,
    /// Points of VTK's XML files.
    VtkXml,
    /// Vertices of PLY files.
    Ply,
    /// An array of NumPy.
    Npy,
    /// Named arrays of NumPy.
    Npz,
    /// Points of Houdini before version 12.
    Bgeo,
    /// Trajectories of GROMACS with rounded positions.
    Xtc,
    /// Trajectories of GROMACS with all digits.
    Trr,
    /// Trajectories of CHARMM, NAMD and those like them.
    Dcd,
    /// A table: rows of fields, mostly below a line of names.
    Csv,
}

/// All formats, in the order in which a content is tried to be one of them: the more a format
/// demands, the earlier.
const FORMATS: [Format; 19] = [
    Format::Balls,
    Format::Vtk,
    Format::VtkXml,
    Format::Ply,
    Format::Npy,
    Format::Npz,
    Format::Bgeo,
    Format::Xtc,
    Format::Trr,
    Format::Dcd,
    Format::LammpsDump,
    Format::LammpsData,
    Format::Mmcif,
    Format::Gro,
    Format::Pdb,
    Format::Pqr,
    Format::Pdbqt,
    Format::Xyz,
    Format::Csv,
];

/// How files of one format are read.
pub(crate) struct Reader {
    /// What people call the format.
    pub(crate) name: &'static str,
    /// What the names of such files end in: a hint where a content could be of several formats.
    pub(crate) endings: &'static [&'static str],
    /// Whether the bytes are text: decoded before anybody looks at them.
    pub(crate) is_text: bool,
    /// Whether a content is of this format. Looks at its beginning only.
    pub(crate) recognizes: fn(&[u8]) -> bool,
    /// Where the frames are.
    pub(crate) frames: fn(&[u8]) -> Result<Vec<Span>, Flaw>,
    /// The particles of one of them, from all bytes.
    pub(crate) table: fn(&[u8], &Span, &Request, &mut Notes) -> Result<Table, Flaw>,
}

/// Where a frame is in the bytes of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Span {
    pub(crate) bytes: Range<usize>,
    /// The number of its first line in the file, counted from 1.
    pub(crate) line: usize,
}

impl Span {
    /// The whole file.
    pub(crate) fn whole(bytes: &[u8]) -> Self {
        Self { bytes: 0..bytes.len(), line: 1 }
    }
}

/// What of a frame is to be read.
#[derive(Debug, Clone, Default)]
pub(crate) struct Request {
    pub(crate) wanted: Wanted,
    /// The model of a structure, by its number in the file; the first one where this is `None`.
    pub(crate) model: Option<i64>,
    /// Names for the columns of a table instead of its own.
    pub(crate) names: Option<Vec<String>>,
}

/// Which columns are wanted beside positions.
#[derive(Debug, Clone, Default)]
pub(crate) enum Wanted {
    /// Those that say what the particles are, and those of these names.
    Named(Vec<String>),
    #[default]
    All,
}

impl Wanted {
    /// Whether a column of this name is wanted.
    pub(crate) fn wants(&self, name: &str) -> bool {
        let Self::Named(names) = self else { return true };
        let role = Role::of(name);
        let is_named = |named: &String| {
            named.eq_ignore_ascii_case(name) || (role.is_some() && Role::of(named) == role)
        };
        role.is_some_and(Role::makes_balls) || names.iter().any(is_named)
    }
}

impl Format {
    /// The binary format of a content.
    pub(crate) fn of_binary(bytes: &[u8]) -> Option<Self> {
        let recognized = |format: &Self| {
            let reader = format.reader();
            !reader.is_text && (reader.recognizes)(bytes)
        };
        FORMATS.into_iter().find(recognized)
    }

    /// The format of a text, of a file whose name ends so: the first that its content can be, but one that
    /// has this ending before all others.
    pub(crate) fn of_text(bytes: &[u8], ending: Option<&str>) -> Option<Self> {
        let recognized = |format: &Self| {
            let reader = format.reader();
            reader.is_text && (reader.recognizes)(bytes)
        };
        let hinted = |format: &Self| ending.is_some_and(|ending| format.has_ending(ending));
        let mut possible = FORMATS.into_iter().filter(recognized);
        possible.clone().find(hinted).or_else(|| possible.next())
    }

    /// The format of a text that its content does not tell, by the ending of its name: one whose reader
    /// says which line is not as it should be.
    pub(crate) fn of_ending(ending: &str) -> Option<Self> {
        let by_line = [Self::Xyz, Self::Csv, Self::Gro, Self::Mmcif];
        by_line.into_iter().find(|format| format.has_ending(ending))
    }

    /// Whether its frames are models with numbers.
    pub(crate) fn has_models(self) -> bool {
        matches!(self, Self::Mmcif | Self::Pdb | Self::Pqr | Self::Pdbqt)
    }

    pub(crate) fn reader(self) -> &'static Reader {
        match self {
            Self::Balls => &balls::READER,
            Self::Mmcif => &mmcif::READER,
            Self::Pdb => &pdb::READER,
            Self::Pqr => &pqr::READER,
            Self::Pdbqt => &pdbqt::READER,
            Self::Gro => &gro::READER,
            Self::Xyz => &xyz::READER,
            Self::LammpsDump => &lammps_dump::READER,
            Self::LammpsData => &lammps_data::READER,
            Self::Vtk => &vtk::READER,
            Self::VtkXml => &vtk_xml::READER,
            Self::Ply => &ply::READER,
            Self::Npy => &npy::READER,
            Self::Npz => &npz::READER,
            Self::Bgeo => &bgeo::READER,
            Self::Xtc => &xtc::READER,
            Self::Trr => &trr::READER,
            Self::Dcd => &dcd::READER,
            Self::Csv => &csv::READER,
        }
    }

    /// All formats.
    pub fn all() -> impl Iterator<Item = Self> {
        FORMATS.into_iter()
    }

    /// What the names of such files end in, in lower case and without the dot.
    pub fn endings(self) -> &'static [&'static str] {
        self.reader().endings
    }

    /// Whether it holds where particles are, and nothing of what they are.
    pub(crate) fn is_trajectory(self) -> bool {
        matches!(self, Self::Xtc | Self::Trr | Self::Dcd)
    }

    pub(crate) fn has_ending(self, ending: &str) -> bool {
        self.endings().contains(&ending)
    }
}

impl fmt::Display for Format {
    /// What people call it.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.reader().name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_give_a_reader_to_what_no_content_tells() {
        assert_eq!(Format::of_text(b"lon,lat,depth\n1,2,3\n", Some("csv")), None);
        assert_eq!(Format::of_ending("csv"), Some(Format::Csv));
        assert_eq!(Format::of_ending("extxyz"), Some(Format::Xyz));
        assert_eq!(Format::of_ending("pdb"), None);
    }

    #[test]
    fn every_format_is_listed_and_documented() {
        let text = include_str!("../FORMATS.md");
        for format in Format::all() {
            for ending in format.endings() {
                assert!(text.contains(&format!("`.{ending}`")), ".{ending} is not in FORMATS.md");
            }
        }
    }
}
