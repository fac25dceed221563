//! Atoms as structures are read: their names become elements, and what is no atom of its own is left out.

use std::collections::{HashMap, HashSet};

use glam::DVec3;
use rayon::prelude::*;

use super::Request;
use super::alternatives::{self, Alternative};
use crate::atom_names::{Identity, Names};
use crate::elements::Element;
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::rows::chunks;
use crate::table::{Column, Lines, Table, Values, Words};
use crate::text::word;

/// An atom as the file says it: nothing, or NaN, where the file does not.
#[derive(Debug, Clone, Copy)]
pub(super) struct Atom<'a> {
    pub(super) position: DVec3,
    pub(super) element: &'a [u8],
    pub(super) name: &'a [u8],
    /// How many letters the element's symbol has, where the name's columns say that.
    pub(super) letters: Option<usize>,
    pub(super) residue: &'a [u8],
    pub(super) chain: &'a [u8],
    pub(super) residue_number: &'a [u8],
    /// What tells residues of one number apart.
    pub(super) insertion: &'a [u8],
    /// Which of several places it is at.
    pub(super) alternative: &'a [u8],
    pub(super) numbers: [f64; NUMBERS],
}

impl Default for Atom<'_> {
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            element: b"",
            name: b"",
            letters: None,
            residue: b"",
            chain: b"",
            residue_number: b"",
            insertion: b"",
            alternative: b"",
            numbers: [f64::NAN; NUMBERS],
        }
    }
}

/// Columns of numbers, in the order of [`Atom::numbers`].
const NUMBER_NAMES: [&str; NUMBERS] =
    ["residue_number", "charge", "occupancy", "b_factor", "radius"];
const NUMBERS: usize = 5;
pub(super) const RESIDUE_NUMBER: usize = 0;
pub(super) const CHARGE: usize = 1;
pub(super) const OCCUPANCY: usize = 2;
pub(super) const B_FACTOR: usize = 3;
pub(super) const RADIUS: usize = 4;

/// Which columns are read beside elements, names and residues.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wants {
    pub(super) chain: bool,
    /// For each of [`Atom::numbers`].
    pub(super) numbers: [bool; NUMBERS],
}

impl Wants {
    /// Those that are asked for, of the ones that the format has.
    pub(super) fn of(request: &Request, has: &[usize]) -> Self {
        let wants =
            |index: usize| has.contains(&index) && request.wanted.wants(NUMBER_NAMES[index]);
        Self { chain: request.wanted.wants("chain"), numbers: std::array::from_fn(wants) }
    }
}

/// The atoms of a part of a file.
#[derive(Debug)]
pub(super) struct Atoms {
    wants: Wants,
    positions: Vec<DVec3>,
    /// For each the atomic number, 0 for none, with [`GUESSED`] where the file does not say it.
    elements: Vec<u8>,
    names: Words,
    residues: Words,
    chains: Words,
    numbers: [Vec<f64>; NUMBERS],
    lines: Lines,
    alternatives: Vec<Alternative>,
    run: Option<Run>,
    virtual_sites: LeftOut,
    without_radius: LeftOut,
    without_place: LeftOut,
    moved: Moved,
    has_beads: bool,
    identities: HashMap<u128, Identity>,
}

/// The atoms of one residue that stand together.
#[derive(Debug)]
struct Run {
    /// Chain, number, and what tells residues of one number apart.
    residue: [Vec<u8>; 3],
    /// The index of the first atom, and of the first alternative.
    first: usize,
    alternatives: usize,
    /// Of each atom.
    occupancies: Vec<f64>,
}

impl Run {
    fn from(atom: &Atom<'_>, first: usize, alternatives: usize) -> Self {
        let residue = [atom.chain, atom.residue_number, atom.insertion].map(<[u8]>::to_vec);
        Self { residue, first, alternatives, occupancies: Vec::new() }
    }

    fn has(&self, atom: &Atom<'_>) -> bool {
        self.residue == [atom.chain, atom.residue_number, atom.insertion]
    }
}

/// How many atoms were left out, and what the first is called.
#[derive(Debug, Default)]
struct LeftOut {
    count: usize,
    name: String,
}

impl LeftOut {
    fn add(&mut self, count: usize, name: impl FnOnce() -> String) {
        if self.count == 0 && count > 0 {
            self.name = name();
        }
        self.count += count;
    }
}

/// Lines that are not in the columns of their format.
#[derive(Debug, Default)]
struct Moved {
    count: usize,
    /// The line of the first.
    first: usize,
}

impl Moved {
    fn add(&mut self, count: usize, first: usize) {
        if self.count == 0 {
            self.first = first;
        }
        self.count += count;
    }
}

/// The bit of elements that names say.
const GUESSED: u8 = 1 << 7;

/// Bytes that a thread reads before it takes more.
const CHUNK: usize = 1 << 20;

impl Atoms {
    pub(super) fn new(wants: Wants) -> Self {
        Self {
            wants,
            positions: Vec::new(),
            elements: Vec::new(),
            names: Words::default(),
            residues: Words::default(),
            chains: Words::default(),
            numbers: Default::default(),
            lines: Lines::default(),
            alternatives: Vec::new(),
            run: None,
            virtual_sites: LeftOut::default(),
            without_radius: LeftOut::default(),
            without_place: LeftOut::default(),
            moved: Moved::default(),
            has_beads: false,
            identities: HashMap::new(),
        }
    }

    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The atoms of a text whose lines are read one by one, by all threads.
    pub(super) fn of_lines(
        bytes: &[u8],
        first_line: usize,
        wants: Wants,
        read: impl Fn(&[u8], usize, &mut Self) -> Result<(), Flaw> + Sync,
    ) -> Result<Self, Flaw> {
        let chunks = chunks(bytes, first_line, CHUNK);
        let part = |(bytes, line): &(&[u8], usize)| {
            let mut atoms = Self::new(wants);
            read(bytes, *line, &mut atoms)?;
            atoms.end_run();
            Ok(atoms)
        };
        // The first flaw of the file, whichever thread found one first.
        let parts: Vec<Result<Self, Flaw>> = chunks.par_iter().map(part).collect();
        let mut all = Self::new(wants);
        all.positions.reserve_exact(parts.iter().flatten().map(|part| part.positions.len()).sum());
        for part in parts {
            all.append(part?);
        }
        Ok(all)
    }

    /// Adds an atom, unless it is none.
    pub(super) fn push(&mut self, atom: &Atom<'_>, line: usize) {
        let code = match self.identity(atom) {
            Identity::Given(element) => element.number(),
            Identity::Guessed(element) => element.number() | GUESSED,
            Identity::Unknown => 0,
            Identity::Bead => {
                self.has_beads = true;
                0
            }
            Identity::VirtualSite => {
                return self.virtual_sites.add(1, || word(atom.name).into_owned());
            }
        };
        if atom.numbers[RADIUS] == 0.0 {
            return self.without_radius.add(1, || word(atom.name).into_owned());
        }
        let index = self.positions.len();
        if !self.run.as_ref().is_some_and(|run| run.has(atom)) {
            self.end_run();
        }
        let run = self.run.get_or_insert_with(|| Run::from(atom, index, self.alternatives.len()));
        run.occupancies.push(atom.numbers[OCCUPANCY]);
        if !atom.alternative.is_empty() {
            self.alternatives.push(alternative(atom, index));
        }
        self.lines.push(index, line);
        self.positions.push(atom.position);
        self.elements.push(code);
        self.names.push(&word(atom.name));
        self.residues.push(&word(atom.residue));
        if self.wants.chain {
            self.chains.push(&word(atom.chain));
        }
        let wanted = self.wants.numbers.iter().zip(&mut self.numbers);
        for ((wanted, column), number) in wanted.zip(atom.numbers) {
            if *wanted {
                column.push(number);
            }
        }
    }

    /// Counts an atom whose coordinates the file does not know.
    pub(super) fn has_no_place(&mut self, name: &[u8]) {
        self.without_place.add(1, || word(name).into_owned());
    }

    /// Counts a line that is not in the columns of its format.
    pub(super) fn is_moved(&mut self, line: usize) {
        self.moved.add(1, line);
    }

    /// Ends the atoms of a residue. One without a label is at one of several places too, where others of
    /// its name are that have one.
    fn end_run(&mut self) {
        // Residues without a number, such as water, are not told apart.
        let run = self.run.take().filter(|run| !run.residue[1].is_empty());
        let Some(run) = run else { return };
        let labelled = &self.alternatives[run.alternatives..];
        let Some(residue) = labelled.first().map(|atom| atom.residue.clone()) else { return };
        let indices: HashSet<usize> = labelled.iter().map(|atom| atom.index).collect();
        let names: HashSet<&str> = labelled.iter().map(|atom| atom.name.as_str()).collect();
        // Several atoms of one name are of several residues with one number.
        let mut of_name: HashMap<&str, Option<usize>> = HashMap::new();
        for index in (run.first..self.positions.len()).filter(|index| !indices.contains(index)) {
            let name = self.names.get(index);
            if names.contains(name) {
                of_name.entry(name).and_modify(|only| *only = None).or_insert(Some(index));
            }
        }
        let others = of_name.into_iter().filter_map(|(name, index)| {
            let index = index?;
            Some(Alternative {
                index,
                label: String::new(),
                residue: residue.clone(),
                residue_name: self.residues.get(index).to_owned(),
                name: name.to_owned(),
                occupancy: known(run.occupancies[index - run.first]),
            })
        });
        let others: Vec<Alternative> = others.collect();
        self.alternatives.extend(others);
        self.alternatives[run.alternatives..].sort_by_key(|atom| atom.index);
    }

    /// What an atom is; most have the names of one before.
    fn identity(&mut self, atom: &Atom<'_>) -> Identity {
        match packed(atom) {
            Some(key) => *self.identities.entry(key).or_insert_with(|| identity(atom)),
            None => identity(atom),
        }
    }

    fn append(&mut self, other: Self) {
        let before = self.positions.len();
        let of_all = |mut atom: Alternative| {
            atom.index += before;
            atom
        };
        self.lines.append(before, &other.lines, other.positions.len());
        self.alternatives.extend(other.alternatives.into_iter().map(of_all));
        self.positions.extend(other.positions);
        self.elements.extend(other.elements);
        self.names.append(&other.names);
        self.residues.append(&other.residues);
        self.chains.append(&other.chains);
        self.numbers.iter_mut().zip(other.numbers).for_each(|(mine, more)| mine.extend(more));
        self.virtual_sites.add(other.virtual_sites.count, || other.virtual_sites.name);
        self.without_radius.add(other.without_radius.count, || other.without_radius.name);
        self.without_place.add(other.without_place.count, || other.without_place.name);
        self.moved.add(other.moved.count, other.moved.first);
        self.has_beads |= other.has_beads;
    }

    /// All as a table, and what of them is left out.
    pub(super) fn table(mut self, notes: &mut Notes) -> Table {
        self.end_run();
        let mut table =
            Table { positions: self.positions, lines: self.lines, atoms: true, ..Table::default() };
        let symbol = |code: &u8| match (code & GUESSED != 0, Element::of_number(code & !GUESSED)) {
            (true, Some(_)) if self.has_beads => "",
            (_, element) => element.map_or("", Element::symbol),
        };
        table.add("element", Values::Words(self.elements.iter().map(symbol).collect()));
        table.add("name", Values::Words(self.names));
        table.add("residue", Values::Words(self.residues));
        let has_chains = self.chains.different().iter().any(|chain| !chain.is_empty());
        if self.wants.chain && has_chains {
            table.add("chain", Values::Words(self.chains));
        }
        let numbers = NUMBER_NAMES.into_iter().zip(self.wants.numbers).zip(self.numbers);
        for ((name, wanted), numbers) in numbers {
            if wanted && numbers.iter().any(|number| !number.is_nan()) {
                table.columns.push(Column { name: name.into(), values: Values::Numbers(numbers) });
            }
        }
        for (LeftOut { count, name }, what, which) in [
            (self.virtual_sites, "virtual site", ""),
            (self.without_radius, "atom", " of radius 0"),
            (self.without_place, "atom", " without coordinates"),
        ] {
            if count > 0 {
                notes.left_out(format!("{}{which} ({name})", counted(count, what)));
            }
        }
        if self.moved.count > 0 {
            notes.guessed(format!(
                "{} not in the columns of the format, and read where the coordinates stand: the first is \
                 line {}",
                counted(self.moved.count, "line"),
                self.moved.first
            ));
        }
        let left_out = alternatives::left_out(&self.alternatives);
        if left_out.is_empty() {
            return table;
        }
        let atoms = counted(left_out.len(), "atom");
        notes.left_out(format!("{atoms} at alternative places, of lower occupancy than others"));
        let kept: Vec<usize> = (0..table.len()).filter(|index| !left_out.contains(index)).collect();
        table.at(&kept)
    }
}

fn identity(atom: &Atom<'_>) -> Identity {
    let names = Names {
        element: &word(atom.element),
        name: &word(atom.name),
        residue: &word(atom.residue),
        letters: atom.letters,
    };
    names.identity()
}

fn alternative(atom: &Atom<'_>, index: usize) -> Alternative {
    let text = |bytes: &[u8]| word(bytes).into_owned();
    let residue = [atom.chain, atom.residue_number, atom.insertion];
    Alternative {
        index,
        label: text(atom.alternative),
        residue: text(&residue.join(&b'\t')),
        residue_name: text(atom.residue),
        name: text(atom.name),
        occupancy: known(atom.numbers[OCCUPANCY]),
    }
}

/// An occupancy, which is 1 where the file does not say it.
fn known(occupancy: f64) -> f64 {
    if occupancy.is_nan() { 1.0 } else { occupancy }
}

/// Names in one number, where they are short.
fn packed(atom: &Atom<'_>) -> Option<u128> {
    let mut bytes = [0; 16];
    let (element, name, residue) = (atom.element, atom.name, atom.residue);
    if element.len() > 4 || name.len() > 5 || residue.len() > 6 {
        return None;
    }
    bytes[..element.len()].copy_from_slice(element);
    bytes[4..4 + name.len()].copy_from_slice(name);
    bytes[9..9 + residue.len()].copy_from_slice(residue);
    bytes[15] = atom.letters.map_or(0, |letters| letters as u8);
    Some(u128::from_le_bytes(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::testing::words;
    use crate::notes::NoteKind;

    const WANTS: Wants = Wants { chain: true, numbers: [true; NUMBERS] };

    fn table(atoms: &[(&str, &str, &str)]) -> (Table, Vec<String>) {
        let mut parts = [Atoms::new(WANTS), Atoms::new(WANTS)];
        for (index, (name, residue, alternative)) in atoms.iter().enumerate() {
            let mut numbers = [f64::NAN; NUMBERS];
            numbers[OCCUPANCY] = 1.0 / (1.0 + index as f64);
            let atom = Atom {
                name: name.as_bytes(),
                residue: residue.as_bytes(),
                residue_number: b"1",
                alternative: alternative.as_bytes(),
                position: DVec3::X * index as f64,
                numbers,
                ..Atom::default()
            };
            parts[index % 2].push(&atom, index + 1);
        }
        parts.iter_mut().for_each(Atoms::end_run);
        let [mut all, odd] = parts;
        all.append(odd);
        let mut notes = Notes::default();
        let table = all.table(&mut notes);
        let left_out = notes.iter().filter(|note| note.kind == NoteKind::LeftOut);
        (table, left_out.map(|note| note.text.clone()).collect())
    }

    #[test]
    fn what_is_no_atom_is_left_out_and_said() {
        let (table, notes) = table(&[
            ("OW", "SOL", ""),
            ("MW", "SOL", ""),
            ("HW1", "SOL", "A"),
            ("HW2", "SOL", "B"),
            ("HW1", "SOL", "B"),
        ]);
        assert_eq!(words(&table, "name"), ["OW", "HW1"]);
        assert_eq!(words(&table, "element"), ["O", "H"]);
        assert_eq!((table.lines.get(0), table.lines.get(1)), (Some(1), Some(3)));
        let alternative = "2 atoms at alternative places, of lower occupancy than others";
        assert_eq!(notes, ["1 virtual site (MW)", alternative]);
        // Columns without a number are none.
        assert!(table.column("charge").is_none() && table.column("occupancy").is_some());
    }

    #[test]
    fn a_place_without_a_label_is_one_of_several() {
        let (one, notes) = table(&[
            ("CA", "ALA", ""),
            ("", "", ""),
            ("CB", "ALA", ""),
            ("", "", ""),
            ("CB", "ALA", "B"),
        ]);
        assert_eq!(words(&one, "name"), ["CA", "CB", "", ""]);
        assert_eq!((one.lines.get(1), notes.len()), (Some(3), 1));
        let water =
            [("O", "HOH", ""), ("", "", ""), ("O", "HOH", ""), ("", "", ""), ("O", "HOH", "A")];
        assert_eq!(table(&water).0.len(), 5);
    }

    #[test]
    fn beads_have_no_elements() {
        let (table, _) = table(&[("BB", "ALA", ""), ("NA+", "ION", ""), ("C1A", "POPC", "")]);
        assert_eq!(words(&table, "element"), ["", "", ""]);
        assert_eq!(words(&table, "name"), ["BB", "C1A", "NA+"]);
    }
}
