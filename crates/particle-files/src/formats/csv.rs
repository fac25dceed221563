//! Tables: rows of fields, mostly below a line of names.
//!
//! Commas, semicolons, tabs or blanks stand between fields. Lines before the names that start with `#`,
//! `%` or `//` are comments, but the last of them has the names where it names coordinates. Without
//! names the first three columns are x, y and z.

use super::{Reader, Request, Span};
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::number::{DecimalMark, number};
use crate::roles::Role;
use crate::rows::{Becomes, Field, Rows, Separator, Width};
use crate::table::Table;
use crate::text::{lines, word};

pub(super) const READER: Reader = Reader {
    name: "CSV",
    endings: &["csv", "tsv", "txt", "dat"],
    is_text: true,
    recognizes,
    frames: |bytes| Ok(vec![Span::whole(bytes)]),
    table,
};

/// Bytes that start a comment.
const COMMENT: &[u8] = b"#%";

/// Whether the first line that is no comment has at least three fields: names, or numbers.
fn recognizes(bytes: &[u8]) -> bool {
    let top = Top::of(bytes);
    let Some((_, line)) = top.first else { return false };
    let columns = columns(line, top.separator());
    let are_numbers = columns.iter().take(3).all(|column| number_of(column).is_some());
    columns.len() >= 3 && (are_numbers || columns.iter().any(|name| axis_of(name).is_some()))
        || top.named_by_comment().is_some()
}

/// Reads a table.
fn table(bytes: &[u8], _: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let top = Top::of(bytes);
    let Some((line, first)) = top.first else {
        return Err(Flaw::needed("a line of names, then a particle in each line", "no line"));
    };
    let separator = top.separator();
    let found = columns(first, separator);
    let has_names = !found.iter().all(|field| field.is_empty() || number_of(field).is_some());
    let (names, line_of_names, first_row) = match &request.names {
        Some(names) => (names.clone(), line, if has_names { line + 1 } else { line }),
        None if has_names => (found, line, line + 1),
        None => match top.named_by_comment() {
            Some((comment, names)) => (names, comment, line),
            None => (unnamed(found.len(), notes), line, line),
        },
    };
    let rows_at = offset_of(bytes, first_row);
    let sample = lines(&bytes[rows_at..], first_row).find(|(_, line)| !is_comment(line));
    let sample = sample.map(|(_, line)| columns(line, separator)).unwrap_or_default();
    let mark = decimal_mark(separator, &sample);
    let mut fields =
        fields(&names, &sample, mark, request).map_err(|flaw| flaw.at_line(line_of_names))?;
    // A name behind the last separator is no column.
    if fields.len() > 3 && names.last().is_some_and(String::is_empty) {
        fields.pop();
    }
    let mut rows = Rows { separator, mark, fields, width: Width::Exactly, skips: Some(COMMENT) };
    let table = loop {
        match rows.read(&bytes[rows_at..], first_row) {
            Err(flaw) if becomes_words(&mut rows, &flaw) => {}
            read => break read?,
        }
    };
    let between = match separator {
        Separator::Byte(b',') => "commas",
        Separator::Byte(b';') => "semicolons",
        Separator::Byte(_) => "tabs",
        Separator::Blanks => "blanks",
    };
    let comma = if mark == DecimalMark::Comma { ", decimal commas" } else { "" };
    notes.read(format!("{} between {} in a row{comma}", between, counted(names.len(), "field")));
    let ignored = rows.fields.iter().filter(|field| field.becomes == Becomes::Nothing);
    let ignored: Vec<&str> =
        ignored.map(|field| field.name.as_str()).filter(|name| !name.is_empty()).collect();
    if !ignored.is_empty() {
        notes.left_out(format!("columns not used: {}", ignored.join(", ")));
    }
    Ok(table)
}

/// The beginning of a table.
struct Top<'a> {
    /// The first line that is no comment, with its number.
    first: Option<(usize, &'a [u8])>,
    /// The last comment before it.
    comment: Option<(usize, &'a [u8])>,
}

impl<'a> Top<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let mut comment = None;
        for (number, line) in lines(bytes, 1) {
            let line = line.trim_ascii();
            if line.starts_with(b"#") || line.starts_with(b"%") || line.starts_with(b"//") {
                comment = Some((number, line));
            } else if !line.is_empty() {
                return Self { first: Some((number, line)), comment };
            }
        }
        Self { first: None, comment }
    }

    fn separator(&self) -> Separator {
        let line = self.first.map(|(_, line)| line).unwrap_or_default();
        separator_of(line)
    }

    /// The names that the last comment has, if coordinates are among them, as many as there are fields.
    fn named_by_comment(&self) -> Option<(usize, Vec<String>)> {
        let (number, comment) = self.comment?;
        let text = comment.trim_ascii_start();
        let marks = text.iter().take_while(|byte| b"#%/".contains(byte)).count();
        let text = text[marks..].trim_ascii();
        let names = columns(text, separator_of(text));
        let axes = names.iter().filter(|name| axis_of(name).is_some()).count();
        (axes >= 3).then_some((number, names))
    }
}

/// What stands between the fields of a line.
fn separator_of(line: &[u8]) -> Separator {
    let has = |byte: u8| memchr::memchr(byte, line).is_some();
    if has(b';') {
        return Separator::Byte(b';');
    }
    if has(b'\t') {
        return Separator::Byte(b'\t');
    }
    // Numbers with decimal commas and blanks between them have blanks in their "fields".
    let by_comma = columns(line, Separator::Byte(b','));
    let with_blanks =
        |field: &String| number_of(field).is_none() && field.split_ascii_whitespace().count() > 1;
    let starts_number =
        line.first().is_some_and(|byte| byte.is_ascii_digit() || b"+-.".contains(byte));
    if has(b',') && !(starts_number && by_comma.iter().any(with_blanks)) {
        return Separator::Byte(b',');
    }
    Separator::Blanks
}

/// Whether the numbers of a row have a decimal comma.
fn decimal_mark(separator: Separator, sample: &[String]) -> DecimalMark {
    let is_comma = |field: &String| {
        field.contains(',') && number(field.as_bytes(), DecimalMark::Comma).is_some()
    };
    if separator != Separator::Byte(b',') && sample.iter().any(is_comma) {
        DecimalMark::Comma
    } else {
        DecimalMark::Point
    }
}

fn columns(line: &[u8], separator: Separator) -> Vec<String> {
    let rows = Rows {
        separator,
        mark: DecimalMark::Point,
        fields: Vec::new(),
        width: Width::AsNeeded,
        skips: None,
    };
    let mut fields = Vec::new();
    // A quote that does not end is found again where the line is read as a row.
    let _ = rows.split(line, &mut fields);
    fields.into_iter().map(|field| word(field.trim_ascii()).into_owned()).collect()
}

fn number_of(field: &str) -> Option<f64> {
    let read = |mark| number(field.as_bytes(), mark);
    read(DecimalMark::Point).or_else(|| read(DecimalMark::Comma))
}

fn axis_of(name: &str) -> Option<usize> {
    Role::of(name)?.axis()
}

/// Names for the columns of a table without names.
fn unnamed(count: usize, notes: &mut Notes) -> Vec<String> {
    let behind =
        if count > 3 { format!("; {} behind them not used", count - 3) } else { String::new() };
    notes.guessed(format!(
        "no line of names: the first three columns are taken as x, y, z{behind} \
         (--columns x,y,z,… says otherwise)"
    ));
    let more = (4..=count).map(|number| format!("column {number}"));
    ["x", "y", "z"].map(str::to_owned).into_iter().chain(more).collect()
}

fn fields(
    names: &[String],
    sample: &[String],
    mark: DecimalMark,
    request: &Request,
) -> Result<Vec<Field>, Flaw> {
    let mut seen = [false; 3];
    let mut fields: Vec<Field> = Vec::with_capacity(names.len());
    for (index, name) in names.iter().enumerate() {
        let role = Role::of(name);
        let again = role.is_some() && names[..index].iter().any(|other| Role::of(other) == role);
        if again && role.is_some_and(Role::makes_balls) {
            let flaw = Flaw::needed("each column once", format_args!("{name:?} again"));
            return Err(flaw.at_column(index + 1));
        }
        let sampled = sample.get(index).map_or(b"0".as_slice(), |field| field.as_bytes());
        let wanted = !name.is_empty() && request.wanted.wants(name);
        let becomes = match role.and_then(Role::axis) {
            Some(axis) => {
                seen[axis] = true;
                Becomes::Coordinate(axis)
            }
            None if !wanted => Becomes::Nothing,
            None if role.is_some_and(Role::is_word) => Becomes::Word,
            None if role.is_some() => Becomes::Number,
            None if sampled.is_empty() || number(sampled, mark).is_some() => Becomes::Number,
            None => Becomes::Word,
        };
        fields.push(Field { name: name.clone(), becomes });
    }
    if let Some(missing) = seen.iter().position(|seen| !seen) {
        let axis = ["x", "y", "z"][missing];
        let needed = format!("a column {axis:?} in the line of names");
        let flaw = Flaw::needed(&needed, format_args!("{:?}", names.join(",")));
        return Err(flaw.or("name the columns with --columns, in their order"));
    }
    Ok(fields)
}

/// Whether the flaw is of a column that only looked like one of numbers, and is one of words from now on.
fn becomes_words(rows: &mut Rows, flaw: &Flaw) -> bool {
    let Some(column) = flaw.location.column else { return false };
    let Some(field) = rows.fields.get_mut(column - 1) else { return false };
    if field.becomes == Becomes::Number && Role::of(&field.name).is_none() {
        field.becomes = Becomes::Word;
        return true;
    }
    false
}

fn is_comment(line: &[u8]) -> bool {
    line.trim_ascii_start().first().is_none_or(|byte| COMMENT.contains(byte))
}

/// Where a line begins.
fn offset_of(bytes: &[u8], line: usize) -> usize {
    let ends = memchr::memchr_iter(b'\n', bytes);
    if line == 1 { 0 } else { ends.map(|end| end + 1).nth(line - 2).unwrap_or(bytes.len()) }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::formats::Wanted;
    use crate::table::{Lines, Values};

    fn read(text: &str) -> Result<Table, Flaw> {
        let request = Request { wanted: Wanted::Named(vec!["mass".into()]), ..Request::default() };
        table(text.as_bytes(), &Span::whole(b""), &request, &mut Notes::default())
    }

    fn refusal(text: &str) -> String {
        read(text).expect_err("refused").in_file("balls.csv").to_string()
    }

    fn words(table: &Table, name: &str) -> Vec<String> {
        let column = table.column(name).expect("a column of that name");
        (0..table.len()).map(|index| column.values.text(index).into_owned()).collect()
    }

    #[test]
    fn columns_come_in_any_order() {
        let text = "blue, radius,x,y,z,green,red,Strength\n1, 2,3,4,5,0.5,0,6\n";
        let table = read(text).expect("legal");
        assert_eq!(table.positions, [DVec3::new(3.0, 4.0, 5.0)]);
        assert_eq!(
            (words(&table, "radius"), words(&table, "strength")),
            (vec!["2".into()], vec!["6".into()])
        );
        assert_eq!(table.lines, Lines::From(2));
    }

    /// Each is the same two particles.
    #[test]
    fn tables_of_all_programs_are_read() {
        for text in [
            "x,y,z\n1.5,2,3\n-4,5,6\n",
            "x;y;z\r\n1,5;2;3\r\n-4;5;6\r\n",
            "x;y;z\n1.5;2;3\n-4;5;6\n",
            "x\ty\tz\n1,5\t2\t3\n-4\t5\t6\n",
            "x y z\n1.5 2 3\n -4  5\t6\n",
            "1.5 2 3\n-4 5 6\n",
            "1,5 2,0 3,0\n-4,0 5,0 6,0\n",
            "1.5, 2, 3\n-4, 5, 6",
            "# x y z\n1.5 2 3\n-4 5 6\n",
            "# made by hand\n# x, y, z\n1.5,2,3\n\n# no particle\n-4,5,6\n",
            "// a comment\nX, Y, Z,\n1.5, 2, 3,\n-4, 5, 6,\n",
            "\"Points:0\",\"Points:1\",\"Points:2\",\"Velocity:0\"\n1.5,2,3,9\n-4,5,6,9\n",
            "Pos.x [m];Pos.y [m];Pos.z [m];Idp\n1.5;2;3;0\n-4;5;6;1\n",
            ",x,y,z\n0,1.5,2,3\n1,-4,5,6\n",
            "id,x,y,z,what\n1,1.5D0,2,3,fluid\n2,-4,5,6.0e0,\"a, b\"\n",
            "what x y z\n1 1.5 2 3\nb -4 5 6\n",
        ] {
            let table = read(text).unwrap_or_else(|flaw| panic!("{text}: {flaw:?}"));
            let expected = [DVec3::new(1.5, 2.0, 3.0), DVec3::new(-4.0, 5.0, 6.0)];
            assert_eq!(table.positions, expected, "{text}");
            assert!(recognizes(text.as_bytes()), "{text}");
        }
    }

    #[test]
    fn names_can_be_given() {
        let read = |text: &str| {
            let names = ["x", "mass", "y", "z"].map(str::to_owned).to_vec();
            let request = Request { names: Some(names), ..Request::default() };
            table(text.as_bytes(), &Span::whole(b""), &request, &mut Notes::default())
        };
        for text in ["1,2,3,4\n", "a,b,c,d\n1,2,3,4\n"] {
            let table = read(text).expect("legal");
            assert_eq!(table.positions, [DVec3::new(1.0, 3.0, 4.0)]);
            assert_eq!(words(&table, "mass"), ["2"]);
        }
        assert!(read("1,2,3\n").is_err());
    }

    #[test]
    fn only_wanted_columns_are_kept() {
        let table = read("x,y,z,mass,other\n1,2,3,4,5\n").expect("legal");
        assert_eq!((table.columns.len(), words(&table, "mass")), (1, vec!["4".into()]));
    }

    #[test]
    fn no_rows_are_no_balls() {
        assert_eq!(read("x,y,z,radius\n").expect("legal").len(), 0);
    }

    #[test]
    fn refusals_name_line_and_column() {
        assert_eq!(
            refusal("x,y,z,radius\n1,2,3,4\n1,2,3,four\n"),
            "balls.csv, line 3, column 4 (radius): needed a finite number, found \"four\""
        );
        assert_eq!(
            refusal("x,y,radius\n"),
            "balls.csv, line 1: needed a column \"z\" in the line of names, found \"x,y,radius\"; name \
             the columns with --columns, in their order"
        );
        assert_eq!(
            refusal("x,y,z,radius\n\n1,2,3\n"),
            "balls.csv, line 3: needed 4 fields as in the first line, found 3"
        );
        assert!(refusal("x,x\n").contains("needed each column once, found \"x\" again"));
        assert!(refusal("x,y,z\n\"0,5\",\"0,1\",\"1,0\"\n").contains("decimal comma"));
        assert!(refusal("x,y,z\n1,nan,1\n").contains("found \"nan\""));
        assert!(refusal("").contains("needed a line of names"));
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            recognizes(&bytes);
            let _ = table(&bytes, &Span::whole(&bytes), &Request::default(), &mut Notes::default());
        }

        #[test]
        fn no_rows_panic(rows in "x[,;]y[,; ]z[,;]radius([,;]strength)?(,red,green,blue)?\n([-0-9.e,;\"\n]{0,40})") {
            let _ = read(&rows);
        }

        /// What a table says is what is read: f64 numbers print so that they read back exactly.
        #[test]
        fn tables_read_back(balls in prop::collection::vec(prop::array::uniform4(-1e6f64..1e6), 0..20)) {
            let rows: Vec<String> =
                balls.iter().map(|[x, y, z, radius]| format!("{radius},{x},{y},{z}\n")).collect();
            let table = read(&format!("radius,x,y,z\n{}", rows.concat())).expect("legal");
            let expected: Vec<_> = balls.iter().map(|&[x, y, z, _]| DVec3::new(x, y, z)).collect();
            prop_assert_eq!(table.positions, expected);
            let radii = Values::Numbers(balls.iter().map(|ball| ball[3]).collect());
            prop_assert_eq!(table.columns[0].values.clone(), radii);
        }
    }
}
