//! Dumps of LAMMPS as text: frames of items, each below a line `ITEM: …`.
//!
//! Columns have the names that `ITEM: ATOMS` gives them. Positions are those of the first three of
//! `x y z`, `xs ys zs` (in parts of the cell), `xu yu zu` (not wrapped into it) and `xsu ysu zsu` (both)
//! that are there.

use glam::DVec3;
use memchr::memmem;

use super::{Reader, Request, Span};
use crate::cell::Cell;
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::number::{DecimalMark, number};
use crate::roles::Role;
use crate::rows::{Becomes, Field, Rows, Separator, Width};
use crate::table::Table;
use crate::text::{fields, first_line, lines, word};
use crate::units::Unit;

pub(super) const READER: Reader = Reader {
    name: "LAMMPS dump",
    endings: &["lammpstrj", "dump", "lammpsdump"],
    is_text: true,
    recognizes: |bytes| bytes.starts_with(ITEM),
    frames,
    table,
};

const ITEM: &[u8] = b"ITEM:";

/// What positions are called, and whether they are in parts of the cell.
const COORDINATES: [([&str; 3], bool); 4] = [
    (["x", "y", "z"], false),
    (["xs", "ys", "zs"], true),
    (["xu", "yu", "zu"], false),
    (["xsu", "ysu", "zsu"], true),
];

/// The columns of versions that do not name them.
const UNNAMED: [&str; 5] = ["id", "type", "xs", "ys", "zs"];

/// A frame begins with the first item after the atoms of the one before.
fn frames(bytes: &[u8]) -> Result<Vec<Span>, Flaw> {
    let mut starts = Vec::new();
    let mut has_atoms = true;
    for at in memmem::find_iter(bytes, ITEM) {
        if at > 0 && bytes[at - 1] != b'\n' {
            continue;
        }
        if has_atoms {
            starts.push(at);
        }
        has_atoms = item(first_line(&bytes[at..]).0).starts_with(b"ATOMS");
    }
    let ends = starts.iter().skip(1).copied().chain([bytes.len()]);
    let (mut line, mut before) = (1, 0);
    let spans = starts.iter().zip(ends).map(|(start, end)| {
        line += memchr::memchr_iter(b'\n', &bytes[before..*start]).count();
        before = *start;
        Span { bytes: *start..end, line }
    });
    Ok(spans.collect())
}

/// What follows `ITEM:`.
fn item(line: &[u8]) -> &[u8] {
    line.strip_prefix(ITEM).unwrap_or_default().trim_ascii()
}

fn table(bytes: &[u8], span: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let mut header = Header::default();
    let mut rest = &bytes[span.bytes.clone()];
    let mut line = span.line;
    loop {
        let (title, behind) = first_line(rest);
        let title = item(title);
        (rest, line) = (behind, line + 1);
        if let Some(names) = title.strip_prefix(b"ATOMS") {
            let names = fields(names).map(|name| word(name).into_owned()).collect();
            return atoms(&header, names, rest, line, request, notes);
        }
        let end = memmem::find(rest, ITEM).unwrap_or(rest.len());
        if end == rest.len() {
            let found = format!("ITEM: {:?} as the last", word(title));
            return Err(Flaw::needed("ITEM: ATOMS in every frame", found).at_line(line - 1));
        }
        header.add(title, &rest[..end], line)?;
        line += memchr::memchr_iter(b'\n', &rest[..end]).count();
        rest = &rest[end..];
    }
}

/// What a frame says before its atoms.
#[derive(Default)]
struct Header {
    timestep: Option<String>,
    units: Option<String>,
    /// The number of atoms, and the line that says it.
    count: Option<(usize, usize)>,
    cell: Option<Cell>,
}

impl Header {
    /// Takes in an item, whose content begins on this line.
    fn add(&mut self, title: &[u8], content: &[u8], line: usize) -> Result<(), Flaw> {
        let value = word(first_line(content).0.trim_ascii()).into_owned();
        match title {
            b"TIMESTEP" => self.timestep = Some(value),
            b"UNITS" => self.units = Some(value),
            b"NUMBER OF ATOMS" => {
                let count = value.parse().map_err(|_| {
                    Flaw::needed("the number of atoms", format_args!("{value:?}")).at_line(line)
                })?;
                self.count = Some((count, line));
            }
            _ => {
                if let Some(names) = title.strip_prefix(b"BOX BOUNDS") {
                    self.cell = cell(names, content, line)?;
                }
            }
        }
        Ok(())
    }

    fn unit(&self) -> Option<Unit> {
        match self.units.as_deref()? {
            "real" | "metal" => Some(Unit::Angstrom),
            "nano" => Some(Unit::Nanometre),
            "si" => Some(Unit::Metre),
            _ => None,
        }
    }
}

/// The cell of `ITEM: BOX BOUNDS`: of lower and upper bounds, of those of the box around a tilted cell and
/// three tilts, or of its edges and its origin.
fn cell(names: &[u8], content: &[u8], first_line: usize) -> Result<Option<Cell>, Flaw> {
    let names: Vec<&[u8]> = fields(names).collect();
    let is = |first: &[u8]| names.first() == Some(&first);
    let width = if is(b"abc") {
        4
    } else if is(b"xy") {
        3
    } else {
        2
    };
    let mut rows = [[0.0; 4]; 3];
    let mut content = lines(content, first_line);
    for row in &mut rows {
        let (line, text) = content.next().unwrap_or((first_line, b""));
        let numbers: Vec<f64> =
            fields(text).map_while(|field| number(field, DecimalMark::Point)).collect();
        if numbers.len() < width {
            let needed = format!("{width} numbers for each of the box's three bounds");
            return Err(Flaw::needed(&needed, format_args!("{:?}", word(text))).at_line(line));
        }
        row[..width].copy_from_slice(&numbers[..width]);
    }
    let cell = match width {
        4 => {
            let edges = rows.map(|[x, y, z, _]| DVec3::new(x, y, z));
            Cell::new(edges)
                .map(|cell| Cell { origin: DVec3::from_array(rows.map(|r| r[3])), ..cell })
        }
        _ => {
            let [[x0, x1, xy, _], [y0, y1, xz, _], [z0, z1, yz, _]] = rows;
            let left = [0.0, xy, xz, xy + xz].into_iter().fold(0.0, f64::min);
            let right = [0.0, xy, xz, xy + xz].into_iter().fold(0.0, f64::max);
            let low = DVec3::new(x0 - left, y0 - yz.min(0.0), z0);
            let high = DVec3::new(x1 - right, y1 - yz.max(0.0), z1);
            tilted(low, high, [xy, xz, yz])
        }
    };
    // Boundaries are written from 2011 on: before that the default of LAMMPS is the best guess.
    let is_boundary = |name: &&&[u8]| name.len() == 2 && name.iter().all(|b| b"pfsm".contains(b));
    let boundaries: Vec<bool> =
        names.iter().filter(is_boundary).map(|name| *name == b"pp").collect();
    let periodic = boundaries.try_into().unwrap_or([true; 3]);
    Ok(cell.map(|cell| Cell { periodic, ..cell }))
}

/// The cell between two corners, whose edges b and c are tilted by these lengths.
pub(super) fn tilted(low: DVec3, high: DVec3, [xy, xz, yz]: [f64; 3]) -> Option<Cell> {
    let size = high - low;
    let edges =
        [DVec3::new(size.x, 0.0, 0.0), DVec3::new(xy, size.y, 0.0), DVec3::new(xz, yz, size.z)];
    Cell::new(edges).map(|cell| Cell { origin: low, ..cell })
}

fn atoms(
    header: &Header,
    mut names: Vec<String>,
    rows: &[u8],
    line: usize,
    request: &Request,
    notes: &mut Notes,
) -> Result<Table, Flaw> {
    if names.is_empty() {
        names = UNNAMED.map(str::to_owned).to_vec();
        notes.guessed("ITEM: ATOMS names no columns: taken as id type xs ys zs");
    }
    check_count(header, rows, line)?;
    let at = |name: &str| names.iter().position(|other| other == name);
    let found = COORDINATES.iter().find_map(|(axes, are_scaled)| {
        let [Some(x), Some(y), Some(z)] = axes.map(at) else { return None };
        Some(([x, y, z], *are_scaled))
    });
    let Some((axes, are_scaled)) = found else {
        let found = format_args!("{:?}", names.join(" "));
        let needed = "x y z, xs ys zs, xu yu zu or xsu ysu zsu among the columns";
        return Err(Flaw::needed(needed, found).at_line(line - 1));
    };
    let sample: Vec<&[u8]> = fields(first_line(rows).0).collect();
    let field = |(index, name): (usize, &String)| {
        let becomes = match axes.iter().position(|axis| *axis == index) {
            Some(axis) => Becomes::Coordinate(axis),
            None => becomes(name, sample.get(index).copied().unwrap_or_default(), request),
        };
        Field { name: name.clone(), becomes }
    };
    let rows_of = Rows {
        separator: Separator::Blanks,
        mark: DecimalMark::Point,
        fields: names.iter().enumerate().map(field).collect(),
        width: Width::Exactly,
        skips: Some(b""),
    };
    let mut table = rows_of.read(rows, line)?;
    if are_scaled {
        let Some(Cell { origin, edges: [a, b, c], .. }) = header.cell else {
            let flaw = Flaw::needed("a box for positions in parts of it", "none of a volume");
            return Err(flaw.at_line(line - 1));
        };
        let place = |part: &DVec3| origin + part.x * a + part.y * b + part.z * c;
        table.positions.iter_mut().for_each(|position| *position = place(position));
    }
    if let Some(timestep) = &header.timestep {
        notes.read(format!("timestep {timestep}"));
    }
    if let Some(units) = &header.units {
        notes.read(format!("units {units}"));
    }
    let coordinates = axes.map(|axis| names[axis].as_str()).join(" ");
    notes.read(format!("positions from {coordinates}"));
    table.cell = header.cell;
    table.unit = header.unit();
    Ok(table)
}

/// Refuses a number of rows that is not the number of atoms.
fn check_count(header: &Header, rows: &[u8], line: usize) -> Result<(), Flaw> {
    let Some((count, counted_at)) = header.count else {
        return Err(Flaw::needed("ITEM: NUMBER OF ATOMS before ITEM: ATOMS", "none").at_line(line));
    };
    let rows = rows.trim_ascii_end();
    let found = if rows.is_empty() { 0 } else { memchr::memchr_iter(b'\n', rows).count() + 1 };
    if found != count {
        let needed = format!("{} as line {counted_at} says", counted(count, "atom"));
        return Err(Flaw::needed(&needed, found).at_line(line + found.min(count)));
    }
    Ok(())
}

/// What becomes of a column that is no coordinate.
fn becomes(name: &str, sample: &[u8], request: &Request) -> Becomes {
    if !request.wanted.wants(name) {
        return Becomes::Nothing;
    }
    match Role::of(name) {
        Some(role) if role.is_word() => Becomes::Word,
        None if number(sample, DecimalMark::Point).is_none() && !sample.is_empty() => Becomes::Word,
        _ => Becomes::Number,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::table::{Lines, Values};

    const TWO_FRAMES: &str = "ITEM: UNITS\nmetal\nITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\n\
        ITEM: BOX BOUNDS pp ff pp\n-1 3\n0 2\n0 2.0e+00\nITEM: ATOMS id type element zs xs ys radius\n\
        2 1 O 0.5 0.25 0 1.5\n1 2 H 0 1 1 0.5 \nITEM: TIMESTEP\n200\nITEM: NUMBER OF ATOMS\n1\n\
        ITEM: BOX BOUNDS xy xz yz pp pp pp\n-1 7 1\n0 5 -1\n0 2 2\nITEM: ATOMS id type xsu ysu zsu\n\
        1 1 0 1 1.5\n";

    fn read(text: &str, frame: usize) -> Result<Table, Flaw> {
        let spans = frames(text.as_bytes())?;
        table(text.as_bytes(), &spans[frame], &Request::default(), &mut Notes::default())
    }

    fn refusal(text: &str) -> String {
        read(text, 0).expect_err("refused").in_file("a.dump").to_string()
    }

    #[test]
    fn columns_come_in_any_order_and_positions_in_parts_of_the_cell() {
        let read = read(TWO_FRAMES, 0).expect("legal");
        assert_eq!(read.positions, [DVec3::new(0.0, 0.0, 1.0), DVec3::new(3.0, 2.0, 0.0)]);
        assert_eq!(read.lines, Lines::From(12));
        assert_eq!(read.unit, Some(Unit::Angstrom));
        let elements = Values::Words(["O", "H"].into_iter().collect());
        assert_eq!(read.column("element").map(|column| &column.values), Some(&elements));
        let radii = Values::Numbers(vec![1.5, 0.5]);
        assert_eq!(read.column("radius").map(|column| &column.values), Some(&radii));
        let cell = read.cell.expect("a box");
        assert_eq!((cell.origin.x, cell.periodic), (-1.0, [true, false, true]));
    }

    #[test]
    fn tilted_cells_are_those_within_their_bounds() {
        // xy 1, xz -1, yz 2: the box around it reaches from -1 to 1 beyond x, and to 2 beyond y.
        let read = read(TWO_FRAMES, 1).expect("legal");
        let cell = read.cell.expect("a box");
        assert_eq!(cell.origin, DVec3::ZERO);
        let (a, b, c) =
            (DVec3::new(6.0, 0.0, 0.0), DVec3::new(1.0, 3.0, 0.0), DVec3::new(-1.0, 2.0, 2.0));
        assert_eq!(cell.edges, [a, b, c]);
        assert_eq!(read.positions, [b + 1.5 * c]);
    }

    #[test]
    fn general_cells_have_edges_and_an_origin() {
        let text = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS abc origin pp pp fs\n\
                    1 2 0 7\n0 3 0 8\n0 1 4 9\nITEM: ATOMS xs ys zs\n1 1 1\n";
        let read = read(text, 0).expect("legal");
        assert_eq!(read.positions, [DVec3::new(8.0, 14.0, 13.0)]);
        assert_eq!(read.cell.expect("a box").periodic, [true, true, false]);
    }

    #[test]
    fn wrapped_positions_come_before_others() {
        let text =
            "ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS xu yu zu x y z c_a[1] s\n1 2 3 4 5 6 7 up\n";
        let read = read(text, 0).expect("legal");
        assert_eq!(read.positions, [DVec3::new(4.0, 5.0, 6.0)]);
        let column = |name| read.column(name).map(|column| column.values.text(0).into_owned());
        assert_eq!(column("xu").as_deref(), Some("1"));
        assert_eq!((column("c_a[1]").as_deref(), column("s").as_deref()), (Some("7"), Some("up")));
    }

    #[test]
    fn refusals_say_both_numbers_and_the_line() {
        let atoms = |count: &str, rows: &str| {
            refusal(&format!("ITEM: NUMBER OF ATOMS\n{count}\nITEM: ATOMS x y z\n{rows}"))
        };
        assert_eq!(atoms("3", "0 0 0\n"), "a.dump, line 5: needed 3 atoms as line 2 says, found 1");
        assert_eq!(
            atoms("1", "0 0 0\n0 0 0\n"),
            "a.dump, line 5: needed 1 atom as line 2 says, found 2"
        );
        assert_eq!(
            atoms("1", "0 b 0\n"),
            "a.dump, line 4, column 2 (y): needed a finite number, found \"b\""
        );
        assert!(atoms("many", "").starts_with("a.dump, line 2: needed the number of atoms"));
        assert!(refusal("ITEM: ATOMS x y z\n").contains("needed ITEM: NUMBER OF ATOMS"));
        assert!(refusal("ITEM: TIMESTEP\n0\n").contains("needed ITEM: ATOMS"));
        assert!(
            refusal("ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id\n1\n").contains("among the columns")
        );
        assert!(
            refusal("ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS xs ys zs\n1 1 1\n")
                .contains("needed a box")
        );
        assert!(
            refusal("ITEM: BOX BOUNDS\n0\n0 1\n0 1\nITEM: ATOMS x\n").contains("needed 2 numbers")
        );
    }

    proptest! {
        #[test]
        fn no_mutated_frame_panics(at in 0..TWO_FRAMES.len(), byte: u8, cut in 0..TWO_FRAMES.len()) {
            let mut bytes = TWO_FRAMES.as_bytes().to_vec();
            bytes[at] = byte;
            for bytes in [&bytes[..], &bytes[..cut], &bytes[cut..]] {
                let read = |span: &Span| table(bytes, span, &Request::default(), &mut Notes::default());
                let _ = frames(bytes).map(|spans| spans.iter().map(read).collect::<Vec<_>>());
            }
        }
    }
}
