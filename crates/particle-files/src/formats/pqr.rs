//! PQR (PDB2PQR, APBS): PDB with each atom's charge and radius behind its coordinates, in columns or with
//! blanks between all words.

use glam::DVec3;

use super::atoms::{Atom, Atoms, CHARGE, RADIUS, RESIDUE_NUMBER, Wants};
use super::models::asked_for;
use super::pdb::line::{AtomLine, Kind, kind};
use super::pdb::{first_atoms, frames, is_like_pdb, models, named};
use super::{Reader, Request, Span};
use crate::error::Flaw;
use crate::notes::Notes;
use crate::number::{DecimalMark, number};
use crate::table::Table;
use crate::text::{fields, lines, word};

pub(super) const READER: Reader =
    Reader { name: "PQR", endings: &["pqr"], is_text: true, recognizes, frames, table };

fn recognizes(bytes: &[u8]) -> bool {
    let is_pqr = |line: &[u8]| PqrLine::read(line).is_ok();
    is_like_pdb(bytes) && first_atoms(bytes).next().is_some() && first_atoms(bytes).all(is_pqr)
}

/// Whether a content of this format cannot be PDB: columns 55 to 66 are no occupancy and B factor, or a
/// remark says so.
pub(super) fn is_certain(bytes: &[u8]) -> bool {
    let says_so =
        |line: &[u8]| line.starts_with(b"REMARK") && memchr::memmem::find(line, b"PQR").is_some();
    let is_other = |line: &[u8]| {
        let in_columns = AtomLine::read(line).ok().filter(|_| !line.contains(&b'\t'));
        in_columns.is_some_and(|line| !line.is_moved && !fits_pdb(&line))
    };
    recognizes(bytes)
        && (lines(bytes, 1).take(20).any(|(_, line)| says_so(line))
            || first_atoms(bytes).all(is_other))
}

/// Whether what follows the coordinates can be occupancy and B factor.
fn fits_pdb(line: &AtomLine<'_>) -> bool {
    let is_number = |field: &[u8]| field.is_empty() || number(field, DecimalMark::Point).is_some();
    is_number(line.columns(55, 60)) && is_number(line.columns(61, 66))
}

fn table(bytes: &[u8], span: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let wants = Wants::of(request, &[RESIDUE_NUMBER, CHARGE, RADIUS]);
    let span = asked_for(|| models(bytes), span, request, notes)?;
    let atoms = |has_radii: bool| {
        let read = |bytes: &[u8], first, atoms: &mut Atoms| {
            for (number, line) in lines(bytes, first) {
                let at_line = |flaw: Flaw| flaw.at_line(number);
                if kind(line).map_err(at_line)? == Kind::Atom {
                    let line = PqrLine::read(line).map_err(at_line)?;
                    atoms.push(&line.atom(wants, has_radii), number);
                }
            }
            Ok(())
        };
        Atoms::of_lines(&bytes[span.bytes.clone()], span.line, wants, read)
    };
    let with_radii = atoms(true)?;
    if !with_radii.is_empty() {
        return Ok(with_radii.table(notes));
    }
    let table = atoms(false)?.table(notes);
    if !table.is_empty() {
        notes.guessed("all radii of the file are 0: it has none");
    }
    Ok(table)
}

/// A line that says an atom.
#[derive(Debug)]
struct PqrLine<'a> {
    /// The line, where its columns are those of PDB.
    columns: Option<AtomLine<'a>>,
    /// The words before the coordinates: serial number, name, residue, chain or none, number of the
    /// residue.
    words: Vec<&'a [u8]>,
    position: DVec3,
    charge: f64,
    radius: f64,
    element: &'a [u8],
}

impl<'a> PqrLine<'a> {
    fn read(line: &'a [u8]) -> Result<Self, Flaw> {
        let start = line.trim_ascii_start();
        let record = if start[..4].eq_ignore_ascii_case(b"ATOM") { 4 } else { 6 };
        let mut words: Vec<&[u8]> = fields(&start[record..]).collect();
        let is_symbol = |word: &&[u8]| word.len() < 3 && word.iter().all(u8::is_ascii_alphabetic);
        let columns = AtomLine::read(line).ok();
        let has_element = !columns.as_ref().is_some_and(fits_pdb);
        let element = words.pop_if(|word| has_element && is_symbol(word)).unwrap_or_default();
        let read =
            |word: &[u8]| number(word, DecimalMark::Point).filter(|number| number.is_finite());
        let numbers: Option<Vec<f64>> = words.iter().rev().take(5).map(|word| read(word)).collect();
        if let Some(&[radius, charge, z, y, x]) = numbers.as_deref()
            && matches!(words.len(), 9 | 10)
        {
            words.truncate(words.len() - 5);
            let position = DVec3::new(x, y, z);
            let columns = columns.filter(|columns| columns.position == position);
            return Ok(Self { columns, words, position, charge, radius, element });
        }
        // Coordinates that touch are told apart by their columns.
        let columns = AtomLine::read(line)?;
        let numbers: Option<Vec<f64>> = {
            let behind = fields(columns.behind());
            behind.filter(|word| !(has_element && is_symbol(word))).map(read).collect()
        };
        let Some(&[charge, radius]) = numbers.as_deref() else {
            let found = format!("{:?}", word(columns.behind()));
            return Err(Flaw::needed("a charge and a radius behind the coordinates", found));
        };
        let position = columns.position;
        Ok(Self { columns: Some(columns), words: Vec::new(), position, charge, radius, element })
    }

    fn atom(&self, wants: Wants, has_radii: bool) -> Atom<'_> {
        let of_words = |name, residue, chain, number: &'a [u8]| {
            let letter =
                number.len() - usize::from(number.last().is_some_and(u8::is_ascii_alphabetic));
            let (residue_number, insertion) = number.split_at(letter);
            Atom { name, residue, chain, residue_number, insertion, ..Atom::default() }
        };
        let mut atom = match (&self.columns, &self.words[..]) {
            (Some(columns), _) => named(columns, wants),
            (None, [_, name, residue, chain, number]) => of_words(name, residue, chain, number),
            (None, [_, name, residue, number]) => of_words(name, residue, b"", number),
            _ => Atom::default(),
        };
        atom.position = self.position;
        atom.element = self.element;
        atom.numbers[CHARGE] = self.charge;
        atom.numbers[RADIUS] = if has_radii { self.radius } else { f64::NAN };
        if wants.numbers[RESIDUE_NUMBER] && self.columns.is_none() {
            let number = number(atom.residue_number, DecimalMark::Point);
            atom.numbers[RESIDUE_NUMBER] = number.unwrap_or(f64::NAN);
        }
        atom
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::formats::Format;
    use crate::formats::testing::words;

    fn read_all(text: &str) -> Result<(Table, Vec<String>), Flaw> {
        let mut notes = Notes::default();
        let spans = frames(text.as_bytes())?;
        let table = table(text.as_bytes(), &spans[0], &Request::default(), &mut notes)?;
        Ok((table, notes.iter().map(|note| note.text.clone()).collect()))
    }

    const COLUMNS: &str = "ATOM      1  CA  ALA     1       1.000   2.000   3.000  0.1414 1.8240\n";

    #[test]
    fn charges_and_radii_are_read_in_columns_or_between_blanks() {
        for text in [
            COLUMNS,
            "ATOM 1 CA ALA 1 1.0 2.0 3.0 0.1414 1.824\n",
            "ATOM 1 CA ALA A 1H 1.00000 2.00000 3.00000 0.1414 1.824\n",
            "ATOM 1 CA ALA A 1 1.0 2.0 3.0 0.1414 1.824 C\n",
            "HETATM10000 CA ALA A 1 1.0 2.0 3.0 0.1414 1.824\n",
        ] {
            let (table, _) = read_all(text).expect("legal");
            assert_eq!(table.positions, [DVec3::new(1.0, 2.0, 3.0)], "{text}");
            let found = ["element", "name", "residue", "residue_number", "charge", "radius"]
                .map(|name| words(&table, name).concat());
            assert_eq!(found, ["C", "CA", "ALA", "1", "0.1414", "1.824"], "{text}");
        }
        let touching = "ATOM      1  CA  ALA     1    -100.000-200.000-300.000  0.1414 1.8240\n";
        let (table, _) = read_all(touching).expect("legal");
        assert_eq!(table.positions, [DVec3::new(-100.0, -200.0, -300.0)]);
    }

    #[test]
    fn atoms_of_radius_0_do_not_show() {
        let hydrogen = COLUMNS.replace(" CA ", " HO ").replace("1.8240", "0.0000");
        let (table, notes) = read_all(&format!("{COLUMNS}{hydrogen}")).expect("legal");
        assert_eq!(table.len(), 1);
        assert_eq!(notes, ["1 atom of radius 0 (HO)"]);
        let (table, notes) = read_all(&hydrogen).expect("legal");
        assert!(table.len() == 1 && table.column("radius").is_none());
        assert_eq!(notes, ["all radii of the file are 0: it has none"]);
    }

    #[test]
    fn it_is_recognized_in_a_file_named_pdb() {
        let format = |text: &str, ending| Format::of_text(text.as_bytes(), Some(ending));
        assert_eq!(format(COLUMNS, "pdb"), Some(Format::Pqr));
        let says_so =
            "REMARK   1 PQR file generated by PDB2PQR\nATOM 1 CA ALA A 1 1.0 2.0 3.0 0.1 1.8\n";
        assert_eq!(format(says_so, "pdb"), Some(Format::Pqr));
        let pdb = "ATOM      1  CA  ALA     1       1.000   2.000   3.000  1.00  0.00\n";
        assert_eq!(format(pdb, "pdb"), Some(Format::Pdb));
        assert_eq!(format(&pdb.replace("0.00\n", "0.00           C\n"), "pqr"), Some(Format::Pdb));
        let free = "ATOM 1 N ALA A 1 0.000 0.000 0.000 1.00 0.00 N\n";
        for free in [free.to_owned(), free.replace(' ', "\t")] {
            assert_eq!(format(&free, "pdb"), Some(Format::Pdb), "{free}");
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>(), at in any::<prop::sample::Index>(), byte in any::<u8>()) {
            let mut changed = COLUMNS.repeat(2).into_bytes();
            let at = at.index(changed.len());
            changed[at] = byte;
            for bytes in [&bytes, &changed, &[&b"ATOM  "[..], &bytes].concat()] {
                let _ = recognizes(bytes);
                for span in frames(bytes).unwrap_or_default() {
                    let _ = table(bytes, &span, &Request::default(), &mut Notes::default());
                }
            }
        }
    }
}
