//! Particles of files: path → bytes → format → particles.

use std::path::Path;

use crate::error::LoadError;
use crate::file;
use crate::formats::Format;
use crate::particles::Particles;

/// The particles of a file, by the ending of its name.
///
/// # Errors
/// Names the file, with line and column or key, what was needed and what was found.
pub fn read(path: impl AsRef<Path>) -> Result<Particles, LoadError> {
    let path = path.as_ref();
    parsed(path, format_of(path)?, &file::read(path)?)
}

/// The particles of the bytes of a file: [`read`] without the file system. The ending of `name` says
/// the format, and whether the bytes are gzipped; errors name it.
///
/// # Errors
/// As [`read`].
pub fn parse(name: impl AsRef<Path>, bytes: &[u8]) -> Result<Particles, LoadError> {
    let name = name.as_ref();
    parsed(name, format_of(name)?, &file::unpacked(name, bytes.into())?)
}

/// The format of a file that holds particles.
pub(crate) fn format_of(path: &Path) -> Result<Format, LoadError> {
    Format::of(path).ok_or_else(|| LoadError::UnknownFormat {
        file: path.display().to_string(),
        endings: Format::endings().collect::<Vec<_>>().join(", "),
    })
}

fn parsed(path: &Path, format: Format, bytes: &[u8]) -> Result<Particles, LoadError> {
    let file = path.display().to_string();
    let particles = format.content(bytes).map_err(|flaw| flaw.in_file(&file))?;
    Ok(Particles { file: Some(file), ..particles })
}
