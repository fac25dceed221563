//! GRO (GROMACS): a title, a count, a line in fixed columns for each atom, the box; then the next frame.
//! Lengths are nanometres.

use glam::DVec3;

use super::atoms::{Atom, Atoms, RESIDUE_NUMBER, Wants};
use super::pdb::line::has_numbers;
use super::{Reader, Request, Span};
use crate::cell::Cell;
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::number::{DecimalMark, number};
use crate::table::Table;
use crate::text::{fields, first_line, lines, word};
use crate::units::Unit;

pub(super) const READER: Reader =
    Reader { name: "GRO", endings: &["gro"], is_text: true, recognizes, frames, table };

/// Columns before the coordinates: number and name of the residue, name and number of the atom.
const X: usize = 20;

/// Whether the second line is a count, and the third an atom, or the box where there is none.
fn recognizes(bytes: &[u8]) -> bool {
    let (_, rest) = first_line(bytes);
    let (count, rest) = first_line(rest);
    let (atom, _) = first_line(rest);
    match count_of(count) {
        None => false,
        Some(0) => box_of(atom).is_some(),
        Some(_) => is_atom(atom) || (fields(atom).count() > 5 && has_numbers(atom)),
    }
}

fn is_atom(line: &[u8]) -> bool {
    Layout::of(line).is_some_and(|layout| layout.atom(line).is_ok())
}

fn count_of(line: &[u8]) -> Option<usize> {
    std::str::from_utf8(line.trim_ascii()).ok()?.parse().ok()
}

/// Finds the frames by their counts.
fn frames(bytes: &[u8]) -> Result<Vec<Span>, Flaw> {
    let mut spans = Vec::new();
    let (mut start, mut line) = (0, 1);
    loop {
        let (_, behind_title) = first_line(&bytes[start..]);
        let (count_line, _) = first_line(behind_title);
        let count = count_of(count_line).ok_or_else(|| {
            let found = format!("{:?}", word(count_line));
            Flaw::needed("the number of atoms", found).at_line(line + 1)
        })?;
        let mut ends = memchr::memchr_iter(b'\n', &bytes[start..]);
        let count_of_lines = count.saturating_add(3);
        let end = ends.nth(count_of_lines - 1).map_or(bytes.len(), |end| start + end + 1);
        check_last(&bytes[start..end], count, line)?;
        spans.push(Span { bytes: start..end, line });
        line = line.saturating_add(count_of_lines);
        start = end;
        if bytes[start..].trim_ascii().is_empty() {
            return Ok(spans);
        }
    }
}

/// Refuses a frame that has an atom in place of its box.
fn check_last(frame: &[u8], count: usize, line: usize) -> Result<(), Flaw> {
    let end = frame.trim_ascii_end().len();
    let begin = memchr::memrchr(b'\n', &frame[..end]).map_or(0, |end| end + 1);
    let lines = memchr::memchr_iter(b'\n', &frame[..begin]).count();
    if lines != count.saturating_add(2) || !is_atom(&frame[begin..end]) {
        return Ok(());
    }
    let needed = format!("{} as line {} says, and the box", counted(count, "atom"), line + 1);
    let found = format!("what looks like atom {}", count.saturating_add(1));
    Err(Flaw::needed(&needed, found).at_line(line + lines))
}

fn table(bytes: &[u8], span: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let (_, rest) = first_line(&bytes[span.bytes.clone()]);
    let (count, rest) = first_line(rest);
    let count = count_of(count).unwrap_or(0);
    let (rows, last) = split(rest, count, span.line)?;
    let first = span.line + 2;
    let layout = Layout::of(first_line(rows).0);
    let wants = Wants::of(request, &[RESIDUE_NUMBER]);
    let atoms = Atoms::of_lines(rows, first, wants, |bytes, first, atoms| {
        for (number, line) in lines(bytes, first) {
            let flaw = || no_atom(line).at_line(number);
            let atom = layout.as_ref().ok_or_else(flaw)?.atom(line);
            atoms.push(&atom.map_err(|flaw| flaw.at_line(number))?, number);
        }
        Ok(())
    })?;
    let mut table = atoms.table(notes);
    // Programs without periodic cells end the file before the box.
    table.cell = match last {
        None => {
            notes.read("no box behind the atoms");
            None
        }
        Some(last) => Cell::new(box_of(last).ok_or_else(|| {
            let found = format!("{:?}", word(last));
            let needed = format!("the box of 3 or 9 numbers behind {}", counted(count, "atom"));
            Flaw::needed(&needed, found).at_line(first + count)
        })?),
    };
    table.unit = Some(Unit::Nanometre);
    Ok(table)
}

/// The lines of so many atoms, and the line behind them if there is one.
fn split(rest: &[u8], count: usize, line: usize) -> Result<(&[u8], Option<&[u8]>), Flaw> {
    let lines = || memchr::memchr_iter(b'\n', rest).count() + usize::from(!rest.ends_with(b"\n"));
    let end = match count {
        0 => 0,
        _ => match memchr::memchr_iter(b'\n', rest).nth(count - 1) {
            Some(end) => end + 1,
            None if !rest.is_empty() && lines() == count => rest.len(),
            None => {
                let atoms = counted(count, "atom");
                let needed = format!("{atoms} as line {} says, and the box", line + 1);
                let found = if rest.is_empty() { 0 } else { lines() };
                let found = format!("the end of the file after {}", counted(found, "line"));
                return Err(Flaw::needed(&needed, found).at_line(line + 2));
            }
        },
    };
    let (rows, behind) = rest.split_at(end);
    let last = (!behind.trim_ascii().is_empty()).then(|| first_line(behind).0);
    Ok((rows, last))
}

/// The edges of a box: their lengths, or `xx yy zz xy xz yx yz zx zy`.
fn box_of(line: &[u8]) -> Option<[DVec3; 3]> {
    let read = |field: &[u8]| number(field, DecimalMark::Point).filter(|number| number.is_finite());
    let between_blanks: Option<Vec<f64>> = fields(line).map(read).collect();
    // Where lengths touch, their points stand in equal steps.
    let in_columns = || {
        let points: Vec<usize> = memchr::memchr_iter(b'.', line).collect();
        let width = points.get(1)? - points[0];
        let is_of_numbers = |byte: &u8| byte.is_ascii_digit() || b" .-".contains(byte);
        line.iter().all(is_of_numbers).then_some(())?;
        let decimals = line.trim_ascii_end().len() - 1 - points.last()?;
        let end = |point: &usize| (point + 1 + decimals).min(line.len());
        let field = |point: &usize| read(&line[end(point).saturating_sub(width)..end(point)]);
        points.iter().map(field).collect()
    };
    let numbers: Vec<f64> = between_blanks.or_else(in_columns)?;
    match numbers[..] {
        [x, y, z] => Some([DVec3::X * x, DVec3::Y * y, DVec3::Z * z]),
        [xx, yy, zz, xy, xz, yx, yz, zx, zy] => {
            Some([DVec3::new(xx, xy, xz), DVec3::new(yx, yy, yz), DVec3::new(zx, zy, zz)])
        }
        _ => None,
    }
}

/// How many columns a coordinate has: its point stands as far from the next one's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Layout {
    width: usize,
}

impl Layout {
    fn of(line: &[u8]) -> Option<Self> {
        let points: Vec<usize> =
            memchr::memchr_iter(b'.', line).filter(|at| *at >= X).take(3).collect();
        let &[x, y, z] = &points[..] else { return None };
        (y - x == z - y && y - x <= 40).then_some(Self { width: y - x })
    }

    fn atom(self, line: &[u8]) -> Result<Atom<'_>, Flaw> {
        // With d decimals a coordinate has d + 5 columns: four before its point.
        let mut position = DVec3::ZERO;
        for axis in 0..3 {
            let start = X + self.width * axis;
            let field = line.get(start..start + self.width).ok_or_else(|| no_atom(line))?;
            let has_point = field.get(4) == Some(&b'.');
            let number = number(field, DecimalMark::Point).filter(|number| number.is_finite());
            position[axis] = number.filter(|_| has_point).ok_or_else(|| {
                let (first, last, point) = (start + 1, start + self.width, start + 5);
                let needed =
                    format!("a finite number in columns {first} to {last}, its point in {point}");
                let found = format!("{:?}", word(field));
                Flaw::needed(&needed, found).at_column(start + 1).at_key(["x", "y", "z"][axis])
            })?;
        }
        let columns = |from: usize, to: usize| line[from..to].trim_ascii();
        let residue_number = columns(0, 5);
        let is_number =
            std::str::from_utf8(residue_number).is_ok_and(|text| text.parse::<i64>().is_ok());
        if !is_number {
            return Err(no_atom(line));
        }
        let mut atom = Atom {
            position,
            residue: columns(5, 10),
            name: columns(10, 15),
            residue_number,
            ..Atom::default()
        };
        atom.numbers[RESIDUE_NUMBER] =
            number(residue_number, DecimalMark::Point).unwrap_or(f64::NAN);
        Ok(atom)
    }
}

fn no_atom(line: &[u8]) -> Flaw {
    let found = format!("{:?}", word(line));
    Flaw::needed(
        "the number and name of a residue, the name and number of an atom in five columns each, and \
         coordinates behind column 20",
        found,
    )
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::formats::testing::{changed, words};

    const WATER: &str = "water t= 0.0\n    4\n    1SOL     OW    1   0.100   0.200  -0.300  0.1000  0.2000  0.3000\n\
                         \x20   1SOL    HW1    2   0.196   0.000   0.000\n    1SOL     MW    3   0.010   0.000   0.000\n\
                         99999CA      CA99999  -1.024   0.093   0.000\n   2.0 3.0 4.0\n";

    fn read_all(text: &str) -> Result<(Table, Vec<String>), Flaw> {
        let mut notes = Notes::default();
        let spans = frames(text.as_bytes())?;
        let table = table(text.as_bytes(), &spans[0], &Request::default(), &mut notes)?;
        Ok((table, notes.iter().map(|note| note.text.clone()).collect()))
    }

    fn refusal(text: &str) -> String {
        read_all(text).expect_err("refused").in_file("a.gro").to_string()
    }

    #[test]
    fn columns_are_read() {
        let (table, notes) = read_all(WATER).expect("legal");
        assert_eq!(table.positions[0], DVec3::new(0.1, 0.2, -0.3));
        assert_eq!(words(&table, "element"), ["O", "H", "Ca"]);
        assert_eq!(words(&table, "residue_number"), ["1", "1", "99999"]);
        assert_eq!(words(&table, "residue"), ["SOL", "SOL", "CA"]);
        assert_eq!((table.lines.get(0), table.lines.get(2)), (Some(3), Some(6)));
        assert_eq!(table.cell.map(|cell| cell.edges[2].z), Some(4.0));
        assert_eq!((table.unit, table.atoms), (Some(Unit::Nanometre), true));
        assert_eq!(notes, ["1 virtual site (MW)"]);
    }

    #[test]
    fn decimals_say_the_width() {
        for line in [
            "    1SOL     OW    1 0.10000 0.20000-0.30000",
            "    1SOL     OW    1   0.10000   0.20000  -0.30000",
            "    1SOL     OW    1   0.1   0.2  -0.3",
            "    1SOL     OW    1   0.100000000   0.200000000  -0.300000000  -0.3000000000",
        ] {
            let text = format!("title\n1\n{line}\n0 0 0\n");
            // Where there are other than four columns before a point, the columns are not certain.
            match read_all(&text) {
                Ok((table, _)) => {
                    assert_eq!(table.positions, [DVec3::new(0.1, 0.2, -0.3)], "{line}");
                }
                Err(flaw) => {
                    assert_eq!((flaw.location.line, line.contains("00-0")), (Some(3), true));
                }
            }
        }
    }

    #[test]
    fn frames_follow_each_other() {
        let text = WATER.repeat(2) + "empty\n0\n1 1 1\n\n";
        let spans = frames(text.as_bytes()).expect("legal");
        assert_eq!(spans.iter().map(|span| span.line).collect::<Vec<_>>(), [1, 8, 15]);
        let last = table(text.as_bytes(), &spans[2], &Request::default(), &mut Notes::default());
        assert!(last.expect("legal").is_empty());
    }

    #[test]
    fn boxes_have_three_edges() {
        let skewed = WATER.replace("2.0 3.0 4.0", "2 3 4 0 0 1 0 0.5 0.25");
        let (table, _) = read_all(&skewed).expect("legal");
        let edges = table.cell.expect("a box").edges;
        assert_eq!((edges[1], edges[2]), (DVec3::new(1.0, 3.0, 0.0), DVec3::new(0.5, 0.25, 4.0)));
        let touching = WATER.replace("   2.0 3.0 4.0", "20000.0000030000.0000040000.00000");
        let (table, _) = read_all(&touching).expect("legal");
        assert_eq!(table.cell.map(|cell| cell.edges[2].z), Some(40_000.0));
        for without in [
            WATER.replace("2.0 3.0 4.0", "0 0 0"),
            WATER.replace("   2.0 3.0 4.0\n", ""),
            WATER.replace("\n   2.0 3.0 4.0\n", ""),
        ] {
            let (table, _) = read_all(&without).expect("legal");
            assert_eq!((table.len(), table.cell), (3, None), "{without}");
        }
    }

    #[test]
    fn refusals_say_both_numbers() {
        let many = refusal(&WATER.replace("    4\n", "    7\n"));
        assert_eq!(
            many,
            "a.gro, line 3: needed 7 atoms as line 2 says, and the box, found the end of the file after 5 lines"
        );
        let few = refusal(&WATER.replace("    4\n", "    3\n").replace("   2.0 3.0 4.0\n", ""));
        assert_eq!(
            few,
            "a.gro, line 6: needed 3 atoms as line 2 says, and the box, found what looks like atom 4"
        );
        let other = refusal(&WATER.replace("2.0 3.0 4.0", "2.0 3.0"));
        assert!(
            other.starts_with("a.gro, line 7: needed the box of 3 or 9 numbers behind 4 atoms"),
            "{other}"
        );
        let bad = refusal(&WATER.replace("   0.196", "   0.1x6"));
        assert!(
            bad.starts_with(
                "a.gro, line 4, column 21 (x): needed a finite number in columns 21 to 28"
            ),
            "{bad}"
        );
        let greatest = refusal(&WATER.replace("    4\n", "18446744073709551615\n"));
        assert!(greatest.contains("needed 18446744073709551615 atoms"), "{greatest}");
        assert!(refusal("title\nfour\n").starts_with("a.gro, line 2: needed the number of atoms"));
        let moved = refusal(&WATER.replace("    1SOL    HW1", "     1SOL    HW1"));
        assert!(moved.starts_with("a.gro, line 4"), "{moved}");
    }

    #[test]
    fn it_is_recognized_by_its_third_line() {
        assert!(recognizes(WATER.as_bytes()) && recognizes(b"none\n0\n1 1 1\n"));
        for text in ["", "3\n\nO 0 0 0\n", "t\n1\nO 0.0 0.0 0.0\n", "t\n0\n"] {
            assert!(!recognizes(text.as_bytes()), "{text}");
        }
    }

    fn try_all(bytes: &[u8]) {
        let _ = recognizes(bytes);
        for span in frames(bytes).unwrap_or_default() {
            let _ = table(bytes, &span, &Request::default(), &mut Notes::default());
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            try_all(&bytes);
            try_all(&[&b"title\n1\n"[..], &bytes].concat());
        }

        #[test]
        fn no_change_of_a_good_file_panics(bytes in changed(WATER.repeat(2).into_bytes())) {
            try_all(&bytes);
        }
    }
}
