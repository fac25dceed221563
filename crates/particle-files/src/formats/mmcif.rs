//! mmCIF, and the older CIF of crystals: keys and loops, of which only the atoms and the cell are read.
//!
//! Enough are coordinates and an element or a name. Chains, residues and their numbers are the authors'
//! (`auth_`) where the file has those.

mod rows;
mod sites;
mod tokens;

use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;

use super::atoms::{Atom, Atoms, B_FACTOR, CHARGE, OCCUPANCY, RESIDUE_NUMBER, Wants};
use super::models::{Model, asked_for};
use super::{Reader, Request, Span};
use crate::cell::Cell;
use crate::error::Flaw;
use crate::notes::Notes;
use crate::table::Table;
use crate::text::word;
use sites::{CARTESIAN, FRACTIONAL, Sites, Values, sites, value_number};
use tokens::{Token, Tokens};

pub(super) const READER: Reader = Reader {
    name: "mmCIF",
    endings: &["cif", "mmcif"],
    is_text: true,
    recognizes: is_mmcif,
    frames,
    table,
};

/// Whether the first words begin a block, a loop or a key.
pub(super) fn is_mmcif(bytes: &[u8]) -> bool {
    let mut tokens = Tokens::from(bytes, 0, 1);
    let Some(first) = tokens.next() else { return false };
    let begins = match first.begins(b"data_") {
        true => tokens.next(),
        false => Some(first),
    };
    !first.text.contains(&b',')
        && begins.is_none_or(|word| {
            word.is_key() && word.text.len() > 1 || word.begins(b"loop_") || word.begins(b"save_")
        })
}

/// A span for each model of each block.
fn frames(bytes: &[u8]) -> Result<Vec<Span>, Flaw> {
    Ok(models(bytes)?.into_iter().map(|model| model.span).collect())
}

fn models(bytes: &[u8]) -> Result<Vec<Model>, Flaw> {
    let mut models = Vec::new();
    for sites in sites(bytes) {
        models.extend(rows::models(bytes, &sites)?);
    }
    match models.is_empty() {
        false => Ok(models),
        true => Err(Flaw::needed(
            "atoms: _atom_site with Cartn_x, Cartn_y and Cartn_z, or with fract_x, fract_y and fract_z",
            "none",
        )
        .or("save the structure itself as mmCIF, PDB or XYZ")),
    }
}

fn table(bytes: &[u8], span: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let span = asked_for(|| models(bytes), span, request, notes)?;
    let all = sites(bytes);
    let is_of = |sites: &&Sites<'_>| sites.span.bytes.contains(&span.bytes.start);
    let Some(sites) = all.iter().find(is_of) else { return Ok(Table::default()) };
    let wants = Wants::of(request, &[RESIDUE_NUMBER, CHARGE, OCCUPANCY, B_FACTOR]);
    let columns = Columns::of(sites, wants)?;
    let atoms = match &sites.values {
        Values::One(values) => {
            let mut atoms = Atoms::new(wants);
            columns.push(values, &mut atoms)?;
            atoms
        }
        Values::Loop => of_rows(bytes, &span, &columns.of_model_at(bytes, &span), wants)?,
    };
    if columns.cell.is_some() {
        notes.read(
            "fractional coordinates through the cell: the atoms that the file lists, without those that \
             symmetry adds",
        );
    }
    Ok(Table { cell: sites.cell, ..atoms.table(notes) })
}

/// The atoms of rows: by all threads where each is a line, else one after the other.
fn of_rows(bytes: &[u8], span: &Span, columns: &Columns<'_>, wants: Wants) -> Result<Atoms, Flaw> {
    let all_are_lines = AtomicBool::new(true);
    let frame = &bytes[span.bytes.clone()];
    let atoms = Atoms::of_lines(frame, span.line, wants, |bytes, first, atoms| {
        let are_lines =
            rows::for_each_line(bytes, first, columns.width, |row| columns.push(row, atoms))?;
        all_are_lines.fetch_and(are_lines, Ordering::Relaxed);
        Ok(())
    });
    if let (Ok(atoms), true) = (atoms, all_are_lines.into_inner()) {
        return Ok(atoms);
    }
    let mut atoms = Atoms::new(wants);
    let read = rows::for_each(bytes, span, columns.width, |row| columns.push(row, &mut atoms));
    match read {
        Ok(()) => Ok(atoms),
        // A value too few in a line before moves all that follow.
        Err(flaw) => Err(rows::broken_line(bytes, span, columns.width).unwrap_or(flaw)),
    }
}

/// Where in a row what is read stands.
#[derive(Debug, Clone)]
struct Columns<'a> {
    width: usize,
    wants: Wants,
    position: [usize; 3],
    /// The cell that coordinates are fractions of.
    cell: Option<Cell>,
    element: Option<usize>,
    name: [Option<usize>; 2],
    residue: [Option<usize>; 2],
    chain: [Option<usize>; 2],
    residue_number: [Option<usize>; 2],
    insertion: Option<usize>,
    alternative: [Option<usize>; 2],
    charge: Option<usize>,
    occupancy: Option<usize>,
    b_factor: Option<usize>,
    model: Option<usize>,
    /// The model whose rows are read; all where this is `None`.
    of_model: Option<&'a [u8]>,
}

impl<'a> Columns<'a> {
    fn of(sites: &Sites<'_>, wants: Wants) -> Result<Self, Flaw> {
        let column = |name: &str| sites.column(name);
        let first = |first: &str, second: &str| [column(first), column(second)];
        let three = |[x, y, z]: [&str; 3]| Some([column(x)?, column(y)?, column(z)?]);
        let (position, cell) = match (three(CARTESIAN), three(FRACTIONAL), sites.cell) {
            (Some(position), ..) => (position, None),
            (None, Some(position), Some(cell)) => (position, Some(cell)),
            _ => {
                let needed = "the lengths and angles of _cell, of which fract_x, fract_y and fract_z are parts";
                let flaw = Flaw::needed(needed, "none").at_line(sites.span.line);
                return Err(
                    flaw.or("save the file with Cartesian coordinates, as XYZ for instance")
                );
            }
        };
        Ok(Self {
            width: sites.names.len(),
            wants,
            position,
            cell,
            element: column("type_symbol"),
            name: match column("label") {
                Some(label) => [Some(label), None],
                None => first("auth_atom_id", "label_atom_id"),
            },
            residue: first("auth_comp_id", "label_comp_id"),
            chain: first("auth_asym_id", "label_asym_id"),
            residue_number: match column("disorder_assembly") {
                Some(assembly) => [Some(assembly), None],
                None => first("auth_seq_id", "label_seq_id"),
            },
            insertion: column("pdbx_pdb_ins_code"),
            alternative: first("label_alt_id", "disorder_group"),
            charge: column("pdbx_formal_charge"),
            occupancy: column("occupancy"),
            b_factor: column("b_iso_or_equiv").or_else(|| column("u_iso_or_equiv")),
            model: column("pdbx_pdb_model_num"),
            of_model: None,
        })
    }

    /// The same for the rows of one model only: that of the row that begins the span.
    fn of_model_at<'b>(&self, bytes: &'b [u8], span: &Span) -> Columns<'b> {
        let mut row = Tokens::from(bytes, span.bytes.start, span.line);
        let of_model = self.model.and_then(|column| row.nth(column)).map(|model| model.text);
        Columns { of_model, ..self.clone() }
    }

    /// Adds the atom of a row, unless it is another model's.
    fn push(&self, row: &[Token<'_>], atoms: &mut Atoms) -> Result<(), Flaw> {
        let value =
            |column: Option<usize>| column.map_or(&b""[..], |column| value(row[column].text));
        let either = |[first, second]: [Option<usize>; 2]| match value(first) {
            b"" => value(second),
            found => found,
        };
        if self.of_model.is_some_and(|model| self.model.is_some_and(|own| row[own].text != model)) {
            return Ok(());
        }
        let name = either(self.name);
        if self.position.iter().any(|column| value(Some(*column)).is_empty()) {
            atoms.has_no_place(name);
            return Ok(());
        }
        let number = |column: Option<usize>| value_number(value(column)).unwrap_or(f64::NAN);
        let (element, residue) = (value(self.element), either(self.residue));
        let residue_number = either(self.residue_number);
        let mut atom = Atom {
            position: self.position(row)?,
            element: if element.is_empty() && residue.is_empty() { symbol(name) } else { element },
            name,
            residue,
            chain: either(self.chain),
            residue_number,
            insertion: value(self.insertion),
            alternative: either(self.alternative),
            ..Atom::default()
        };
        let wants = |index: usize| self.wants.numbers[index];
        atom.numbers[OCCUPANCY] = number(self.occupancy);
        if wants(RESIDUE_NUMBER) {
            atom.numbers[RESIDUE_NUMBER] = value_number(residue_number).unwrap_or(f64::NAN);
        }
        for (index, column) in [(CHARGE, self.charge), (B_FACTOR, self.b_factor)] {
            if wants(index) {
                atom.numbers[index] = number(column);
            }
        }
        atoms.push(&atom, row[0].line);
        Ok(())
    }

    fn position(&self, row: &[Token<'_>]) -> Result<DVec3, Flaw> {
        let mut position = DVec3::ZERO;
        for (axis, column) in self.position.into_iter().enumerate() {
            let Token { text, line, .. } = row[column];
            let number = value_number(text).filter(|number| number.is_finite());
            position[axis] = number.ok_or_else(|| {
                let found = format!("{:?}", word(text));
                let key = if self.cell.is_some() { FRACTIONAL[axis] } else { CARTESIAN[axis] };
                Flaw::needed("a finite number", found)
                    .at_line(line)
                    .at_key(&key.replace("cartn", "Cartn"))
            })?;
        }
        Ok(match self.cell {
            Some(Cell { edges: [a, b, c], .. }) => position.x * a + position.y * b + position.z * c,
            None => position,
        })
    }
}

/// Nothing for the words that say that there is no value.
fn value(text: &[u8]) -> &[u8] {
    if matches!(text, b"." | b"?") { b"" } else { text }
}

/// The element of a label of a crystal, where small letters say how long its symbol is.
fn symbol(label: &[u8]) -> &[u8] {
    match label {
        [b'A'..=b'Z', b'a'..=b'z', ..] => &label[..2],
        _ => b"",
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::formats::testing::{changed, words};

    fn read_all(text: &str) -> Result<Vec<(Table, Vec<String>)>, Flaw> {
        let read = |span: Span| {
            let mut notes = Notes::default();
            let table = table(text.as_bytes(), &span, &Request::default(), &mut notes)?;
            Ok((table, notes.iter().map(|note| note.text.clone()).collect()))
        };
        frames(text.as_bytes())?.into_iter().map(read).collect()
    }

    fn read(text: &str) -> Table {
        read_all(text).expect("legal").remove(0).0
    }

    fn refusal(text: &str) -> String {
        read_all(text).expect_err("refused").in_file("a.cif").to_string()
    }

    fn looped(names: &str, rows: &str) -> String {
        let keys: Vec<String> =
            names.split(' ').map(|name| format!("_atom_site.{name}\n")).collect();
        format!("data_x\nloop_\n{}{rows}\n#\n", keys.concat())
    }

    const FEW: &str = "type_symbol Cartn_x Cartn_y Cartn_z";

    #[test]
    fn columns_are_found_by_name() {
        let names = "group_PDB id type_symbol label_atom_id label_alt_id label_comp_id label_asym_id \
                     label_seq_id pdbx_PDB_ins_code Cartn_x Cartn_y Cartn_z occupancy B_iso_or_equiv \
                     pdbx_formal_charge auth_seq_id auth_asym_id";
        let names = names.split_whitespace().collect::<Vec<_>>().join(" ");
        let table = read(&looped(
            &names,
            "HETATM 1 CA \"C'A\" . LIG B . ? 1.5 -2.5(3) 1e-3 0.50 12.5 2 -7 AA",
        ));
        assert_eq!(table.positions, [DVec3::new(1.5, -2.5, 0.001)]);
        for (name, value) in [
            ("element", "Ca"),
            ("name", "C'A"),
            ("residue", "LIG"),
            ("residue_number", "-7"),
            ("chain", "AA"),
            ("charge", "2"),
            ("occupancy", "0.5"),
            ("b_factor", "12.5"),
        ] {
            assert_eq!(words(&table, name), [value], "{name}");
        }
        assert_eq!((table.atoms, table.lines.get(0)), (true, Some(20)));
    }

    #[test]
    fn few_columns_are_enough() {
        let table = read(&looped(FEW, "C 1 2 3\nD 4 5 6"));
        assert_eq!(words(&table, "element"), ["C", "H"]);
        let table = read(&looped(
            "Cartn_x Cartn_y Cartn_z label_atom_id label_comp_id",
            "1 2 3 CA CA\n4 5 6 CA ALA",
        ));
        assert_eq!(words(&table, "element"), ["Ca", "C"]);
        let table = read(
            "_atom_site.Cartn_x 1 _atom_site.CARTN_Y 2\n_atom_site.cartn_z 3\n_atom_site.auth_atom_id O1",
        );
        assert_eq!((words(&table, "element"), table.positions[0].z), (vec!["O".into()], 3.0));
        assert_eq!(words(&table, "name"), ["O1"]);
    }

    #[test]
    fn rows_need_not_be_lines() {
        let lines = read(&looped(FEW, "C 1 2 3\nO 4 5 6"));
        for rows in [
            "C 1\n2 3 O 4\n5 6",
            "C 1 2 3 O 4 5 6",
            "C 1 2 3\n\n# comment\nO 4 5 6 # comment",
            "C\n;1\n; 2 3\nO\t4 '5' \"6\"\n\n",
        ] {
            assert_eq!(read(&looped(FEW, rows)).positions, lines.positions, "{rows}");
        }
    }

    #[test]
    fn models_and_blocks_are_frames() {
        let names = format!("{FEW} pdbx_PDB_model_num");
        for rows in [
            "C 1 0 0 2\nC 2 0 0 2\nC 3 0 0 4",
            "C 1 0 0 2\nC 3 0 0 4\nC 2 0 0 2",
            "C 1 0 0 2 C 3 0 0\n4 C 2 0 0 2",
        ] {
            let text = looped(&names, rows) + &looped(FEW, "O 7 0 0");
            let found: Vec<Vec<f64>> = read_all(&text)
                .expect("legal")
                .into_iter()
                .map(|(table, _)| table.positions.iter().map(|position| position.x).collect())
                .collect();
            assert_eq!(found, [vec![1.0, 2.0], vec![3.0], vec![7.0]], "{rows}");
            let request = Request { model: Some(4), ..Request::default() };
            let span = Span::whole(text.as_bytes());
            let asked = table(text.as_bytes(), &span, &request, &mut Notes::default());
            assert_eq!(asked.expect("there").positions, [DVec3::new(3.0, 0.0, 0.0)]);
        }
    }

    #[test]
    fn fractions_go_through_the_cell() {
        let text = "data_cod\n_cell_length_a 2.0(1)\n_cell_length_b 4\n_cell_length_c 8\n_cell_angle_gamma 90\n\
                    loop_\n_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n\
                    _atom_site_disorder_group\n_atom_site_occupancy\n\
                    Ca1 0.5 -0.25(2) 0.125 . 1\nC1A 0 0 0 1 0.4\nCL2 0 0 1 2 0.6\nH1 ? ? ? . 1\n";
        let (table, notes) = read_all(text).expect("legal").remove(0);
        assert_eq!(table.positions, [DVec3::new(1.0, -1.0, 1.0), DVec3::new(0.0, 0.0, 8.0)]);
        assert_eq!(words(&table, "element"), ["Ca", "Cl"]);
        assert!(table.cell.is_some());
        assert!(notes[0].contains("fractional"), "{notes:?}");
        assert_eq!(notes[1], "1 atom without coordinates (H1)");
        assert!(notes[2].starts_with("1 atom at alternative places"), "{notes:?}");
        let without = text.replace("_cell_length_a 2.0(1)", "_cell_length_a ?");
        assert!(refusal(&without).contains("needed the lengths and angles of _cell"));
    }

    #[test]
    fn waters_without_numbers_have_places_of_their_own() {
        let names =
            format!("{FEW} label_atom_id label_comp_id label_alt_id label_seq_id occupancy");
        let rows = "O 0 0 0 O HOH A . 0.6\nO 1 0 0 O HOH B . 0.4\nO 5 0 0 O HOH . . 1\n\
                    O 8 0 0 O HOH A . 0.3\nO 9 0 0 O HOH B . 0.7";
        let table = read(&looped(&names, rows));
        let x: Vec<f64> = table.positions.iter().map(|position| position.x).collect();
        assert_eq!(x, [0.0, 5.0, 9.0]);
    }

    #[test]
    fn refusals_name_line_and_key() {
        assert_eq!(
            refusal(&looped(FEW, "C 1 2 3\nC 1 b 3")),
            "a.cif, line 8, Cartn_y: needed a finite number, found \"b\""
        );
        let short = refusal(&looped(FEW, "C 1 2 3\nC 1 2"));
        assert_eq!(
            short,
            "a.cif, line 8: needed 4 values for each atom, one for each key, found 3"
        );
        for none in
            ["data_x\n", "data_x\n_cell.length_a 1\n", &looped(FEW, ""), "data_x loop_ _refln.h 1"]
        {
            assert!(refusal(none).contains("needed atoms: _atom_site with Cartn_x"), "{none}");
        }
    }

    #[test]
    fn it_is_recognized_by_its_first_words() {
        for text in [
            "data_x\n",
            "# c\n\nDATA_1ABC\n#\n_a.b c",
            "loop_\n_a.b\n1",
            "_atom_site.Cartn_x 1",
            "data_x save_a",
        ] {
            assert!(is_mmcif(text.as_bytes()), "{text}");
        }
        for text in
            ["", "data_x,data_y\n1,2", "data_x data_y data_z\n1 2 3", "ATOM", "_", "x data_"]
        {
            assert!(!is_mmcif(text.as_bytes()), "{text}");
        }
    }

    fn with_models_and_alternatives() -> Vec<u8> {
        let names = format!("{FEW} pdbx_PDB_model_num label_alt_id");
        let cell = "_cell.length_a 10 _cell.length_b 10 _cell.length_c 10\n";
        (looped(&names, "C 1 2 3 1 A\n'O' 1 2 3 1 B\nC 1 2 3 2 .") + cell).into_bytes()
    }

    fn try_all(bytes: &[u8]) {
        let _ = is_mmcif(bytes);
        for span in frames(bytes).unwrap_or_default() {
            let _ = table(bytes, &span, &Request::default(), &mut Notes::default());
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            try_all(&bytes);
            try_all(&[looped(FEW, "C 1 2 3").as_bytes(), &bytes].concat());
        }

        #[test]
        fn no_text_panics(text in "(data_|loop_|_atom_site\\.(cartn_[xyz]|id)|_cell.length_[abc]|[;'\"#.?]|[0-9]|[ \n]){0,40}") {
            try_all(text.as_bytes());
        }

        #[test]
        fn no_change_of_a_good_file_panics(bytes in changed(with_models_and_alternatives())) {
            try_all(&bytes);
        }
    }
}
