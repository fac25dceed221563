//! XYZ and extended XYZ: a count, a comment, and one line for each particle; then the next frame.
//!
//! Plain lines are `species x y z`. A `Properties=` entry in the comment says other columns, a `Lattice=`
//! entry the periodic cell.

use glam::DVec3;

use super::{Reader, Request, Span};
use crate::cell::Cell;
use crate::elements::element_of_label;
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::number::{DecimalMark, number};
use crate::roles::Role;
use crate::rows::{Becomes, Field, Rows, Separator, Width};
use crate::table::{Column, Table, Values};
use crate::text::{fields, first_line, word};

pub(super) const READER: Reader =
    Reader { name: "XYZ", endings: &["xyz", "extxyz"], is_text: true, recognizes, frames, table };

/// Whether the first line is a count, and the third a particle; or all are particles without a count.
fn recognizes(bytes: &[u8]) -> bool {
    let (start, _) = behind_blanks(bytes);
    let (first, rest) = first_line(&bytes[start..]);
    let (second, behind) = first_line(rest);
    let (third, _) = first_line(behind);
    match count_of(first) {
        Some(_) if has_position(third) || looks_like_particle(second) || is_indexed(second) => true,
        Some(count) => fields(first).count() == 1 && (count == 0 || behind.is_empty()),
        None => is_atom(first) && (rest.trim_ascii().is_empty() || is_atom(second)),
    }
}

/// Where the first line is that is not blank, and how many are before it.
fn behind_blanks(bytes: &[u8]) -> (usize, usize) {
    let blank = bytes.len() - bytes.trim_ascii_start().len();
    let start = memchr::memrchr(b'\n', &bytes[..blank]).map_or(0, |end| end + 1);
    (start, memchr::memchr_iter(b'\n', &bytes[..start]).count())
}

/// The count that a line has, alone or before words.
fn count_of(line: &[u8]) -> Option<usize> {
    let mut fields = fields(line);
    let count = std::str::from_utf8(fields.next()?).ok()?.parse().ok()?;
    let is_words = fields.next().is_none_or(|word| !is_number(word)) && !is_indexed(line);
    is_words.then_some(count)
}

fn is_number(field: &[u8]) -> bool {
    [DecimalMark::Point, DecimalMark::Comma].iter().any(|mark| number(field, *mark).is_some())
}

/// The decimal mark of a row.
fn mark_of(row: &[u8]) -> DecimalMark {
    let has_comma = |field: &[u8]| field.contains(&b',') && is_number(field);
    if fields(row).any(has_comma) { DecimalMark::Comma } else { DecimalMark::Point }
}

/// Whether three numbers in a row are among the fields.
fn has_position(line: &[u8]) -> bool {
    fields(line).map(is_number).collect::<Vec<_>>().windows(3).any(|three| three == [true; 3])
}

/// Whether a line reads as `species x y z`.
fn looks_like_particle(line: &[u8]) -> bool {
    let mut fields = fields(line);
    let starts_with_letter = |field: &[u8]| field.first().is_some_and(u8::is_ascii_alphabetic);
    fields.next().is_some_and(starts_with_letter)
        && fields.clone().take(3).filter(|f| is_number(f)).count() == 3
}

/// Whether a line reads as `species x y z` of an element, which begins with a capital.
fn is_atom(line: &[u8]) -> bool {
    let label = fields(line).next().unwrap_or_default();
    looks_like_particle(line)
        && label[0].is_ascii_uppercase()
        && element_of_label(&word(label)).is_some()
}

/// Whether a line reads as `index species x y z`: Tinker numbers its atoms.
fn is_indexed(line: &[u8]) -> bool {
    let index = fields(line).next().unwrap_or_default();
    let behind = line.trim_ascii_start().get(index.len()..).unwrap_or_default();
    !index.is_empty() && index.iter().all(u8::is_ascii_digit) && looks_like_particle(behind)
}

/// Whether two lines have the same fields: numbers, whole or not, and words at the same places.
fn are_alike(one: &[u8], other: &[u8]) -> bool {
    let kind = |field: &[u8]| (is_number(field), field.iter().all(u8::is_ascii_digit));
    let kinds = |line| fields(line).map(is_number).collect::<Vec<_>>();
    let first = |line| fields(line).next().map(kind);
    has_position(one) && kinds(one) == kinds(other) && first(one) == first(other)
}

/// The parts of a frame.
struct Frame<'a> {
    /// `None` where the file has none, and every line is a particle.
    count: Option<usize>,
    comment: &'a [u8],
    rows: &'a [u8],
    /// Number of lines before the rows.
    before: usize,
}

impl<'a> Frame<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let (first, rest) = first_line(bytes);
        let (second, behind) = first_line(rest);
        match count_of(first) {
            None => Self { count: None, comment: b"", rows: bytes.trim_ascii_end(), before: 0 },
            // Tinker's first atom stands where others have a comment.
            count if is_indexed(second) => Self { count, comment: b"", rows: rest, before: 1 },
            count => Self { count, comment: second, rows: behind, before: 2 },
        }
    }
}

/// Finds the frames by their counts. What follows the last one is left out, unless it looks like more
/// particles.
fn frames(bytes: &[u8]) -> Result<Vec<Span>, Flaw> {
    let (mut start, blank) = behind_blanks(bytes);
    let mut line = blank + 1;
    let (title, _) = first_line(&bytes[start..]);
    let has_words = fields(title).count() > 1;
    let mut spans = Vec::new();
    if count_of(title).is_none() {
        if is_atom(title) {
            return Ok(vec![Span { bytes: start..bytes.len(), line }]);
        }
        let found = format_args!("{:?}", word(title));
        let flaw = Flaw::needed("the number of particles", found).at_line(line);
        return Err(flaw.or("a table without it is read too, three numbers in a row"));
    }
    loop {
        let (first, _) = first_line(&bytes[start..]);
        let is_next = spans.is_empty()
            || fields(first).count() == 1
            || (has_words && recognizes(&bytes[start..]));
        let Some(count) = count_of(first).filter(|_| is_next) else {
            let last = spans.last().map(|span: &Span| &bytes[span.bytes.clone()]);
            let last = last.unwrap_or_default().trim_ascii_end();
            let begin = memchr::memrchr(b'\n', last).map_or(0, |end| end + 1);
            return match looks_like_particle(first) || are_alike(&last[begin..], first) {
                true => Err(too_many(bytes, spans.last(), line)),
                false => Ok(spans),
            };
        };
        let mut ends = memchr::memchr_iter(b'\n', &bytes[start..]);
        let lines = count.saturating_add(Frame::of(&bytes[start..]).before);
        let end = ends.nth(lines - 1).map_or(bytes.len(), |end| start + end + 1);
        spans.push(Span { bytes: start..end, line });
        line = line.saturating_add(lines);
        // Blank lines between frames are none.
        let rest = &bytes[end..];
        let blank = rest.len() - rest.trim_ascii_start().len();
        line += memchr::memchr_iter(b'\n', &rest[..blank]).count();
        start = end + blank;
        if start >= bytes.len() {
            return Ok(spans);
        }
    }
}

/// More particles than their count says.
fn too_many(bytes: &[u8], span: Option<&Span>, line: usize) -> Flaw {
    let (start, first) = span.map_or((0, 1), |span| (span.bytes.start, span.line));
    let frame = Frame::of(&bytes[start..]);
    let found = format!("what looks like particle {}", line - first - frame.before + 1);
    let needed = format!("{} as line {first} says", counted(frame.count.unwrap_or(0), "particle"));
    Flaw::needed(&needed, found).at_line(line)
}

fn table(bytes: &[u8], span: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let frame = Frame::of(&bytes[span.bytes.clone()]);
    let text = word(frame.comment);
    let properties = property(&text, "Properties");
    let first_row = first_line(frame.rows).0;
    let mut layout = match properties {
        Some(properties) => {
            of_properties(properties).map_err(|flaw| flaw.at_line(span.line + 1))?
        }
        None => plain(first_row),
    };
    for field in &mut layout {
        let wanted = request.wanted.wants(&field.name);
        if !wanted && !matches!(field.becomes, Becomes::Coordinate(_)) {
            field.becomes = Becomes::Nothing;
        }
    }
    check_count(&frame, span)?;
    say_columns(&layout, properties.is_some(), first_row, notes);
    if frame.count.is_none() {
        notes.guessed("no count in the first line: every line is a particle");
    }
    let rows_of = Rows {
        separator: Separator::Blanks,
        mark: mark_of(first_row),
        fields: layout,
        width: Width::AsNeeded,
        skips: None,
    };
    let mut table = rows_of.read(frame.rows, span.line + frame.before)?;
    table.cell = cell(&text, notes);
    if text.trim_start().starts_with("Atoms. Timestep") {
        types_of_lammps(&mut table, notes);
    }
    Ok(table)
}

/// Refuses fewer lines than the count says.
fn check_count(frame: &Frame<'_>, span: &Span) -> Result<(), Flaw> {
    let Frame { count: Some(count), comment, rows, before } = *frame else { return Ok(()) };
    let found = memchr::memchr_iter(b'\n', rows).count()
        + usize::from(!rows.is_empty() && !rows.ends_with(b"\n"));
    if found >= count {
        return Ok(());
    }
    let end = rows.trim_ascii_end();
    let particles = if end.is_empty() { 0 } else { memchr::memchr_iter(b'\n', end).count() + 1 };
    let found = format!("the end of the file after {particles}");
    let flaw = Flaw::needed(&counted(count, "particle"), found);
    let flaw = flaw.at_line(span.line + before + particles);
    let first_row = first_line(rows).0;
    Err(if looks_like_particle(comment) || are_alike(comment, first_row) {
        flaw.or(format!("line {} is the comment, and looks like a particle", span.line + 1))
    } else {
        flaw
    })
}

/// Says which columns are read, and which are not.
fn say_columns(layout: &[Field], by_properties: bool, first_row: &[u8], notes: &mut Notes) {
    let behind = fields(first_row).count().saturating_sub(layout.len());
    if !by_properties {
        if layout.first().is_some_and(|field| field.name == INDEX) {
            notes.read("the first column numbers the particles");
        }
        if behind > 0 {
            notes.left_out(format!("{} behind x, y and z", counted(behind, "column")));
        }
        return;
    }
    notes.read("columns as its Properties say");
    let unused = layout.iter().filter(|field| field.becomes == Becomes::Nothing);
    let mut unused: Vec<&str> =
        unused.map(|field| field.name.split(':').next().unwrap_or_default()).collect();
    unused.dedup();
    if !unused.is_empty() {
        notes.left_out(format!("columns not used: {}", unused.join(", ")));
    }
}

/// LAMMPS writes numbers of types where others have elements, unless it was told these.
fn types_of_lammps(table: &mut Table, notes: &mut Notes) {
    let are_numbers = |column: &&mut Column| {
        let Values::Words(words) = &column.values else { return true };
        words.different().iter().all(|word| word.parse::<u32>().is_ok())
    };
    let species = table.columns.iter_mut().find(|column| column.name == "species");
    if let Some(column) = species.filter(are_numbers) {
        "type".clone_into(&mut column.name);
        notes.read("the first column has LAMMPS' types, not elements");
    }
}

/// What errors call the column before the species that numbers particles.
const INDEX: &str = "index";

/// `species x y z`, behind an index or not, and nothing of what follows; or `x y z`.
fn plain(first: &[u8]) -> Vec<Field> {
    let mut fields = fields(first);
    let bare = fields.clone().count() == 3 && fields.all(is_number);
    let index = Field { name: INDEX.to_owned(), becomes: Becomes::Nothing };
    let species = Field { name: "species".to_owned(), becomes: Becomes::Word };
    let position = ["x", "y", "z"]
        .into_iter()
        .enumerate()
        .map(|(axis, name)| Field { name: name.to_owned(), becomes: Becomes::Coordinate(axis) });
    let index = is_indexed(first).then_some(index);
    index.into_iter().chain((!bare).then_some(species)).chain(position).collect()
}

/// The value of `key=value` or `key="value"` in a comment, capitals of the key or not.
fn property<'a>(comment: &'a str, key: &str) -> Option<&'a str> {
    let mut from = 0;
    loop {
        let at =
            from + comment.get(from..)?.to_ascii_lowercase().find(&key.to_ascii_lowercase())?;
        let begins = at == 0 || comment.as_bytes()[at - 1].is_ascii_whitespace();
        let value = comment[at + key.len()..].trim_start().strip_prefix('=').map(str::trim_start);
        if let (true, Some(value)) = (begins, value) {
            if value.starts_with(['{', '[']) {
                return Some(&value[..end_of_brackets(value)]);
            }
            let quote = value.chars().next().filter(|first| matches!(first, '"' | '\''));
            let end = |c: char| quote.map_or(c.is_whitespace(), |quote| c == quote);
            let value = &value[quote.map_or(0, char::len_utf8)..];
            return Some(value.split(end).next().unwrap_or_default());
        }
        from = at + key.len();
    }
}

/// Where the brackets end that a text begins with, those within them too.
fn end_of_brackets(text: &str) -> usize {
    let mut depth = 0;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'{' | b'[' => depth += 1,
            b'}' | b']' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

/// The fields of `name:type:count:…`.
fn of_properties(properties: &str) -> Result<Vec<Field>, Flaw> {
    let flaw = || Flaw::needed("Properties=name:type:count:…", format_args!("{properties:?}"));
    let mut fields = Vec::new();
    let mut has_position = false;
    for property in properties.split(':').collect::<Vec<_>>().chunks(3) {
        let &[name, kind, count] = property else { return Err(flaw()) };
        let count: usize = count.parse().ok().filter(|count| *count <= 1000).ok_or_else(flaw)?;
        let is_position =
            matches!(name.to_ascii_lowercase().as_str(), "pos" | "position" | "positions")
                && count == 3;
        has_position |= is_position;
        for component in 0..count {
            let (name, becomes) = if is_position {
                (["x", "y", "z"][component].to_owned(), Becomes::Coordinate(component))
            } else {
                (component_name(name, component, count), becomes(name, kind))
            };
            fields.push(Field { name, becomes });
        }
    }
    if !has_position {
        let found = format_args!("{properties:?}");
        return Err(Flaw::needed("pos:R:3 among the Properties", found));
    }
    Ok(fields)
}

fn component_name(name: &str, component: usize, count: usize) -> String {
    // libAtoms calls atomic numbers Z, which is no coordinate where positions have a name of their own.
    match name {
        "z" | "Z" | "numbers" => "species".to_owned(),
        _ if count > 1 => format!("{name}:{component}"),
        _ if Role::of(name).is_some_and(|role| role.axis().is_some()) => format!("{name} property"),
        _ => name.to_owned(),
    }
}

fn becomes(name: &str, kind: &str) -> Becomes {
    let is_species = matches!(name, "z" | "Z" | "numbers");
    match kind.to_ascii_uppercase().as_str() {
        _ if is_species || Role::of(name).is_some_and(Role::is_word) => Becomes::Word,
        "S" | "L" => Becomes::Word,
        _ => Becomes::Number,
    }
}

/// The cell of `Lattice="ax ay az bx by bz cx cy cz"`, or three lengths, `Origin="x y z"` and
/// `pbc="T T F"`, with any brackets and commas.
fn cell(comment: &str, notes: &mut Notes) -> Option<Cell> {
    let words = |key: &str| -> Vec<String> {
        let text = property(comment, key).unwrap_or_default();
        let between = |c: char| c.is_whitespace() || ",[]{}\"'".contains(c);
        text.split(between).filter(|word| !word.is_empty()).map(str::to_owned).collect()
    };
    let numbers = |key: &str| -> Option<Vec<f64>> {
        let number = |word: &String| number(word.as_bytes(), DecimalMark::Point);
        words(key).iter().map(number).collect()
    };
    property(comment, "Lattice")?;
    let edges = match numbers("Lattice").unwrap_or_default()[..] {
        [a, b, c] => Some([DVec3::X * a, DVec3::Y * b, DVec3::Z * c]),
        [ax, ay, az, bx, by, bz, cx, cy, cz] => {
            Some([DVec3::new(ax, ay, az), DVec3::new(bx, by, bz), DVec3::new(cx, cy, cz)])
        }
        _ => None,
    };
    let Some(mut cell) = edges.and_then(Cell::new) else {
        notes.left_out("the periodic cell: its Lattice has no nine numbers of three edges");
        return None;
    };
    if let Some(Ok(origin)) = numbers("Origin").map(<[f64; 3]>::try_from) {
        cell.origin = DVec3::from_array(origin);
    }
    let flags = match &words("pbc")[..] {
        [letters] => letters.chars().map(String::from).collect(),
        flags => flags.to_vec(),
    };
    let is_periodic = |flag: &String| matches!(flag.as_str(), "T" | "t" | "True" | "true" | "1");
    let flags: Vec<bool> = flags.iter().map(is_periodic).collect();
    cell.periodic = flags.try_into().unwrap_or([true; 3]);
    Some(cell)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::formats::testing::words;
    use crate::table::Lines;

    fn read(text: &str) -> Result<Table, Flaw> {
        let spans = frames(text.as_bytes())?;
        table(text.as_bytes(), &spans[0], &Request::default(), &mut Notes::default())
    }

    fn refusal(text: &str) -> String {
        read(text).expect_err("refused").in_file("balls.xyz").to_string()
    }

    #[test]
    fn species_and_positions_are_read() {
        let table =
            read("3\nwater\nO 0 0 0\nH 0.96 0 0\n1 -2.4D-1 9.3*^-1 0 text\n").expect("legal");
        assert_eq!(table.positions[2], DVec3::new(-0.24, 0.93, 0.0));
        assert_eq!(words(&table, "species"), ["O", "H", "1"]);
        assert_eq!(table.lines, Lines::From(3));
    }

    #[test]
    fn properties_say_which_columns() {
        let text = "1\nLattice=\"2 0 0 0 3 0 0 0 4\" pbc=\"T T F\" Origin=\"1 1 1\" \
                    properties=id:I:1:pos:R:3:radius:R:1:Z:I:1:v:R:2 time=0\n7 1 2 3 0.5 8 4 5\n";
        let table = read(text).expect("legal");
        assert_eq!(table.positions, [DVec3::new(1.0, 2.0, 3.0)]);
        assert_eq!(
            (words(&table, "radius"), words(&table, "species")),
            (vec!["0.5".into()], vec!["8".into()])
        );
        assert_eq!(words(&table, "v:1"), ["5"]);
        let cell = table.cell.expect("a lattice");
        assert_eq!(
            (cell.edges[1].y, cell.origin.x, cell.periodic),
            (3.0, 1.0, [true, true, false])
        );
    }

    #[test]
    fn frames_follow_each_other() {
        let text = "1\n\nH 0 0 0\n\n2\nb\nH 0 0 0\nC 0 0 1\n0\n\n1\n\nO 1 1 1\ntrailer 1 2\n";
        let spans = frames(text.as_bytes()).expect("legal");
        assert_eq!(spans.iter().map(|span| span.line).collect::<Vec<_>>(), [1, 5, 9, 11]);
        let read = |span| table(text.as_bytes(), span, &Request::default(), &mut Notes::default());
        let counts: Vec<usize> =
            spans.iter().map(|span| read(span).expect("legal").len()).collect();
        assert_eq!(counts, [1, 2, 0, 1]);
        let words = "1 t=0\n\nH 0 0 0\n1 t=1\n\nH 0 0 0\n1 more\n";
        assert_eq!(frames(words.as_bytes()).expect("legal").len(), 2);
        assert_eq!(read(&spans[1]).expect("legal").lines.get(1), Some(8));
    }

    /// Each is the same two atoms.
    #[test]
    fn dialects_are_read() {
        for text in [
            "2\n\nO 0 0 0\nH 0.96 0 0\n",
            "\n  \n2\nwater\nO 0 0 0\nH 0.96 0 0\n\n",
            "2 atoms\nwater\nO 0 0 0\nH 0.96 0 0\n",
            "2 # atoms\nwater\nO 0 0 0 -0.8\nH 0.96 0 0 0.4\n",
            "O 0 0 0\nH 0.96 0 0\n\n",
            "2\ncommas\nO 0,0 0,0 0,0\nH 0,96 0,0 0,0\n",
            "2\nnumbered\n1 O 0 0 0\n2 H 0.96 0 0\n",
            "2 Water\n1 O 0 0 0 1 2\n2 H 0.96 0 0 2 1\n",
            "2\n20 20 20 90 90 90\n1 O 0 0 0 1 2\n2 H 0.96 0 0 2 1\n",
            "2 t=0\n\nO 0 0 0\nH 0.96 0 0\n2 t=1\n\nO 0 0 0\nH 9 0 0\n",
            "2\n1 O 0 0 0 1 2\n2 H 0.96 0 0 2 1\n2\n1 O 0 0 0 1 2\n2 H 9 0 0 2 1\n",
            "2\nAtoms. Timestep: 0\nO 0 0 0\nH 0.96 0 0\n",
        ] {
            let table = read(text).unwrap_or_else(|flaw| panic!("{text}: {flaw:?}"));
            assert_eq!(table.positions, [DVec3::ZERO, DVec3::X * 0.96], "{text}");
            assert_eq!(words(&table, "species"), ["O", "H"], "{text}");
            assert!(recognizes(text.as_bytes()), "{text}");
        }
        for other in ["v 0 0 0\nv 1 0 0\nf 1 2 3\n", "bead 0 0 0\n", "3 words\nof\ntext\n"] {
            assert!(!recognizes(other.as_bytes()), "{other}");
        }
    }

    #[test]
    fn lattices_are_read_however_they_are_written() {
        for lattice in [
            "Lattice=\"4 0 0 0 5 0 0 0 6\"",
            "lattice=\"4,0,0,0,5,0,0,0,6\"",
            "Lattice={{4 0 0} {0 5 0} {0 0 6}}",
            "Lattice=[[4, 0, 0], [0, 5, 0], [0, 0, 6]]",
            "Lattice = \"4.0D+00 5 6\"",
        ] {
            for pbc in ["pbc=\"T T F\"", "pbc=TTF", "pbc=[T, T, F]", "pbc=\"1 1 0\""] {
                let text = format!("1\n{lattice} {pbc}\nH 0 0 0\n");
                let cell = read(&text).expect("legal").cell.expect("a lattice");
                assert_eq!(cell.edges, [DVec3::X * 4.0, DVec3::Y * 5.0, DVec3::Z * 6.0], "{text}");
                assert_eq!(cell.periodic, [true, true, false], "{text}");
            }
        }
        let mut notes = Notes::default();
        assert_eq!(cell("Lattice=\"1 2 3 4\"", &mut notes), None);
        assert!(notes.iter().any(|note| note.text.starts_with("the periodic cell")));
    }

    #[test]
    fn columns_that_are_not_used_are_said() {
        let said = |text: &str| {
            let mut notes = Notes::default();
            let spans = frames(text.as_bytes()).expect("legal");
            let request =
                Request { wanted: crate::formats::Wanted::Named(Vec::new()), ..Request::default() };
            table(text.as_bytes(), &spans[0], &request, &mut notes).expect("legal");
            notes.iter().map(|note| note.text.clone()).collect::<Vec<_>>().join("\n")
        };
        let forces = "1\nProperties=species:S:1:pos:R:3:forces:R:3:energy:R:1\nH 0 0 0 1 2 3 4\n";
        assert!(said(forces).ends_with("columns not used: forces, energy"), "{}", said(forces));
        assert!(said("1\n\nH 0 0 0 1 2\n").ends_with("2 columns behind x, y and z"));
        assert_eq!(said("1\n\nH 0 0 0\n"), "");
    }

    #[test]
    fn lammps_types_are_no_elements() {
        let table = read("1\nAtoms. Timestep: 0\n1 0 0 0\n").expect("legal");
        assert!(table.column("species").is_none() && table.column("type").is_some());
    }

    #[test]
    fn bare_positions_have_no_species() {
        let table = read("1\n\n1 2 3\n").expect("legal");
        assert!(table.columns.is_empty() && table.positions[0].x == 1.0);
    }

    #[test]
    fn refusals_name_line_and_column() {
        assert!(
            refusal("one\n")
                .starts_with("balls.xyz, line 1: needed the number of particles, found \"one\"")
        );
        assert_eq!(
            refusal("1\n\nH 0 zero 0\n"),
            "balls.xyz, line 3, column 3 (y): needed a finite number, found \"zero\""
        );
        assert_eq!(
            refusal("2\n\nH 0 0 0\n"),
            "balls.xyz, line 4: needed 2 particles, found the end of the file after 1"
        );
        assert!(refusal("2\nH 0 0 0\nH 0 0 1\n").ends_with(
            "found the end of the file after 1; line 2 is the comment, and looks like a particle"
        ));
        assert_eq!(
            refusal("1\n\nH 0 0 0\nH 0 0 1\n"),
            "balls.xyz, line 4: needed 1 particle as line 1 says, found what looks like particle 2"
        );
        assert!(refusal("2\n1.0 2.0 3.0\n4.0 5.0 6.0\n").ends_with("looks like a particle"));
        for more in ["1\n\n8 0 0 0\n8 0 0 1\n", "1\n\n0 0 0\n0 0 1\n"] {
            assert!(refusal(more).contains("what looks like particle 2"), "{more}");
        }
        assert_eq!(
            refusal("1\nProperties=species:S:1\nH\n"),
            "balls.xyz, line 2: needed pos:R:3 among the Properties, found \"species:S:1\""
        );
        assert!(refusal("1\nProperties=pos:R\n\n").contains("needed Properties=name:type:count"));
        assert!(refusal("").contains("needed the number of particles"));
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            let _ = frames(&bytes).map(|spans| {
                table(&bytes, &spans[0], &Request::default(), &mut Notes::default())
            });
        }

        #[test]
        fn no_frame_panics(text in "[0-3]\n(Properties=[a-z]*:[SR]:[0-9]{1,20})?[:a-zR0-9]{0,12}\n([CHW] [-0-9.e ]{0,20}\n){0,4}") {
            let _ = read(&text);
        }
    }
}
