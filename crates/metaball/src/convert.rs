//! Particles from one file to another.

use std::path::Path;

use particle_files::{ConvertError, Notes, ReadOptions, WriteFormat, convert};
use picture_files::{refuse_overlap, write_atomically};

use crate::Error;

/// Writes the particles of a file in another format, the one that the output's ending names: XYZ, CSV,
/// NPY, PLY or VTP. See [`particle_files::convert`].
///
/// # Errors
/// When the input cannot be read, the output not be written, or both are one file.
pub fn convert_file(
    input: impl AsRef<Path>,
    output: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<(WriteFormat, Notes), Error> {
    let (input, output) = (input.as_ref(), output.as_ref());
    let format = WriteFormat::of(output)?;
    let topology = options.topology.iter().map(|path| ("topology", path.clone()));
    let inputs: Vec<_> = [("input", input.to_owned())].into_iter().chain(topology).collect();
    refuse_overlap(&[("particles", output.to_owned())], &inputs)?;
    let mut bytes = Vec::new();
    let notes = convert(input, options, format, &mut bytes).map_err(|error| match error {
        ConvertError::Load(error) => Error::Load(error),
        // A Vec takes all bytes.
        error => Error::Frames(error.into()),
    })?;
    write_atomically(output, &bytes)?;
    Ok((format, notes))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn nothing_is_written_over_the_input() {
        let folder = tempfile::tempdir().expect("a folder");
        let (table, other) = (folder.path().join("a.csv"), folder.path().join("b.xyz"));
        fs::write(&table, "x,y,z\n1,2,3\n").expect("written");
        let options = ReadOptions::default();
        let refused = convert_file(&table, &table, &options).expect_err("refused").to_string();
        assert!(refused.contains("a.csv"), "{refused}");
        let with = ReadOptions { topology: Some(other.clone()), ..ReadOptions::default() };
        let refused = convert_file(&table, &other, &with).expect_err("refused").to_string();
        assert!(refused.contains("b.xyz") && !other.exists(), "{refused}");
        assert!(convert_file(&table, folder.path().join("b.doc"), &options).is_err());
        convert_file(&table, &other, &options).expect("legal");
        let written = fs::read_to_string(&other).expect("text");
        assert_eq!(written, "1\nProperties=pos:R:3\n1 2 3\n");
    }
}
