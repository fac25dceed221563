//! The formats of particle files: a file here for each, and a line in each list below.

mod balls;
mod csv;
mod frames;
mod mmcif;
mod pdb;
mod structure;
mod xyz;

use std::path::Path;

use crate::error::{Flaw, LoadError};
use crate::file::ending;
use crate::particles::Particles;

pub use balls::pack_balls;
pub use frames::{PackedFrames, pack_frames};

/// How the bytes of a file give the particles of one scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// A table with a header line, comma-separated.
    Csv,
    /// XYZ and extended XYZ: a count, a comment, and one line for each particle.
    Xyz,
    /// The Protein Data Bank's format of fixed columns.
    Pdb,
    /// The Protein Data Bank's format of keys and loops.
    Mmcif,
    /// Equal balls with positions of 16 bits, as [`pack_balls`] writes them.
    Balls,
}

/// What the names of files end in.
const ENDINGS: [(&str, Format); 7] = [
    ("csv", Format::Csv),
    ("xyz", Format::Xyz),
    ("pdb", Format::Pdb),
    ("ent", Format::Pdb),
    ("cif", Format::Mmcif),
    ("mmcif", Format::Mmcif),
    ("balls", Format::Balls),
];

impl Format {
    /// The format of a file by its name's ending, after which a `.gz` may stand.
    pub fn of(path: impl AsRef<Path>) -> Option<Self> {
        let ending = ending(path.as_ref())?;
        ENDINGS.iter().find(|(known, _)| *known == ending).map(|(_, format)| *format)
    }

    /// All endings, each with its dot.
    pub fn endings() -> impl Iterator<Item = String> {
        ENDINGS.iter().map(|(ending, _)| format!(".{ending}"))
    }

    /// The particles that the bytes of a file say, unpacked ones.
    ///
    /// # Errors
    /// [`LoadError::Content`] with the location in the bytes.
    pub fn parse(self, bytes: &[u8]) -> Result<Particles, LoadError> {
        Ok(self.content(bytes)?)
    }

    pub(crate) fn content(self, bytes: &[u8]) -> Result<Particles, Flaw> {
        match self {
            Self::Csv => csv::parse(bytes),
            Self::Xyz => xyz::parse(bytes),
            Self::Pdb => pdb::parse(bytes),
            Self::Mmcif => mmcif::parse(bytes),
            Self::Balls => balls::parse(bytes),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ending_is_documented() {
        let text = include_str!("../FORMATS.md");
        for ending in Format::endings() {
            assert!(text.contains(&format!("`{ending}`")), "{ending} is not in FORMATS.md");
        }
    }

    #[test]
    fn formats_are_known_by_their_ending() {
        assert_eq!(Format::of("b.CIF.gz"), Some(Format::Mmcif));
        assert_eq!(Format::of("a/pdb1u19.ent.gz"), Some(Format::Pdb));
        for other in ["a/b.toml", "b.frames", "pool.csv.bz2", "csv"] {
            assert_eq!(Format::of(other), None, "{other}");
        }
    }
}
