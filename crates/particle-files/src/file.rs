//! Files by name: their ending, and their bytes.

use std::borrow::Cow;
use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::error::LoadError;

/// What a file's name ends in, in lower case and without the dot. A `.gz` after it is left out.
pub(crate) fn ending(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?.to_ascii_lowercase();
    let (_, ending) = name.strip_suffix(".gz").unwrap_or(&name).rsplit_once('.')?;
    Some(ending.to_owned())
}

/// The bytes of a file, unpacked if its name ends in `.gz`.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, LoadError> {
    let bytes = std::fs::read(path)
        .map_err(|source| LoadError::Read { file: path.display().to_string(), source })?;
    Ok(unpacked(path, bytes.into())?.into_owned())
}

/// The bytes of a file of that name, unpacked if it ends in `.gz`.
pub(crate) fn unpacked<'a>(path: &Path, bytes: Cow<'a, [u8]>) -> Result<Cow<'a, [u8]>, LoadError> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gz")) {
        return Ok(bytes);
    }
    let mut unpacked = Vec::new();
    MultiGzDecoder::new(&*bytes)
        .read_to_end(&mut unpacked)
        .map_err(|source| LoadError::Read { file: path.display().to_string(), source })?;
    Ok(unpacked.into())
}
