//! Data files of LAMMPS: a comment, counts and box bounds, then sections of rows below their titles.
//!
//! What the rows of the section `Atoms` hold depends on the atom style, which a comment behind the title
//! names (`Atoms # full`). Where it does not, the first row decides between the common styles.

use glam::DVec3;

use super::lammps_dump::tilted;
use super::{Reader, Request, Span};
use crate::cell::Cell;
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::number::{DecimalMark, number};
use crate::rows::{Becomes, Field, Rows, Separator, Width};
use crate::table::Table;
use crate::text::{fields, first_line, lines, word};

pub(super) const READER: Reader = Reader {
    name: "LAMMPS data",
    endings: &["data", "lmp", "lammps"],
    is_text: true,
    recognizes,
    frames: |bytes| Ok(vec![Span::whole(bytes)]),
    table,
};

/// What rows hold, by atom style; image flags and comments may follow. In those of `hybrid`, columns of
/// its parts follow.
const STYLES: [(&str, &str); 25] = [
    ("angle", "id molecule type x y z"),
    ("atomic", "id type x y z"),
    ("body", "id type bodyflag mass x y z"),
    ("bond", "id molecule type x y z"),
    ("bpm/sphere", "id molecule type diameter density x y z"),
    ("charge", "id type charge x y z"),
    ("dipole", "id type charge x y z mux muy muz"),
    ("dpd", "id type theta x y z"),
    ("edpd", "id type edpd_temp edpd_cv x y z"),
    ("electron", "id type charge espin eradius x y z"),
    ("ellipsoid", "id type ellipsoidflag density x y z"),
    ("full", "id molecule type charge x y z"),
    ("hybrid", "id type x y z"),
    ("line", "id molecule type lineflag density x y z"),
    ("mdpd", "id type rho x y z"),
    ("molecular", "id molecule type x y z"),
    ("peri", "id type volume density x y z"),
    ("smd", "id type molecule volume mass kradius cradius x0 y0 z0 x y z"),
    ("sph", "id type rho esph cv x y z"),
    ("sphere", "id type diameter density x y z"),
    ("spin", "id type x y z spx spy spz sp"),
    ("tdpd", "id type x y z"),
    ("template", "id type molecule template_index template_atom x y z"),
    ("tri", "id molecule type triangleflag density x y z"),
    ("wavepacket", "id type charge espin eradius etag cs_re cs_im x y z"),
];

/// Lines in which the number of atoms and the box are looked for.
const HEADER: usize = 100;

/// Whether lines near the beginning, but not the first, are `N atoms` and a bound of the box or the title
/// of the atoms.
fn recognizes(bytes: &[u8]) -> bool {
    let is_of_box = |line: &[u8]| {
        fields(line).next() == Some(b"Atoms")
            || fields(line).any(|word| word == b"xlo" || word == b"avec")
    };
    let lines = lines(bytes, 1).take(HEADER).skip(1).map(|(_, line)| line);
    lines.clone().any(|line| count_of_atoms(line).is_some()) && lines.clone().any(is_of_box)
}

fn count_of_atoms(line: &[u8]) -> Option<usize> {
    let mut fields = fields(line);
    let count = std::str::from_utf8(fields.next()?).ok()?.parse().ok()?;
    (fields.next()? == b"atoms").then_some(count)
}

fn table(bytes: &[u8], _: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let header = Header::of(bytes);
    let Some((title, rows)) = &header.atoms else {
        return Err(Flaw::needed("a section Atoms", "none"));
    };
    // A blank line is between a title and its rows.
    let blank = rows.len() - rows.trim_ascii_start().len();
    let begins = memchr::memrchr(b'\n', &rows[..blank]).map_or(0, |end| end + 1);
    let first_row = title.line + 1 + memchr::memchr_iter(b'\n', &rows[..begins]).count();
    let rows = section(&rows[begins..]);
    let found = memchr::memchr_iter(b'\n', rows).count()
        + usize::from(!rows.is_empty() && !rows.ends_with(b"\n"));
    if let Some((count, line)) = header.count
        && count != found
    {
        let needed = format!("{} as line {line} says", counted(count, "atom"));
        return Err(Flaw::needed(&needed, found).at_line(first_row + found.min(count)));
    }
    let columns = style(title, first_line(rows).0, notes)?;
    let field = |name: &str| Field { name: name.to_owned(), becomes: becomes(name, request) };
    let rows_of = Rows {
        separator: Separator::Blanks,
        mark: DecimalMark::Point,
        fields: columns.split(' ').map(field).collect(),
        width: Width::AsNeeded,
        skips: None,
    };
    let mut table = rows_of.read(rows, first_row)?;
    table.cell = header.cell();
    if header.has_masses {
        notes.left_out("the masses of types: elements are not guessed from them");
    }
    Ok(table)
}

/// The title of the section of atoms.
struct Title {
    line: usize,
    /// What its comment says.
    style: Option<String>,
}

/// What stands before the rows of atoms.
#[derive(Default)]
struct Header<'a> {
    /// The number of atoms, and the line that says it.
    count: Option<(usize, usize)>,
    low: DVec3,
    high: DVec3,
    tilts: [f64; 3],
    /// The edges of a general cell, and its origin.
    edges: [DVec3; 3],
    origin: DVec3,
    has_masses: bool,
    /// The title, and what follows it.
    atoms: Option<(Title, &'a [u8])>,
}

impl<'a> Header<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let mut header = Self::default();
        let (_, mut rest) = first_line(bytes);
        let mut line = 2;
        while !rest.is_empty() {
            let (text, behind) = first_line(rest);
            if fields(text).next() == Some(b"Atoms") {
                let style = text.iter().position(|byte| *byte == b'#');
                let style = style.and_then(|at| fields(&text[at + 1..]).next());
                let style = style.map(|style| word(style).into_owned());
                header.atoms = Some((Title { line, style }, behind));
                return header;
            }
            header.add(text, line);
            (rest, line) = (behind, line + 1);
        }
        header
    }

    /// Takes in a line.
    fn add(&mut self, text: &[u8], line: usize) {
        let numbers: Vec<f64> = fields(text)
            .map_while(|field| number(field, DecimalMark::Point))
            .filter(|number| number.is_finite())
            .take(3)
            .collect();
        let words: Vec<&[u8]> = fields(text).skip(numbers.len()).take(3).collect();
        match (&numbers[..], &words[..]) {
            ([_], [b"atoms", ..]) if self.count.is_none() => {
                self.count = count_of_atoms(text).map(|count| (count, line));
            }
            ([low, high], [b"xlo", b"xhi", ..]) => (self.low.x, self.high.x) = (*low, *high),
            ([low, high], [b"ylo", b"yhi", ..]) => (self.low.y, self.high.y) = (*low, *high),
            ([low, high], [b"zlo", b"zhi", ..]) => (self.low.z, self.high.z) = (*low, *high),
            (&[xy, xz, yz], [b"xy", b"xz", b"yz"]) => self.tilts = [xy, xz, yz],
            (&[x, y, z], [b"avec", ..]) => self.edges[0] = DVec3::new(x, y, z),
            (&[x, y, z], [b"bvec", ..]) => self.edges[1] = DVec3::new(x, y, z),
            (&[x, y, z], [b"cvec", ..]) => self.edges[2] = DVec3::new(x, y, z),
            (&[x, y, z], [b"abc", b"origin", ..]) => self.origin = DVec3::new(x, y, z),
            ([], [b"Masses", ..]) => self.has_masses = true,
            _ => {}
        }
    }

    fn cell(&self) -> Option<Cell> {
        let general = Cell::new(self.edges).map(|cell| Cell { origin: self.origin, ..cell });
        general.or_else(|| tilted(self.low, self.high, self.tilts))
    }
}

/// The rows up to the first blank line.
fn section(rows: &[u8]) -> &[u8] {
    let mut rest = rows;
    while !rest.is_empty() {
        let (line, behind) = first_line(rest);
        if line.trim_ascii().is_empty() {
            break;
        }
        rest = behind;
    }
    &rows[..rows.len() - rest.len()]
}

/// The columns of the atom style that the title names, or else of the one that the first row looks like.
fn style(title: &Title, row: &[u8], notes: &mut Notes) -> Result<&'static str, Flaw> {
    let columns = |style: &str| STYLES.iter().find(|(name, _)| *name == style).map(|(_, row)| *row);
    if let Some(style) = &title.style {
        let known = || STYLES.map(|(name, _)| name).join(", ");
        let unknown = || {
            let needed = format!("one of the atom styles {}", known());
            Flaw::needed(&needed, format_args!("{style:?}")).at_line(title.line)
        };
        notes.read(format!("atom style {style}"));
        return columns(style).ok_or_else(unknown);
    }
    let Some(style) = guessed(row) else {
        let known = STYLES.map(|(name, _)| name).join(", ");
        let needed = format!("the atom style behind the title: Atoms # and one of {known}");
        return Err(Flaw::needed(&needed, "none").at_line(title.line));
    };
    notes.guessed(format!(
        "atom style {style}, by its first row (a comment behind the title says another: Atoms # style)"
    ));
    Ok(columns(style).unwrap_or_default())
}

/// The common style that a row looks like.
fn guessed(row: &[u8]) -> Option<&'static str> {
    let row: Vec<&[u8]> = fields(row).take_while(|field| !field.starts_with(b"#")).collect();
    let is_integer =
        |field: &&[u8]| field.iter().all(|byte| byte.is_ascii_digit() || b"+-".contains(byte));
    let is_number = |field: &&[u8]| number(field, DecimalMark::Point).is_some();
    let has_images = row.len() >= 8 && row[row.len() - 3..].iter().all(is_integer);
    let row = &row[..row.len() - if has_images { 3 } else { 0 }];
    if !row.iter().skip(2).all(is_number) {
        return None;
    }
    match row.len() {
        5 | 0 => Some("atomic"),
        6 if is_integer(&row[2]) => Some("molecular"),
        6 => Some("charge"),
        7 if is_integer(&row[2]) => Some("full"),
        7 => Some("sphere"),
        _ => None,
    }
}

fn becomes(name: &str, request: &Request) -> Becomes {
    match name {
        "x" => Becomes::Coordinate(0),
        "y" => Becomes::Coordinate(1),
        "z" => Becomes::Coordinate(2),
        _ if !request.wanted.wants(name) => Becomes::Nothing,
        "type" => Becomes::Word,
        _ => Becomes::Number,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::table::{Lines, Values};

    const FULL: &str = "LAMMPS data file\n\n2 atoms\n1 bonds\n2 atom types\n\n-1 3.0 xlo xhi\n\
        0 2 ylo yhi\n0 2 zlo zhi\n1 0 0.5 xy xz yz\n\nMasses\n\n1 12.0 # C\n2 1\n\nAtoms # full\n\n\
        2 1 2 0.5 1 2 3 0 0 1\n1 1 1 -0.5 4 5 6 0 0 0 # first\n\nVelocities\n\n1 0 0 0\n";

    fn read(text: &str) -> Result<Table, Flaw> {
        let bytes = text.as_bytes();
        table(bytes, &Span::whole(bytes), &Request::default(), &mut Notes::default())
    }

    fn refusal(text: &str) -> String {
        read(text).expect_err("refused").in_file("a.data").to_string()
    }

    /// A file with these rows below this title.
    fn with_rows(title: &str, rows: &str) -> String {
        format!("# comment\n1 atoms\n{title}\n\n{rows}\n")
    }

    #[test]
    fn rows_are_those_of_their_style() {
        assert!(recognizes(FULL.as_bytes()));
        assert!(!recognizes(b"3\n3 atoms\nO 0 0 0\nH 1 0 0\nH 0 1 0\n"));
        let table = read(FULL).expect("legal");
        assert_eq!(table.positions, [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)]);
        assert_eq!(table.lines, Lines::From(19));
        let charges = Values::Numbers(vec![0.5, -0.5]);
        assert_eq!(table.column("charge").map(|column| &column.values), Some(&charges));
        let cell = table.cell.expect("a box");
        assert_eq!(cell.origin, DVec3::new(-1.0, 0.0, 0.0));
        assert_eq!(cell.edges[2], DVec3::new(0.0, 0.5, 2.0));
        for (style, columns) in STYLES {
            let names: Vec<&str> = columns.split(' ').collect();
            let row: Vec<String> = (1..=names.len()).map(|number| number.to_string()).collect();
            let table = read(&with_rows(&format!("Atoms  # {style}"), &row.join(" ")));
            let place =
                |axis| names.iter().position(|name| *name == axis).map(|at| (at + 1) as f64);
            let expected = ["x", "y", "z"].map(|axis| place(axis).expect("a coordinate"));
            let positions = table.expect("legal").positions;
            assert_eq!(positions, [DVec3::from_array(expected)], "{style}");
        }
    }

    #[test]
    fn common_styles_are_told_by_their_rows() {
        let x = |row: &str| {
            read(&with_rows("Atoms", row)).map(|table| table.positions[0].x).map_err(|f| f.problem)
        };
        assert_eq!(x("1 1 5.5 2 3"), Ok(5.5));
        assert_eq!(x("1 1 5 2 3 0 0 -1"), Ok(5.0));
        assert_eq!(x("1 1 0.3 5 2 3"), Ok(5.0));
        assert_eq!(x("1 7 1 5 2.5 3 0 0 0"), Ok(5.0));
        assert_eq!(x("1 7 1 -0.3 5 2 3"), Ok(5.0));
        assert_eq!(x("1 1 0.5 1.5 5 2 3"), Ok(5.0));
        assert!(x("1 1 0.5 1.5 5 2 3 4 5 6.5").is_err_and(|problem| problem.contains("hybrid")));
    }

    #[test]
    fn refusals_say_both_numbers_and_the_line() {
        let text = FULL.replace("2 atoms", "3 atoms");
        assert_eq!(refusal(&text), "a.data, line 21: needed 3 atoms as line 3 says, found 2");
        let text = FULL.replace("2 atoms", "1 atoms");
        assert_eq!(refusal(&text), "a.data, line 20: needed 1 atom as line 3 says, found 2");
        let text = FULL.replace("# full", "# fool");
        assert!(
            refusal(&text).starts_with("a.data, line 17: needed one of the atom styles angle,")
        );
        let text = FULL.replace("-0.5 4", "-0.5 four");
        assert_eq!(
            refusal(&text),
            "a.data, line 20, column 5 (x): needed a finite number, found \"four\""
        );
        assert!(refusal("a\n1 atoms\n").contains("needed a section Atoms"));
    }

    proptest! {
        #[test]
        fn no_mutated_file_panics(at in 0..FULL.len(), byte: u8, cut in 0..FULL.len()) {
            let mut bytes = FULL.as_bytes().to_vec();
            bytes[at] = byte;
            for bytes in [&bytes[..], &bytes[..cut], &bytes[cut..]] {
                let span = Span::whole(bytes);
                let _ = table(bytes, &span, &Request::default(), &mut Notes::default());
            }
        }
    }
}
