//! XYZ and extended XYZ: a count, a comment, and one line for each particle; then the next frame.
//!
//! Plain lines are `species x y z`. A `Properties=` entry in the comment says other columns, a `Lattice=`
//! entry the periodic cell.

use glam::DVec3;

use super::{Reader, Request, Span};
use crate::cell::Cell;
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::number::{DecimalMark, number};
use crate::roles::Role;
use crate::rows::{Becomes, Field, Rows, Separator, Width};
use crate::table::Table;
use crate::text::{fields, first_line, word};

pub(super) const READER: Reader =
    Reader { name: "XYZ", endings: &["xyz", "extxyz"], is_text: true, recognizes, frames, table };

/// Whether the first line is a count, and the third a particle.
fn recognizes(bytes: &[u8]) -> bool {
    let (first, rest) = first_line(bytes);
    let (comment, rest) = first_line(rest);
    let (particle, _) = first_line(rest);
    count_of(first).is_some_and(|count| {
        count == 0 || has_position(particle) || looks_like_particle(comment) || rest.is_empty()
    })
}

fn count_of(line: &[u8]) -> Option<usize> {
    let mut fields = fields(line);
    let count = std::str::from_utf8(fields.next()?).ok()?.parse().ok()?;
    fields.next().is_none().then_some(count)
}

fn is_number(field: &[u8]) -> bool {
    number(field, DecimalMark::Point).is_some()
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

/// Finds the frames by their counts. What follows the last one is left out, unless it looks like more
/// particles.
fn frames(bytes: &[u8]) -> Result<Vec<Span>, Flaw> {
    let mut spans = Vec::new();
    let (mut start, mut line) = (0, 1);
    loop {
        let (first, _) = first_line(&bytes[start..]);
        let Some(count) = count_of(first) else {
            if spans.is_empty() {
                let found = format_args!("{:?}", word(first));
                let flaw = Flaw::needed("the number of particles", found).at_line(1);
                return Err(flaw.or("a table without it is read too, three numbers in a row"));
            }
            return match looks_like_particle(first) {
                true => Err(too_many(bytes, spans.last(), line)),
                false => Ok(spans),
            };
        };
        let mut ends = memchr::memchr_iter(b'\n', &bytes[start..]);
        let lines = count.saturating_add(2);
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
    let (count, _) = first_line(&bytes[start..]);
    let found = format!("what looks like particle {}", line - first - 1);
    let needed =
        format!("{} as line {first} says", counted(count_of(count).unwrap_or(0), "particle"));
    Flaw::needed(&needed, found).at_line(line)
}

fn table(bytes: &[u8], span: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let (first, rest) = first_line(&bytes[span.bytes.clone()]);
    let count = count_of(first).unwrap_or(0);
    let (comment, rows) = first_line(rest);
    let text = word(comment);
    let properties = property(&text, "Properties");
    let mut layout = match properties {
        Some(properties) => {
            of_properties(properties).map_err(|flaw| flaw.at_line(span.line + 1))?
        }
        None => plain(first_line(rows).0),
    };
    for field in &mut layout {
        let wanted = request.wanted.wants(&field.name);
        if !wanted && !matches!(field.becomes, Becomes::Coordinate(_)) {
            field.becomes = Becomes::Nothing;
        }
    }
    let rows_of = Rows {
        separator: Separator::Blanks,
        mark: DecimalMark::Point,
        fields: layout,
        width: Width::AsNeeded,
        skips: None,
    };
    let found = memchr::memchr_iter(b'\n', rows).count()
        + usize::from(!rows.is_empty() && !rows.ends_with(b"\n"));
    if found < count {
        let end = rows.trim_ascii_end();
        let particles =
            if end.is_empty() { 0 } else { memchr::memchr_iter(b'\n', end).count() + 1 };
        let found = format!("the end of the file after {particles}");
        let flaw =
            Flaw::needed(&counted(count, "particle"), found).at_line(span.line + 2 + particles);
        return Err(if looks_like_particle(comment) {
            flaw.or(format!("line {} is the comment, and looks like a particle", span.line + 1))
        } else {
            flaw
        });
    }
    let mut table = rows_of.read(rows, span.line + 2)?;
    table.cell = cell(&text);
    if properties.is_some() {
        notes.read("columns as its Properties say");
    }
    if text.trim_start().starts_with("Atoms. Timestep") {
        notes.read("the first column has LAMMPS' types, not elements");
        for column in table.columns.iter_mut().filter(|column| column.name == "species") {
            "type".clone_into(&mut column.name);
        }
    }
    Ok(table)
}

/// `species x y z`, and nothing of what follows; or `x y z`.
fn plain(first: &[u8]) -> Vec<Field> {
    let mut fields = fields(first);
    let bare = fields.clone().count() == 3 && fields.all(is_number);
    let species = Field { name: "species".to_owned(), becomes: Becomes::Word };
    let position = ["x", "y", "z"]
        .into_iter()
        .enumerate()
        .map(|(axis, name)| Field { name: name.to_owned(), becomes: Becomes::Coordinate(axis) });
    (!bare).then_some(species).into_iter().chain(position).collect()
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
            let quote = value.chars().next().filter(|first| matches!(first, '"' | '\'' | '{'));
            let end = |c: char| match quote {
                Some('{') => c == '}',
                Some(quote) => c == quote,
                None => c.is_whitespace(),
            };
            let value = &value[quote.map_or(0, char::len_utf8)..];
            return Some(value.split(end).next().unwrap_or_default());
        }
        from = at + key.len();
    }
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

/// The cell of `Lattice="ax ay az bx by bz cx cy cz"`, `Origin="x y z"` and `pbc="T T F"`.
fn cell(comment: &str) -> Option<Cell> {
    let numbers = |key: &str| -> Vec<f64> {
        let text = property(comment, key).unwrap_or_default();
        text.split([' ', ',', '\t'])
            .filter_map(|field| number(field.as_bytes(), DecimalMark::Point))
            .collect()
    };
    let lattice: [f64; 9] = numbers("Lattice").try_into().ok()?;
    let edge = |index: usize| DVec3::from_slice(&lattice[3 * index..]);
    let mut cell = Cell::new([edge(0), edge(1), edge(2)])?;
    if let Ok(origin) = <[f64; 3]>::try_from(numbers("Origin")) {
        cell.origin = DVec3::from_array(origin);
    }
    if let Some(periodic) = property(comment, "pbc") {
        let flags: Vec<bool> = periodic
            .split([' ', ',', '\t'])
            .filter(|flag| !flag.is_empty())
            .map(|flag| matches!(flag, "T" | "t" | "True" | "true" | "1"))
            .collect();
        cell.periodic = flags.try_into().unwrap_or([true; 3]);
    }
    Some(cell)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::table::Lines;

    fn read(text: &str) -> Result<Table, Flaw> {
        let spans = frames(text.as_bytes())?;
        table(text.as_bytes(), &spans[0], &Request::default(), &mut Notes::default())
    }

    fn refusal(text: &str) -> String {
        read(text).expect_err("refused").in_file("balls.xyz").to_string()
    }

    fn words(table: &Table, name: &str) -> Vec<String> {
        let column = table.column(name).expect("a column of that name");
        (0..table.len()).map(|index| column.values.text(index).into_owned()).collect()
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
        assert_eq!(read(&spans[1]).expect("legal").lines.get(1), Some(8));
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
