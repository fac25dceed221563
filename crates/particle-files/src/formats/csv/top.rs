//! The beginning of a table: its names, and where its rows begin.

use super::{is_comment, units};
use crate::error::Flaw;
use crate::formats::Request;
use crate::notes::{Notes, counted};
use crate::number::{DecimalMark, number};
use crate::roles::Role;
use crate::rows::{Rows, Separator, Width};
use crate::text::{lines, word};

/// Lines that are searched for names, where the first is none of a table.
const SEARCHED: usize = 100;

/// More columns than this no table has.
const MOST_COLUMNS: usize = 100_000;

/// The first lines of a table.
pub(super) struct Top<'a> {
    /// The first line of the table, with its number: of names or a row.
    pub(super) first: Option<(usize, &'a [u8])>,
    /// The last comment before it.
    comment: Option<(usize, &'a [u8])>,
    /// Number of lines before it that are neither comments nor of the table.
    before: usize,
}

/// The names of a table's columns, and where its rows are.
pub(super) struct Header {
    pub(super) names: Vec<String>,
    /// The number of the line of names; that of the first row where there is none.
    pub(super) line: usize,
    /// The number of the line from which on there are rows.
    pub(super) first_row: usize,
    pub(super) separator: Separator,
}

impl<'a> Top<'a> {
    pub(super) fn of(bytes: &'a [u8]) -> Self {
        let mut comment = None;
        let mut others = Vec::new();
        for (number, line) in lines(bytes, 1) {
            let line = line.trim_ascii();
            if line.starts_with(b"#") || line.starts_with(b"%") || line.starts_with(b"//") {
                if others.is_empty() {
                    comment = Some((number, line));
                }
            } else if !line.is_empty() {
                others.push((number, line));
                if is_of_table(line) || others.len() > SEARCHED {
                    break;
                }
            }
        }
        let is_named = others.len() > 1 && others.last().is_some_and(|(_, line)| names_place(line));
        let (first, before) =
            if is_named { (others.last(), others.len() - 1) } else { (others.first(), 0) };
        Self { first: first.copied(), comment, before }
    }

    pub(super) fn separator(&self) -> Separator {
        let line = self.first.map(|(_, line)| line).unwrap_or_default();
        separator_of(line)
    }

    /// The names that the last comment has, if coordinates are among them, as many as there are fields.
    pub(super) fn named_by_comment(&self) -> Option<(usize, Vec<String>)> {
        let (number, comment) = self.comment?;
        let text = comment.trim_ascii_start();
        let marks = text.iter().take_while(|byte| b"#%/".contains(byte)).count();
        let text = text[marks..].trim_ascii();
        let names = columns(text, separator_of(text));
        let axes = names.iter().take(MOST_COLUMNS).filter(|name| axis_of(name).is_some()).count();
        (axes >= 3).then_some((number, names))
    }

    /// The names: those asked for, or of a line, or of a comment, or of the first three columns.
    pub(super) fn header(
        &self,
        bytes: &[u8],
        request: &Request,
        notes: &mut Notes,
    ) -> Result<Header, Flaw> {
        let Some((line, first)) = self.first else {
            return Err(Flaw::needed("a line of names, then a particle in each line", "no line"));
        };
        if self.before > 0 {
            notes.left_out(format!("{} before the names", counted(self.before, "line")));
        }
        let separator = self.separator();
        let found = columns(first, separator);
        if found.len() > MOST_COLUMNS {
            let needed = format!("at most {MOST_COLUMNS} fields in a line");
            return Err(Flaw::needed(&needed, "more").at_line(line));
        }
        let rest = super::offset_of(bytes, line + 1);
        let row = sample(&bytes[rest..], separator);
        let has_names = !found.iter().all(|field| field.is_empty() || number_of(field).is_some());
        let counts = (!has_names && are_counted(&found, &row)).then(|| counted_names(&found));
        let behind = if has_names || counts.is_some() { line + 1 } else { line };
        let (mut names, line, mut first_row) = match (&request.names, counts) {
            (Some(names), _) => (names.clone(), line, behind),
            (None, Some(names)) => {
                notes.guessed(
                    "the first line counts the columns: 0, 1 and 2 are taken as x, y and z \
                     (--columns x,y,z,… says otherwise)",
                );
                (names, line, behind)
            }
            (None, None) if has_names => (found, line, behind),
            (None, None) => match self.named_by_comment() {
                Some((comment, names)) => (names, comment, behind),
                None => (unnamed(found.len(), notes), line, behind),
            },
        };
        if has_names && units::are_units(&row) {
            let units = sample_line(&bytes[rest..], line + 1);
            notes.read(format!("units in line {units}: {}", row.join(", ")));
            units::add(&mut names, &row);
            first_row = units + 1;
        }
        let rows = &bytes[super::offset_of(bytes, first_row)..];
        if request.names.is_none() && has_row_names(&names, rows, separator) {
            notes.read("names of rows before the columns that have names");
            names.insert(0, String::new());
        }
        Ok(Header { names, line, first_row, separator })
    }
}

/// Whether a line can be the first of a table: three numbers and more, or names of coordinates.
fn is_of_table(line: &[u8]) -> bool {
    begins_with_numbers(&columns(line, separator_of(line))) || names_place(line)
}

/// Whether the first three fields are numbers, behind one that may be empty.
pub(super) fn begins_with_numbers(columns: &[String]) -> bool {
    let empty = usize::from(columns.first().is_some_and(String::is_empty));
    let first: Vec<&String> = columns.iter().skip(empty).take(3).collect();
    first.len() == 3 && first.iter().all(|field| number_of(field).is_some())
}

/// Whether a line names x, y and z.
fn names_place(line: &[u8]) -> bool {
    let columns = columns(line, separator_of(line));
    let mut seen = [false; 3];
    let axes = columns.iter().take(MOST_COLUMNS).filter_map(|name| axis_of(name));
    axes.for_each(|axis| seen[axis] = true);
    seen == [true; 3]
}

/// Whether a line has the numbers of columns from 0 on, as of a table of pandas without names.
fn are_counted(found: &[String], row: &[String]) -> bool {
    let counted = found.iter().skip_while(|field| field.is_empty());
    let numbers = (0..).map(|number: usize| number.to_string());
    let is_whole = |field: &String| field.parse::<i64>().is_ok();
    found.len() >= 3
        && found.iter().filter(|field| field.is_empty()).count() <= 1
        && counted.zip(numbers).all(|(field, number)| *field == number)
        && row.len() == found.len()
        && !row.iter().all(is_whole)
}

fn counted_names(found: &[String]) -> Vec<String> {
    let name = |field: &String| match field.as_str() {
        "0" => "x".to_owned(),
        "1" => "y".to_owned(),
        "2" => "z".to_owned(),
        other => other.to_owned(),
    };
    found.iter().map(name).collect()
}

/// Whether rows have one field more than there are names, in quotes: R names rows so.
fn has_row_names(names: &[String], rows: &[u8], separator: Separator) -> bool {
    let first = lines(rows, 1).find(|(_, line)| !is_comment(line)).map(|(_, line)| line);
    first.is_some_and(|line| {
        line.trim_ascii_start().starts_with(b"\"")
            && columns(line, separator).len() == names.len() + 1
            && names.last().is_some_and(|name| !name.is_empty())
    })
}

/// The fields of the first row.
pub(super) fn sample(rows: &[u8], separator: Separator) -> Vec<String> {
    let first = lines(rows, 1).find(|(_, line)| !is_comment(line));
    first.map(|(_, line)| columns(line, separator)).unwrap_or_default()
}

/// The number of the line of the first row.
fn sample_line(rows: &[u8], first: usize) -> usize {
    let row = lines(rows, first).find(|(_, line)| !is_comment(line));
    row.map_or(first, |(number, _)| number)
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

pub(super) fn columns(line: &[u8], separator: Separator) -> Vec<String> {
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
    // One more than there may be tells that there are too many.
    let fields = fields.into_iter().take(MOST_COLUMNS + 1);
    fields.map(|field| word(field.trim_ascii()).into_owned()).collect()
}

pub(super) fn number_of(field: &str) -> Option<f64> {
    let read = |mark| number(field.as_bytes(), mark);
    read(DecimalMark::Point).or_else(|| read(DecimalMark::Comma))
}

pub(super) fn axis_of(name: &str) -> Option<usize> {
    Role::of(name)?.axis()
}
