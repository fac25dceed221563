//! From one format to another.

use std::io::{self, Write};
use std::path::Path;

use thiserror::Error;

use crate::error::LoadError;
use crate::file;
use crate::notes::Notes;
use crate::options::ReadOptions;
use crate::read::Content;
use crate::table::Table;
use crate::units::Unit;
use crate::write::WriteFormat;

/// Why a file was not converted.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConvertError {
    /// The input cannot be read.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The output cannot be written.
    #[error("cannot write the particles")]
    Write(#[from] io::Error),
}

/// Writes the particles of a file, with all that it says of them, in another format: all frames where
/// that holds several and none is asked for, else one. Lengths of molecules become ångströms; sizes,
/// colours and repetition are no part of a file's particles, and those options are not looked at.
///
/// # Errors
/// As [`read`](crate::read()); and the writer's.
pub fn convert(
    path: impl AsRef<Path>,
    options: &ReadOptions,
    format: WriteFormat,
    to: &mut impl Write,
) -> Result<Notes, ConvertError> {
    let path = path.as_ref();
    let content = Content::new(path, file::read(path)?.into())?;
    let frames = match options.frame {
        None if format.holds_frames() => 0..content.frames() as u32,
        frame => frame.unwrap_or(0)..frame.unwrap_or(0) + 1,
    };
    let count = frames.len();
    let mut notes = Notes::default();
    for frame in frames {
        let (table, mut of_frame) = if count > 1 {
            content.whole_table(&ReadOptions { frame: Some(frame), ..options.clone() })?
        } else {
            content.whole_table(options)?
        };
        let table = in_angstroms(table, options.units, &mut of_frame);
        of_frame.read(table.counted());
        format.write(&table, to, &mut of_frame)?;
        if notes.is_empty() {
            notes = of_frame;
        }
    }
    if count > 1 {
        notes.read(format!("{count} frames are written; what is said is of the first"));
    }
    Ok(notes)
}

/// Atoms in ångströms; other particles in the unit of their file.
fn in_angstroms(mut table: Table, asked: Option<Unit>, notes: &mut Notes) -> Table {
    let unit = asked.or(table.unit).filter(|unit| table.atoms && *unit != Unit::Angstrom);
    let Some(unit) = unit else { return table };
    let factor = unit.angstroms();
    table.positions.iter_mut().for_each(|position| *position *= factor);
    table.cell = table.cell.map(|cell| cell.scaled(factor));
    notes.changed(format!("lengths from {unit} to ångströms"));
    table
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::PathBuf;

    use super::*;

    fn file(name: &str, text: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("convert-{}-{name}", std::process::id()));
        fs::write(&path, text).expect("the temporary folder is writable");
        path
    }

    fn converted(path: &Path, options: &ReadOptions, format: WriteFormat) -> (String, String) {
        let mut bytes = Vec::new();
        let notes = convert(path, options, format, &mut bytes).expect("legal");
        let notes = notes.iter().map(|note| format!("{note}\n")).collect();
        (String::from_utf8(bytes).expect("text"), notes)
    }

    #[test]
    fn tables_become_xyz_and_frames_stay_frames() {
        let table = file("a.csv", "x,y,z,mass\n1,2,3,0.1\n4,5,6,0.2\n");
        let options = ReadOptions {
            selection: crate::Selection::without("mass=0.2".parse().expect("legal")),
            ..Default::default()
        };
        let (text, _) = converted(&table, &options, WriteFormat::Xyz);
        assert_eq!(text, "1\nProperties=pos:R:3:mass:R:1\n1 2 3 0.1\n");

        let frames = file("b.xyz", "1\n\nH 0 0 0\n1\n\nO 0 0 0.25\n");
        let (text, notes) = converted(&frames, &ReadOptions::default(), WriteFormat::Xyz);
        assert_eq!(text.matches("Properties=species:S:1:pos:R:3").count(), 2);
        assert!(notes.contains("2 frames are written"), "{notes}");
        let (text, notes) = converted(&frames, &ReadOptions::default(), WriteFormat::Csv);
        assert_eq!(text, "x,y,z,species\n0,0,0,H\n");
        assert!(notes.contains("1 frame after the first"), "{notes}");
        let second = ReadOptions { frame: Some(1), ..Default::default() };
        let (text, _) = converted(&frames, &second, WriteFormat::Csv);
        assert_eq!(text, "x,y,z,species\n0,0,0.25,O\n");
    }
}
