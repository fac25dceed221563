//! Particles as files for other programs: a file here for each format.

mod csv;
mod npy;
mod ply;
mod vtp;
mod xyz;

use std::fmt;
use std::io::{self, Write};
use std::path::Path;

use crate::error::LoadError;
use crate::file::ending;
use crate::notes::Notes;
use crate::options::parameter;
use crate::table::{Column, Table, Values};

/// A format that particles are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WriteFormat {
    /// Extended XYZ, with any number of frames, all columns and the periodic cell.
    Xyz,
    /// A table with commas, with all columns.
    Csv,
    /// A NumPy array of n × 3 f64, or a structured one where there are columns.
    Npy,
    /// Binary PLY, with the columns of numbers.
    Ply,
    /// VTK's XML format of points, with the columns of numbers.
    Vtp,
}

const ENDINGS: [(&str, WriteFormat); 6] = [
    ("xyz", WriteFormat::Xyz),
    ("extxyz", WriteFormat::Xyz),
    ("csv", WriteFormat::Csv),
    ("npy", WriteFormat::Npy),
    ("ply", WriteFormat::Ply),
    ("vtp", WriteFormat::Vtp),
];

impl WriteFormat {
    /// The format by what a file's name ends in.
    ///
    /// # Errors
    /// When no format that is written has that ending.
    pub fn of(path: impl AsRef<Path>) -> Result<Self, LoadError> {
        let path = path.as_ref();
        // What follows a packing's ending is not looked at: nothing packed is written.
        let packed = path.extension().is_some_and(|last| last == "gz" || last == "zst");
        let ending = ending(path).filter(|_| !packed);
        let known = ENDINGS.iter().find(|(known, _)| Some(*known) == ending.as_deref());
        known.map(|(_, format)| *format).ok_or_else(|| {
            let endings: Vec<String> =
                ENDINGS.iter().map(|(known, _)| format!(".{known}")).collect();
            let needed = format!("a name that ends in {}", endings.join(", "));
            parameter("output", &needed, format_args!("{:?}", path.display().to_string()))
        })
    }

    /// Whether a file holds more than one frame.
    pub fn holds_frames(self) -> bool {
        self == Self::Xyz
    }

    /// Writes a frame; behind the ones before, where the format holds several. Reading it gives the same
    /// numbers to the last bit, and the same columns, save those that the notes name.
    ///
    /// # Errors
    /// The writer's.
    pub fn write(self, table: &Table, to: &mut impl Write, notes: &mut Notes) -> io::Result<()> {
        if self != Self::Xyz && table.cell.is_some() {
            notes.left_out("the periodic cell, which an .xyz file holds");
        }
        match self {
            Self::Xyz => xyz::write(table, to, notes),
            Self::Csv => csv::write(table, to),
            Self::Npy => npy::write(table, to),
            Self::Ply => ply::write(table, to, notes),
            Self::Vtp => vtp::write(table, to, notes),
        }
    }
}

impl fmt::Display for WriteFormat {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Xyz => "extended XYZ",
            Self::Csv => "CSV",
            Self::Npy => "NPY",
            Self::Ply => "PLY",
            Self::Vtp => "VTP",
        })
    }
}

/// The columns of numbers, for formats that hold no words; the notes name the others.
fn numbers_of<'a>(table: &'a Table, notes: &mut Notes) -> Vec<(&'a str, &'a [f64])> {
    let numbers = |column: &'a Column| match &column.values {
        Values::Numbers(numbers) => Some((column.name.as_str(), numbers.as_slice())),
        Values::Words(_) => None,
    };
    let words = table.columns.iter().filter(|column| numbers(column).is_none());
    let words: Vec<&str> = words.map(|column| column.name.as_str()).collect();
    if !words.is_empty() {
        notes.left_out(format!("columns of words: {} (.xyz and .csv hold them)", words.join(", ")));
    }
    table.columns.iter().filter_map(numbers).collect()
}

/// A name of one word.
fn one_word(name: &str) -> String {
    let word: String = name
        .chars()
        .map(|c| if c.is_whitespace() || "\"'=:<>&".contains(c) { '_' } else { c })
        .collect();
    if word.is_empty() { "_".to_owned() } else { word }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::cell::Cell;
    use crate::formats::Format;
    use crate::formats::Request;

    /// What is read of what is written.
    fn read_back(format: WriteFormat, tables: &[Table]) -> Vec<Table> {
        let mut bytes = Vec::new();
        for table in tables {
            format.write(table, &mut bytes, &mut Notes::default()).expect("a Vec takes all bytes");
        }
        let read = Format::of_binary(&bytes).or_else(|| Format::of_text(&bytes, None));
        let reader = read.unwrap_or_else(|| panic!("{format} is not recognised")).reader();
        let frames = (reader.frames)(&bytes).expect("frames");
        let table = |span| {
            (reader.table)(&bytes, span, &Request::default(), &mut Notes::default()).expect("legal")
        };
        frames.iter().map(table).collect()
    }

    fn table() -> Table {
        let mut table = Table {
            positions: vec![DVec3::new(1.0 / 3.0, -1e-300, 5.0), DVec3::new(1e17, 0.1, -0.0)],
            ..Table::default()
        };
        table.add("mass", Values::Numbers(vec![0.1 + 0.2, 7.0]));
        table.add("element", Values::Words(["O", "H"].into_iter().collect()));
        table.add("velocity:0", Values::Numbers(vec![1.0, 2.0]));
        table.add("velocity:1", Values::Numbers(vec![-1.0, f64::MIN_POSITIVE]));
        table
    }

    fn column(table: &Table, name: &str) -> Values {
        let found = table.columns.iter().find(|column| column.name == name);
        found.unwrap_or_else(|| panic!("{name} among {:?}", table.columns)).values.clone()
    }

    #[test]
    fn what_is_written_is_read() {
        let table = table();
        for (_, format) in ENDINGS {
            let [read] = <[Table; 1]>::try_from(read_back(format, std::slice::from_ref(&table)))
                .expect("one frame");
            assert_eq!(read.positions, table.positions, "{format}");
            for name in ["mass", "velocity:0", "velocity:1"] {
                assert_eq!(column(&read, name), column(&table, name), "{format}");
            }
        }
        for (format, name) in [
            (WriteFormat::Csv, "element"),
            (WriteFormat::Xyz, "species"),
            (WriteFormat::Npy, "element"),
        ] {
            let read = &read_back(format, std::slice::from_ref(&table))[0];
            assert_eq!(column(read, name), column(&table, "element"), "{format}");
        }
    }

    #[test]
    fn xyz_holds_frames_and_the_cell() {
        let cell = Cell {
            origin: DVec3::X,
            periodic: [true, false, true],
            ..Cell::new([DVec3::X, DVec3::new(0.5, 2.0, 0.0), 3.0 * DVec3::Z]).expect("a cell")
        };
        let first = Table { cell: Some(cell), ..table() };
        let read = read_back(WriteFormat::Xyz, &[first, Table::default(), table()]);
        assert_eq!(read.iter().map(Table::len).collect::<Vec<_>>(), [2, 0, 2]);
        assert_eq!((read[0].cell, read[2].cell), (Some(cell), None));
    }

    #[test]
    fn words_that_are_left_out_are_named() {
        let mut notes = Notes::default();
        WriteFormat::Ply
            .write(&table(), &mut Vec::new(), &mut notes)
            .expect("a Vec takes all bytes");
        assert!(notes.iter().any(|note| note.text.contains("columns of words: element")));
    }

    #[test]
    fn endings_say_the_format() {
        assert_eq!(WriteFormat::of("a.XYZ").expect("known"), WriteFormat::Xyz);
        for name in ["a.pdb", "a.xyz.gz", "a"] {
            let message = WriteFormat::of(name).expect_err("refused").to_string();
            assert!(message.starts_with("output: needed a name that ends in .xyz"), "{message}");
        }
    }

    proptest! {
        #[test]
        fn all_numbers_are_read_back(
            rows in prop::collection::vec(prop::array::uniform4(any::<f64>()), 1..20),
        ) {
            let finite = |number: f64| if number.is_finite() { number } else { 0.5 };
            let mut table = Table {
                positions: rows.iter().map(|row| DVec3::from_slice(&row.map(finite))).collect(),
                ..Table::default()
            };
            table.add("value", Values::Numbers(rows.iter().map(|row| finite(row[3])).collect()));
            for (_, format) in ENDINGS {
                let read = read_back(format, std::slice::from_ref(&table));
                prop_assert_eq!(&read[0].positions, &table.positions);
                prop_assert_eq!(column(&read[0], "value"), column(&table, "value"));
            }
        }

        #[test]
        fn all_words_are_read_back_from_csv(words in prop::collection::vec("[a-z\",; ]{0,5}", 1..6)) {
            let mut table = Table { positions: vec![DVec3::X; words.len()], ..Table::default() };
            let trimmed = words.iter().map(|word| word.trim());
            table.add("name", Values::Words(trimmed.collect()));
            let read = read_back(WriteFormat::Csv, std::slice::from_ref(&table));
            prop_assert_eq!(column(&read[0], "name"), column(&table, "name"));
        }
    }
}
