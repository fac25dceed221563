//! The Protein Data Bank's format of fixed columns (wwPDB, Atomic Coordinate Entry Format 3.3), as programs
//! write it: of a line only those columns are looked at that a picture needs.

pub(super) mod line;
mod models;

pub(super) use models::models;

use super::atoms::{Atom, Atoms, B_FACTOR, CHARGE, OCCUPANCY, RESIDUE_NUMBER, Wants};
use super::models::asked_for;
use super::{Reader, Request, Span, mmcif, pdbqt, pqr};
use crate::atom_names::is_known_residue;
use crate::cell::Cell;
use crate::error::Flaw;
use crate::notes::Notes;
use crate::number::{DecimalMark, number};
use crate::table::Table;
use crate::text::{fields, first_line, lines, word};
use line::{AtomLine, Kind, kind};

pub(super) const READER: Reader = Reader {
    name: "PDB",
    endings: &["pdb", "ent"],
    is_text: true,
    recognizes: |bytes| is_like_pdb(bytes) && !pqr::is_certain(bytes) && !pdbqt::is_certain(bytes),
    frames,
    table,
};

/// Whether a content is of this format or one of its relatives: it begins with one of their records, or
/// has atoms early on.
pub(super) fn is_like_pdb(bytes: &[u8]) -> bool {
    const RECORDS: [&[u8]; 31] = [
        b"HEADER", b"TITLE ", b"COMPND", b"REMARK", b"CRYST1", b"MODEL ", b"AUTHOR", b"EXPDTA",
        b"NUMMDL", b"SOURCE", b"OBSLTE", b"SPLIT ", b"CAVEAT", b"KEYWDS", b"MDLTYP", b"REVDAT",
        b"SPRSDE", b"JRNL  ", b"DBREF ", b"SEQADV", b"SEQRES", b"MODRES", b"HET   ", b"HETNAM",
        b"HELIX ", b"SHEET ", b"SSBOND", b"CISPEP", b"ORIGX1", b"SCALE1", b"CONECT",
    ];
    let (first, _) = first_line(bytes.trim_ascii_start());
    let is_record = RECORDS.contains(&[first, b"      "].concat().get(..6).unwrap_or_default());
    let begins_with_atoms = || lines(bytes, 1).take(200).any(|(_, line)| line::is_atom(line));
    !mmcif::is_mmcif(bytes) && (is_record || begins_with_atoms())
}

/// Some of the first atoms, behind a header that is not longer than most.
pub(super) fn first_atoms(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let beginning = lines(bytes, 1).take(20_000).map(|(_, line)| line);
    beginning.filter(|line| line::is_atom(line)).take(200)
}

/// A span for each model.
pub(super) fn frames(bytes: &[u8]) -> Result<Vec<Span>, Flaw> {
    Ok(models(bytes)?.into_iter().map(|model| model.span).collect())
}

fn table(bytes: &[u8], span: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let wants = Wants::of(request, &[RESIDUE_NUMBER, CHARGE, OCCUPANCY, B_FACTOR]);
    let span = asked_for(|| models(bytes), span, request, notes)?;
    let has_letters = names_are_aligned(&bytes[span.bytes.clone()]);
    let atoms = read(bytes, &span, wants, |line| {
        let mut atom = named(line, wants);
        let (element, charge) = element_and_charge(line);
        atom.element = element;
        atom.letters = has_letters.then(|| line.letters());
        if wants.numbers[CHARGE] {
            atom.numbers[CHARGE] = formal_charge(charge);
        }
        Ok(atom)
    })?;
    let cell = cell(bytes, &span, notes);
    Ok(Table { cell, ..atoms.table(notes) })
}

/// The atoms of a span, each as its line says it.
pub(super) fn read(
    bytes: &[u8],
    span: &Span,
    wants: Wants,
    atom: impl for<'a> Fn(&'a AtomLine<'a>) -> Result<Atom<'a>, Flaw> + Sync,
) -> Result<Atoms, Flaw> {
    let atoms =
        Atoms::of_lines(&bytes[span.bytes.clone()], span.line, wants, |bytes, first, atoms| {
            for (number, line) in lines(bytes, first) {
                let at_line = |flaw: Flaw| flaw.at_line(number);
                if kind(line).map_err(at_line)? == Kind::Atom {
                    let line = AtomLine::read(line).map_err(at_line)?;
                    if line.is_moved {
                        atoms.is_moved(number);
                    }
                    atoms.push(&atom(&line).map_err(at_line)?, number);
                }
            }
            Ok(())
        })?;
    check_end(bytes, span).map(|()| atoms)
}

/// Refuses a file that ends within the coordinates of an atom: digits may be missing.
fn check_end(bytes: &[u8], span: &Span) -> Result<(), Flaw> {
    let frame = &bytes[span.bytes.clone()];
    let begin = memchr::memrchr(b'\n', frame).map_or(0, |end| end + 1);
    let last = &frame[begin..];
    let is_last_atom = span.bytes.end == bytes.len() && kind(last)? == Kind::Atom;
    if is_last_atom && AtomLine::read(last)?.ends_early() {
        let line = span.line + memchr::memchr_iter(b'\n', frame).count();
        let needed = "three coordinates and an end of line";
        return Err(Flaw::needed(needed, "the end of the file within them").at_line(line));
    }
    Ok(())
}

/// What the columns say that all relatives of the format have: the place and the names.
pub(super) fn named<'a>(line: &'a AtomLine<'a>, wants: Wants) -> Atom<'a> {
    let (residue, chain) = line.residue_and_chain();
    let (residue_number, insertion) = line.residue_number();
    let is_asked = |index: usize| wants.numbers[index];
    let read = |from, to| number(line.columns(from, to), DecimalMark::Point).unwrap_or(f64::NAN);
    let mut numbers = Atom::default().numbers;
    numbers[OCCUPANCY] = read(55, 60);
    if is_asked(RESIDUE_NUMBER) {
        numbers[RESIDUE_NUMBER] = hybrid_36(residue_number);
    }
    if is_asked(B_FACTOR) {
        numbers[B_FACTOR] = read(61, 66);
    }
    Atom {
        position: line.position,
        name: line.columns(13, 16),
        residue,
        chain: if chain.is_empty() { line.columns(73, 76) } else { chain },
        residue_number,
        insertion,
        alternative: line.columns(17, 17),
        numbers,
        ..Atom::default()
    }
}

/// The element in columns 77 and 78, or a column beside them, and the charge behind it.
fn element_and_charge<'a>(line: &'a AtomLine<'a>) -> (&'a [u8], &'a [u8]) {
    let segment_is_blank = line.columns(73, 75).is_empty();
    let is_moved = segment_is_blank && !line.columns(76, 76).is_empty();
    let field = line.columns(if is_moved { 76 } else { 77 }, 80);
    let letters = field.iter().take_while(|byte| byte.is_ascii_alphabetic()).count();
    let (element, charge) = field.split_at(letters);
    (element, charge.trim_ascii())
}

/// A charge as `2+`, `+2` or `-`.
fn formal_charge(charge: &[u8]) -> f64 {
    let sign = match charge {
        [b'-', ..] | [.., b'-'] => -1.0,
        _ => 1.0,
    };
    let digits: Vec<u8> = charge.iter().copied().filter(u8::is_ascii_digit).collect();
    match digits.is_empty() {
        true if charge.contains(&b'+') || charge.contains(&b'-') => sign,
        true => f64::NAN,
        false => sign * number(&digits, DecimalMark::Point).unwrap_or(f64::NAN),
    }
}

/// A number of four digits; from `A000` on, in base 36, those above 9999 (hybrid-36,
/// Grosse-Kunstleve 2007).
fn hybrid_36(digits: &[u8]) -> f64 {
    let text = std::str::from_utf8(digits).unwrap_or_default();
    match (digits, text.parse::<i32>()) {
        (_, Ok(number)) => number.into(),
        ([b'A'..=b'Z' | b'a'..=b'z', _, _, _], _) => match i32::from_str_radix(text, 36) {
            // Ten thousand numbers of four digits, then 26 times 36 cubed with a capital.
            Ok(number) if digits[0] < b'a' => (number - 10 * 36_i32.pow(3) + 10_000).into(),
            Ok(number) => (number + 16 * 36_i32.pow(3) + 10_000).into(),
            Err(_) => f64::NAN,
        },
        _ => f64::NAN,
    }
}

/// Whether names stand where the format wants them, so that their column says how long the element's
/// symbol is; some programs begin all of them in column 13.
fn names_are_aligned(bytes: &[u8]) -> bool {
    let begins_early = |line: &[u8]| {
        AtomLine::read(line).is_ok_and(|line| {
            let name = line.columns(13, 16);
            let (residue, _) = line.residue_and_chain();
            line.letters() == 2
                && matches!(name[0], b'C' | b'N' | b'O' | b'S' | b'P')
                && (name.len() == 1 || (name.len() < 4 && is_known_residue(&word(residue))))
        })
    };
    !first_atoms(bytes).any(begins_early)
}

/// The periodic cell of a frame, or else the first of the file.
fn cell(bytes: &[u8], span: &Span, notes: &mut Notes) -> Option<Cell> {
    let is_cell = |(_, line): &(usize, &[u8])| line.starts_with(b"CRYST1");
    let first_atom = |(_, line): &(usize, &[u8])| !matches!(kind(line), Ok(Kind::Atom));
    let frame = lines(&bytes[span.bytes.clone()], span.line).take_while(first_atom);
    let file = lines(bytes, 1).take_while(first_atom);
    let (number, line) = frame.filter(is_cell).last().or_else(|| file.filter(is_cell).last())?;
    let numbers = six_numbers(line);
    let cell = numbers.map(|[a, b, c, alpha, beta, gamma]| {
        // What programs write where there is none: no lengths, or a cube of one ångström.
        let is_none = [a, b, c] == [0.0; 3] || [a, b, c] == [1.0; 3];
        (!is_none).then(|| Cell::of_lengths_and_angles([a, b, c], [alpha, beta, gamma]))
    });
    match cell {
        Some(None) => None,
        Some(Some(Some(cell))) => Some(cell),
        _ => {
            notes.left_out(format!(
                "the periodic cell: CRYST1 in line {number} has no three lengths and three angles"
            ));
            None
        }
    }
}

/// Lengths and angles, in their columns or between blanks.
fn six_numbers(line: &[u8]) -> Option<[f64; 6]> {
    const COLUMNS: [(usize, usize); 6] =
        [(6, 15), (15, 24), (24, 33), (33, 40), (40, 47), (47, 54)];
    let read = |field: &[u8]| number(field, DecimalMark::Point).filter(|number| number.is_finite());
    let in_columns: Option<Vec<f64>> =
        COLUMNS.iter().map(|(from, to)| read(line.get(*from..*to)?)).collect();
    let between_blanks = || fields(line).skip(1).take(6).map(read).collect();
    in_columns.or_else(between_blanks)?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::formats::testing::{changed, words};
    use crate::table::Values;

    fn read_all(text: &str) -> Result<(Table, Vec<String>), Flaw> {
        let mut notes = Notes::default();
        let spans = frames(text.as_bytes())?;
        let table = table(text.as_bytes(), &spans[0], &Request::default(), &mut notes)?;
        Ok((table, notes.iter().map(|note| note.text.clone()).collect()))
    }

    fn read(text: &str) -> Table {
        read_all(text).expect("legal").0
    }

    fn refusal(text: &str) -> String {
        read_all(text).expect_err("refused").in_file("a.pdb").to_string()
    }

    const ATOM: &str =
        "ATOM      1  CA BALA A  -5B      1.500  -2.250   3.125  0.40 12.50      SEGM C2-";

    #[test]
    fn columns_are_read() {
        let table = read(ATOM);
        assert_eq!(table.positions, [glam::DVec3::new(1.5, -2.25, 3.125)]);
        for (name, value) in [
            ("element", "C"),
            ("name", "CA"),
            ("residue", "ALA"),
            ("residue_number", "-5"),
            ("chain", "A"),
            ("charge", "-2"),
            ("occupancy", "0.4"),
            ("b_factor", "12.5"),
        ] {
            assert_eq!(words(&table, name), [value], "{name}");
        }
        assert!(table.atoms && table.cell.is_none() && table.lines.get(0) == Some(1));
    }

    #[test]
    fn long_beginnings_without_atoms_are_known() {
        for record in ["SEQRES", "CONECT", "HELIX ", "DBREF "] {
            let text = format!("{}{ATOM}\n", format!("{record}    1    2\n").repeat(300));
            assert!(is_like_pdb(text.as_bytes()), "{record}");
            assert_eq!(read(&text).len(), 1);
        }
    }

    #[test]
    fn serial_numbers_do_not_matter() {
        for serial in [
            "ATOM      1",
            "ATOM  A0000",
            "ATOM  *****",
            "ATOM  186a0",
            "ATOM       ",
            "HETATM10000",
        ] {
            assert_eq!(read(&ATOM.replace("ATOM      1", serial)).positions.len(), 1, "{serial}");
        }
    }

    #[test]
    fn lines_that_are_moved_as_a_whole_are_read() {
        let exact = read(ATOM);
        let serial = ATOM.replace("ATOM      1", "ATOM  1000000");
        for moved in [
            format!(" {ATOM}"),
            format!("\u{feff}\t{ATOM}").replace('\u{feff}', ""),
            serial,
            ATOM.replace("ATOM      1  CA", "ATOM      1\u{a0} CA"),
            ATOM.to_lowercase(),
            ATOM.replace("ATOM      1  CA BALA A  -5B   ", "ATOM\t1\tCA\tALA\tA\t-5\t"),
        ] {
            let (table, _) = read_all(&moved).unwrap_or_else(|flaw| panic!("{moved:?}: {flaw:?}"));
            assert_eq!(table.positions, exact.positions, "{moved:?}");
            assert_eq!(words(&table, "element"), ["C"], "{moved:?}");
            assert_eq!(words(&table, "residue_number"), ["-5"], "{moved:?}");
        }
        let (_, notes) = read_all(&format!("{ATOM}\n {ATOM}\n {ATOM}")).expect("legal");
        assert!(notes[0].starts_with("2 lines not in the columns"), "{notes:?}");
        assert!(notes[0].contains("line 2"), "{notes:?}");
    }

    #[test]
    fn residue_numbers_that_run_over_move_the_line() {
        let line =
            "ATOM      1  OW  HOH A10000       6.000   0.000   0.500  1.00  0.00           O";
        let table = read(line);
        assert_eq!(table.positions, [glam::DVec3::new(6.0, 0.0, 0.5)]);
        assert_eq!(
            (words(&table, "chain"), words(&table, "residue_number")),
            (vec!["A".into()], vec!["10000".into()])
        );
        let unmoved =
            "ATOM      1  OW  HOH A10000      6.000   0.000   0.500  1.00  0.00           O";
        assert_eq!(words(&read(unmoved), "residue_number"), ["10000"]);
        let hybrid =
            "ATOM      1  OW  HOH AA000       6.000   0.000   0.500  1.00  0.00           O";
        assert_eq!(words(&read(hybrid), "residue_number"), ["10000"]);
    }

    #[test]
    fn atoms_that_cannot_be_read_are_refused() {
        let starred = format!("{ATOM}\n{}", ATOM.replace("   1.500", "********"));
        let message = refusal(&starred);
        let expected = "a.pdb, line 2, column 31 (x): needed a finite number in columns 31 to 38, found \
                        \"********\"";
        assert!(message.starts_with(expected), "{message}");
        assert!(message.ends_with("save the file as mmCIF or XYZ"), "{message}");
        for bad in [
            "ATOM 1 N ALA A 1 0.0 0.0 0.0 1.00 0.00 N".to_owned(),
            "atom 1 n ala a 1 0.0 0.0 0.0".to_owned(),
            "ATOM      1  CA  ALA A   1".to_owned(),
            "ATOM".to_owned(),
            ATOM.replace("   1.500", "     nan"),
            ATOM.replace("   1.500", "     inf"),
            ATOM.replace("   1.500", "   1,500"),
            ATOM.replace("   1.500", "  1 .500"),
            ATOM.replace("   1.500  -2.250", "-10001.500  -2.250"),
            ATOM[..52].to_owned(),
            format!("{ATOM}  {ATOM}"),
            format!("END   {ATOM}"),
            format!("TER{ATOM}"),
            ATOM.replace("ATOM  ", "ATM   "),
            ATOM.replace("ATOM  ", "      "),
            ATOM.replace("ATOM  ", ""),
            ATOM.replace(' ', ","),
        ] {
            let message = refusal(&format!("{ATOM}\n{bad}"));
            assert!(message.starts_with("a.pdb, line 2"), "{bad}: {message}");
        }
    }

    #[test]
    fn short_lines_end_behind_the_coordinates() {
        assert_eq!(read(&ATOM[..54]).len(), 1);
        assert_eq!(read(&format!("{}\n", &ATOM[..53])).positions[0].z, 3.12);
        let with_two = ATOM.replace("   1.500  -2.250   3.125", "    1.50   -2.25    3.12");
        assert_eq!(read(&with_two).positions[0].x, 1.5);
    }

    #[test]
    fn elements_are_read_where_programs_put_them() {
        for (tail, element) in [
            ("           C", "C"),
            ("          C", "C"),
            ("          ZN", "Zn"),
            ("         ZN", "Zn"),
            ("           ZN", "Zn"),
            ("          zn2+", "Zn"),
            ("           D", "H"),
            ("            ", "O"),
            ("      1ABC  70", "O"),
            ("", "O"),
            ("           Q", "O"),
        ] {
            let line =
                format!("HETATM    1  O1  LIG A   1       1.000   2.000   3.000  1.00  0.00{tail}");
            assert_eq!(words(&read(&line), "element"), [element], "{tail:?}");
        }
    }

    #[test]
    fn names_that_begin_early_say_no_symbol_of_two_letters() {
        let line = |name: &str, residue: &str| {
            format!("ATOM      1 {name:<4} {residue:<4}A   1       1.000   2.000   3.000\n")
        };
        let aligned = format!("{}{}", line(" CA", "ALA"), line("CD", "LIG"));
        assert_eq!(words(&read(&aligned), "element"), ["C", "Cd"]);
        let early = format!("{}{}", line("CA", "ALA"), line("CD", "LIG"));
        assert_eq!(words(&read(&early), "element"), ["C", "C"]);
    }

    #[test]
    fn chains_of_two_letters_and_residues_of_four() {
        for (columns, residue, chain) in [
            ("ALA A", "ALA", "A"),
            ("ALAAA", "ALA", "AA"),
            ("TIP3A", "TIP3", "A"),
            ("POPCA", "POPC", "A"),
            ("HISDA", "HISD", "A"),
            ("POPC ", "POPC", "SEG"),
        ] {
            let line = format!(
                "ATOM      1  C   {columns}   1       1.000   2.000   3.000  1.00  0.00      SEG"
            );
            let table = read(&line);
            assert_eq!(words(&table, "residue"), [residue], "{columns}");
            assert_eq!(words(&table, "chain"), [chain], "{columns}");
        }
    }

    #[test]
    fn the_cell_is_read_or_said_to_be_none() {
        let cell = |cell: &str| {
            let (table, notes) = read_all(&format!("{cell}\n{ATOM}")).expect("legal");
            (table.cell.map(|cell| cell.edges.map(glam::DVec3::length)), notes.len())
        };
        let good = "CRYST1   30.000   40.000   50.000  90.00  90.00  90.00 P 1           1";
        assert_eq!(cell(good), (Some([30.0, 40.0, 50.0]), 0));
        assert_eq!(cell("CRYST1 30 40 50 90 90 90"), (Some([30.0, 40.0, 50.0]), 0));
        let dummy = "CRYST1    1.000    1.000    1.000  90.00  90.00  90.00 P 1           1";
        assert_eq!(cell(dummy), (None, 0));
        assert_eq!(
            cell("CRYST1    0.000    0.000    0.000  90.00  90.00  90.00 P 1           1"),
            (None, 0)
        );
        assert_eq!(cell("CRYST1   52.0"), (None, 1));
        assert_eq!(cell("CRYST1   30.000   40.000   50.000  90.00  90.00 190.00 P 1"), (None, 1));
        let second = format!("{good}\n{ATOM}\nEND\n{ATOM}\n");
        let spans = frames(second.as_bytes()).expect("legal");
        let second =
            table(second.as_bytes(), &spans[1], &Request::default(), &mut Notes::default());
        assert!(second.expect("legal").cell.is_some());
    }

    #[test]
    fn relatives_and_others_are_not_taken_for_it() {
        let recognizes = |text: &str| (READER.recognizes)(text.as_bytes());
        for text in [
            ATOM,
            &ATOM.replace("1.500  -2.250   3.125", "  nan     nan     nan"),
            "REMARK\n",
            "HEADER\n",
            "TITLE     none\n",
            "MODEL 1\n",
            "atom 1 n ala a 1 0.0 0.0 0.0\n",
        ] {
            assert!(recognizes(text), "{text}");
        }
        for text in
            ["", "atom,x,y,z\n", "atom\tx\ty\tz\n", "3\n\nO 0.0 0.0 0.0\n", "Atoms of iron\n"]
        {
            assert!(!recognizes(text), "{text}");
        }
    }

    #[test]
    fn columns_that_nobody_asks_for_are_not_read() {
        let request = Request {
            wanted: crate::formats::Wanted::Named(vec!["chain".into()]),
            ..Request::default()
        };
        let spans = frames(ATOM.as_bytes()).expect("legal");
        let table =
            table(ATOM.as_bytes(), &spans[0], &request, &mut Notes::default()).expect("legal");
        let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["element", "name", "residue", "chain"]);
        assert!(matches!(table.columns[0].values, Values::Words(_)));
    }

    fn good() -> String {
        let other = ATOM.replace("  1  CA B", "  2  CB  ").replace("C2-", "C  ");
        let water =
            "HETATM    3  O   HOH A 201      20.000   5.000   0.000  1.00  0.00           O";
        format!(
            "CRYST1   30.000   40.000   50.000  90.00  90.00  90.00 P 1\nMODEL 1\n{ATOM}\n{other}\nTER\n{water}\nENDMDL\nMODEL 2\n{ATOM}\nENDMDL\nEND\n"
        )
    }

    fn try_all(bytes: &[u8]) {
        let request = Request { model: Some(2), ..Request::default() };
        let _ = (READER.recognizes)(bytes);
        for span in frames(bytes).unwrap_or_default() {
            let _ = table(bytes, &span, &Request::default(), &mut Notes::default());
            let _ = table(bytes, &span, &request, &mut Notes::default());
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            try_all(&bytes);
            try_all(&[ATOM.as_bytes(), &bytes].concat());
            try_all(&[&b"ATOM  "[..], &bytes].concat());
        }

        #[test]
        fn no_change_of_a_good_file_panics(bytes in changed(good().into_bytes())) {
            try_all(&bytes);
        }

        /// Coordinates of eight columns are read exactly, wherever a line is moved to.
        #[test]
        fn coordinates_are_exact(thousandths in prop::array::uniform3(-999_999_i32..=9_999_999), by in 0..4_usize) {
            let [x, y, z] = thousandths.map(|number| f64::from(number) / 1000.0);
            let line = format!(
                "ATOM  {serial:>width$}  CA  ALA A   1    {x:8.3}{y:8.3}{z:8.3}  1.00  0.00           C",
                serial = 1, width = 5 + by,
            );
            match read_all(&line) {
                Ok((table, _)) => prop_assert_eq!(table.positions[0], glam::DVec3::new(x, y, z)),
                // Where nothing is blank between moved coordinates, they may be others.
                Err(_) => prop_assert!(by > 0),
            }
        }
    }
}
