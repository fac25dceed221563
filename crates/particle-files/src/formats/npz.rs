//! NPZ: arrays of NumPy with names. One has positions, or three have their coordinates; those with as
//! many rows are columns.

use std::borrow::Cow;

use super::npy::Array;
use super::{Reader, Request, Span};
use crate::binary;
use crate::error::Flaw;
use crate::notes::Notes;
use crate::roles::Role;
use crate::table::{Table, Values, component};
use crate::zip;

pub(super) const READER: Reader = Reader {
    name: "NPZ",
    endings: &["npz"],
    is_text: false,
    recognizes: |bytes| bytes.starts_with(zip::MAGIC),
    frames: |bytes| Ok(vec![Span::whole(bytes)]),
    table,
};

/// What arrays of positions are called, without capitals.
const POSITIONS: [&str; 12] = [
    "positions",
    "position",
    "pos",
    "points",
    "coordinates",
    "coords",
    "coord",
    "xyz",
    "vertices",
    "centers",
    "centres",
    "x",
];

/// More components than these become no columns.
const COMPONENTS: usize = 16;

fn table(bytes: &[u8], _: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let mut files = Vec::new();
    for entry in zip::entries(bytes)? {
        let name = entry.name.strip_suffix(".npy").unwrap_or(&entry.name).to_owned();
        files.push((name, entry.unpacked()?));
    }
    let arrays = Arrays::of(&files);
    let (mut table, used) = arrays.positions(notes)?;
    let mut left_out = Vec::new();
    for (name, array) in &arrays.all {
        let components = array.components().filter(|count| (1..=COMPONENTS).contains(count));
        match components {
            _ if used.contains(&name.as_str()) => {}
            Some(count) if array.shape.first() == Some(&table.len()) => {
                for index in 0..count {
                    let name = component(name, index, count);
                    if request.wanted.wants(&name) {
                        table.add(name, Values::Numbers(array.column(index)));
                    }
                }
            }
            _ => left_out.push(format!("{name} of {}", array.described())),
        }
    }
    left_out.extend(arrays.others.iter().map(|(name, _)| format!("{name}, which is no numbers")));
    if !left_out.is_empty() {
        notes.left_out(format!("arrays that are no columns: {}", left_out.join("; ")));
    }
    Ok(table)
}

/// The arrays of a file.
struct Arrays<'a> {
    all: Vec<(&'a String, Array<'a>)>,
    /// What cannot be read, and why.
    others: Vec<(&'a String, Flaw)>,
}

impl<'a> Arrays<'a> {
    fn of(files: &'a [(String, Cow<'a, [u8]>)]) -> Self {
        let (mut all, mut others) = (Vec::new(), Vec::new());
        for (name, bytes) in files {
            match Array::of(bytes) {
                Ok(array) => all.push((name, array)),
                Err(flaw) => others.push((name, flaw)),
            }
        }
        Self { all, others }
    }

    /// Positions, and the names of the arrays that have them.
    fn positions(&self, notes: &mut Notes) -> Result<(Table, Vec<&'a str>), Flaw> {
        let axis = |axis: usize| {
            let is_axis = |(name, array): &&(&'a String, Array<'_>)| {
                array.components() == Some(1) && Role::of(name).and_then(Role::axis) == Some(axis)
            };
            self.all.iter().find(is_axis)
        };
        if let [Some((x_name, x)), Some((y_name, y)), Some((z_name, z))] = [0, 1, 2].map(axis) {
            let names = [x_name, y_name, z_name].map(|name| name.as_str());
            if x.shape != y.shape || y.shape != z.shape {
                let needed = format!("as many numbers in each of {}", names.join(", "));
                return Err(Flaw::needed(&needed, self.described()));
            }
            let axes = [x, y, z].map(|array| array.numbers(0));
            let [Some(x), Some(y), Some(z)] = axes else { return Ok(Default::default()) };
            let positions = binary::positions([x, y, z])?;
            return Ok((Table { positions, ..Table::default() }, names.to_vec()));
        }
        let of_three = || self.all.iter().filter(|(_, array)| array.components() == Some(3));
        let named = POSITIONS
            .iter()
            .find_map(|known| of_three().find(|(name, _)| name.eq_ignore_ascii_case(known)));
        let only = of_three().next().filter(|_| of_three().count() == 1);
        let Some((name, array)) = named.or(only) else {
            let needed = "an array of shape (n, 3) called positions, or three called x, y and z";
            return Err(Flaw::needed(needed, self.described()));
        };
        notes.read(format!("positions from the array {name:?}"));
        let positions = array.positions().map_err(|flaw| flaw.at_key(name))?;
        Ok((Table { positions, ..Table::default() }, vec![name]))
    }

    /// All arrays with their shapes.
    fn described(&self) -> String {
        let read = self.all.iter().map(|(name, array)| format!("{name} of {}", array.described()));
        let others = self.others.iter().map(|(name, flaw)| format!("{name} ({})", flaw.problem));
        let all: Vec<String> = read.chain(others).collect();
        if all.is_empty() { "no array".to_owned() } else { all.join("; ") }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::formats::npy::tests::file;
    use crate::zip::tests::archive;

    fn numbers(shape: &str, numbers: &[f64]) -> Vec<u8> {
        let data: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        file(1, "'<f8'", false, shape, &data)
    }

    fn packed(arrays: &[(&str, Vec<u8>)], is_deflated: bool) -> Vec<u8> {
        let names: Vec<String> = arrays.iter().map(|(name, _)| format!("{name}.npy")).collect();
        let files: Vec<(&str, &[u8])> = names
            .iter()
            .zip(arrays)
            .map(|(name, (_, array))| (name.as_str(), &array[..]))
            .collect();
        archive(&files, is_deflated)
    }

    fn read(bytes: &[u8]) -> Result<(Table, Notes), Flaw> {
        let mut notes = Notes::default();
        let table = table(bytes, &Span::whole(bytes), &Request::default(), &mut notes)?;
        Ok((table, notes))
    }

    fn names(table: &Table) -> Vec<&str> {
        table.columns.iter().map(|column| column.name.as_str()).collect()
    }

    fn good() -> [(&'static str, Vec<u8>); 5] {
        [
            ("v", numbers("(2, 3)", &[6.0; 6])),
            ("pos", numbers("(2, 3)", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])),
            ("mass", numbers("(2,)", &[0.5, 0.25])),
            ("time", numbers("()", &[1.0])),
            ("names", file(1, "'|O'", false, "(2,)", b"pickled")),
        ]
    }

    #[test]
    fn arrays_of_as_many_rows_are_columns() {
        for is_deflated in [false, true] {
            let (table, notes) = read(&packed(&good(), is_deflated)).expect("legal");
            assert_eq!(table.positions, [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)]);
            assert_eq!(names(&table), ["v:0", "v:1", "v:2", "mass"]);
            assert_eq!(table.columns[3].values, Values::Numbers(vec![0.5, 0.25]));
            let left_out =
                "arrays that are no columns: time of shape () of f64; names, which is no numbers";
            assert!(notes.iter().any(|note| note.text == left_out));
        }
    }

    #[test]
    fn positions_are_found() {
        let coordinates = ["x", "y", "z"].map(|name| (name, numbers("(1,)", &[7.0])));
        let (table, _) = read(&packed(&coordinates, false)).expect("legal");
        assert_eq!((table.positions[0], table.columns.len()), (DVec3::splat(7.0), 0));
        let only = [("arr_0", numbers("(1, 3)", &[7.0, 8.0, 9.0]))];
        assert_eq!(read(&packed(&only, false)).expect("legal").0.positions[0].z, 9.0);
    }

    #[test]
    fn refusals_name_arrays_and_shapes() {
        let problem =
            |arrays: &[(&str, Vec<u8>)]| read(&packed(arrays, true)).expect_err("refused").problem;
        let two = [("a", numbers("(1, 3)", &[7.0; 3])), ("b", numbers("(1, 3)", &[7.0; 3]))];
        assert!(
            problem(&two).ends_with("found a of shape (1, 3) of f64; b of shape (1, 3) of f64")
        );
        let mut coordinates = ["x", "y", "z"].map(|name| (name, numbers("(1,)", &[7.0])));
        coordinates[1].1 = numbers("(2,)", &[7.0; 2]);
        assert!(
            problem(&coordinates)
                .starts_with("needed as many numbers in each of x, y, z, found x of")
        );
        assert!(problem(&good()[4..]).contains("names (needed numbers such as <f4 or <f8"));
        assert!(problem(&[]).ends_with("found no array"));
    }

    proptest! {
        #[test]
        fn no_mutated_file_panics(at: prop::sample::Index, byte: u8, cut: prop::sample::Index) {
            let mut bytes = packed(&good(), false);
            let cut = cut.index(bytes.len());
            let at = at.index(bytes.len());
            bytes[at] = byte;
            let _ = (read(&bytes), read(&bytes[..cut]));
        }
    }
}
