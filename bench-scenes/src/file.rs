//! Particle files: what kind a path is, its bytes, and what they say.

use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::error::{Flaw, LoadError};
use crate::particles::Particles;
use crate::{molecule, quantized, table, xyz};

/// A format, known by a file's ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FileKind {
    SceneFile,
    Table,
    Xyz,
    Pdb,
    Mmcif,
    Quantized,
    Frames,
}

impl FileKind {
    /// By the ending, before which a `.gz` may stand; `None` for others.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?.to_ascii_lowercase();
        let (_, ending) = name.strip_suffix(".gz").unwrap_or(&name).rsplit_once('.')?;
        match ending {
            "toml" => Some(Self::SceneFile),
            "csv" => Some(Self::Table),
            "xyz" => Some(Self::Xyz),
            "pdb" | "ent" => Some(Self::Pdb),
            "cif" | "mmcif" => Some(Self::Mmcif),
            "balls" => Some(Self::Quantized),
            "frames" => Some(Self::Frames),
            _ => None,
        }
    }

    /// Whether it holds the particles of one scene.
    pub(crate) fn is_particles(self) -> bool {
        !matches!(self, Self::SceneFile | Self::Frames)
    }

    /// Reads the content of a particle file.
    pub(crate) fn parse(self, bytes: &[u8]) -> Result<Particles, Flaw> {
        match self {
            Self::SceneFile => Err(Flaw::needed("a particle file", "a scene file")),
            Self::Frames => Err(Flaw::needed("the particles of one scene", "those of many frames")),
            Self::Table => table::parse(bytes),
            Self::Xyz => xyz::parse(text(bytes)?),
            Self::Pdb => molecule::parse_pdb(bytes),
            Self::Mmcif => molecule::parse_mmcif(bytes),
            Self::Quantized => quantized::parse(bytes),
        }
    }
}

/// The bytes of a file, unpacked if its name ends in `.gz`.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, LoadError> {
    let packed = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gz"));
    std::fs::read(path)
        .and_then(|bytes| if packed { unpack(&bytes) } else { Ok(bytes) })
        .map_err(|source| LoadError::Read { file: path.display().to_string(), source })
}

/// The content of gzipped bytes.
pub(crate) fn unpack(packed: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    MultiGzDecoder::new(packed).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The bytes as text.
pub(crate) fn text(bytes: &[u8]) -> Result<&str, Flaw> {
    std::str::from_utf8(bytes).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        Flaw::needed("UTF-8 text", "other bytes").at_line(line)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_known_by_their_ending() {
        let kind = |path: &str| FileKind::of(Path::new(path));
        assert_eq!(kind("a/b.toml"), Some(FileKind::SceneFile));
        assert_eq!(kind("b.CIF.gz"), Some(FileKind::Mmcif));
        assert_eq!(kind("pdb1u19.ent.gz"), Some(FileKind::Pdb));
        assert_eq!(kind("pool.csv.bz2"), None);
        assert_eq!(kind("csv"), None);
    }

    #[test]
    fn other_bytes_than_text_are_placed() {
        let flaw = text(b"one\ntwo\n\xff").expect_err("refused");
        assert_eq!(flaw.place.line, Some(3));
    }
}
