//! PDBQT (AutoDock): PDB with a partial charge and an AutoDock type behind each atom.

use super::atoms::{B_FACTOR, CHARGE, OCCUPANCY, RESIDUE_NUMBER, Wants};
use super::models::asked_for;
use super::pdb::line::AtomLine;
use super::pdb::{first_atoms, frames, is_like_pdb, models, named, read};
use super::{Reader, Request, Span};
use crate::error::Flaw;
use crate::notes::Notes;
use crate::number::{DecimalMark, number};
use crate::table::Table;

pub(super) const READER: Reader = Reader {
    name: "PDBQT",
    endings: &["pdbqt"],
    is_text: true,
    recognizes: is_like_pdb,
    frames,
    table,
};

/// Whether atoms have a charge where PDB has none, and a type.
pub(super) fn is_certain(bytes: &[u8]) -> bool {
    let is_pdbqt = |line: &[u8]| {
        AtomLine::read(line).is_ok_and(|line| charge(&line).is_some() && !kind(&line).is_empty())
    };
    first_atoms(bytes).next().is_some() && first_atoms(bytes).all(is_pdbqt)
}

fn charge(line: &AtomLine<'_>) -> Option<f64> {
    let field = line.columns(67, 76);
    number(field, DecimalMark::Point).filter(|_| field.contains(&b'.'))
}

/// The AutoDock type.
fn kind<'a>(line: &'a AtomLine<'a>) -> &'a [u8] {
    line.columns(77, 80)
}

fn table(bytes: &[u8], span: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let wants = Wants::of(request, &[RESIDUE_NUMBER, CHARGE, OCCUPANCY, B_FACTOR]);
    let span = asked_for(|| models(bytes), span, request, notes)?;
    let atoms = read(bytes, &span, wants, |line| {
        let mut atom = named(line, wants);
        atom.element = element(kind(line));
        if wants.numbers[CHARGE] {
            atom.numbers[CHARGE] = charge(line).unwrap_or(f64::NAN);
        }
        Ok(atom)
    })?;
    Ok(atoms.table(notes))
}

/// The element of an AutoDock type: mostly a symbol, with letters for what it does.
fn element(kind: &[u8]) -> &[u8] {
    match kind {
        b"A" | b"CG0" | b"CG1" | b"CG2" | b"CG3" => b"C",
        b"HD" | b"HS" => b"H",
        b"NA" | b"NS" => b"N",
        b"OA" | b"OS" => b"O",
        b"SA" => b"S",
        // The other half of a bond that was opened, and places for water.
        b"G" | b"G0" | b"G1" | b"G2" | b"G3" | b"GA" | b"J" | b"Q" | b"W" => b"DU",
        kind => kind,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::formats::Format;

    fn line(name: &str, kind: &str) -> String {
        format!(
            "ATOM      1 {name:<4} LIG A   1       1.000   2.000   3.000  1.00  0.50    -0.287 {kind:<2}\n"
        )
    }

    fn read_all(text: &str) -> (Table, usize) {
        let mut notes = Notes::default();
        let spans = frames(text.as_bytes()).expect("atoms");
        let table = table(text.as_bytes(), &spans[0], &Request::default(), &mut notes);
        (table.expect("legal"), notes.iter().count())
    }

    #[test]
    fn types_say_elements() {
        let types = ["C", "A", "N", "NA", "OA", "SA", "HD", "Cl", "CL", "Br", "Zn", "MG", "Na"];
        let text: String = types.iter().map(|kind| line("XX", kind)).collect();
        let (table, _) = read_all(&text);
        let column = table.column("element").expect("elements");
        let found: Vec<_> = (0..table.len()).map(|index| column.values.text(index)).collect();
        let elements = ["C", "C", "N", "N", "O", "S", "H", "Cl", "Cl", "Br", "Zn", "Mg", "Na"];
        assert_eq!(found, elements);
        let charges = table.column("charge").expect("charges");
        assert_eq!(charges.values.text(0), "-0.287");
        let (table, notes) = read_all(&(line("C1", "C") + &line("W", "W")));
        assert_eq!((table.len(), notes), (1, 1));
    }

    #[test]
    fn it_is_recognized_by_its_charges() {
        let text = "ROOT\n".to_owned() + &line("CA", "A");
        for ending in [None, Some("pdb"), Some("pdbqt")] {
            assert_eq!(Format::of_text(text.as_bytes(), ending), Some(Format::Pdbqt));
        }
        let pdb = text.replace("    -0.287 A ", "           C");
        assert_eq!(Format::of_text(pdb.as_bytes(), Some("pdb")), Some(Format::Pdb));
    }

    proptest! {
        #[test]
        fn no_change_panics(at in any::<prop::sample::Index>(), byte in any::<u8>()) {
            let mut bytes = line("CA", "A").repeat(2).into_bytes();
            let at = at.index(bytes.len());
            bytes[at] = byte;
            let _ = is_certain(&bytes);
            for span in frames(&bytes).unwrap_or_default() {
                let _ = table(&bytes, &span, &Request::default(), &mut Notes::default());
            }
        }
    }
}
