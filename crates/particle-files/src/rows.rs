//! Rows of fields, a particle in each: what CSV, XYZ and LAMMPS files have in common. Large texts are
//! read by all threads.

use glam::DVec3;
use rayon::prelude::*;

use crate::error::Flaw;
use crate::notes::counted;
use crate::number::{DecimalMark, number};
use crate::table::{Column, Lines, Table, Values, Words};
use crate::text::{self, lines, word};

/// How rows are read.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    pub(crate) separator: Separator,
    pub(crate) mark: DecimalMark,
    /// For each field of a row what becomes of it.
    pub(crate) fields: Vec<Field>,
    /// How many fields a row may have.
    pub(crate) width: Width,
    /// Whether empty lines, and those that start with one of these bytes, are no rows.
    pub(crate) skips: Option<&'static [u8]>,
}

/// A field of a row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Field {
    /// As errors and columns call it.
    pub(crate) name: String,
    pub(crate) becomes: Becomes,
}

/// What becomes of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Becomes {
    Nothing,
    /// A coordinate: 0 for x, 1 for y, 2 for z.
    Coordinate(usize),
    /// A number of a column.
    Number,
    /// A word of a column.
    Word,
}

/// What stands between fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Separator {
    /// Blanks and tabs, any number.
    Blanks,
    /// One byte; fields may be in double quotes.
    Byte(u8),
}

/// How many fields a row may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Width {
    /// Those that become something; others are not looked at.
    AsNeeded,
    /// All, or one more if it is empty: programs end rows by a separator.
    Exactly,
}

/// A part of a table that one thread reads.
struct Part {
    positions: Vec<DVec3>,
    values: Vec<Values>,
    lines: Lines,
}

/// Bytes that a thread reads before it takes more.
const CHUNK: usize = 1 << 20;

impl Rows {
    /// The particles of a text's rows, the first of which stands on this line of the file.
    pub(crate) fn read(&self, bytes: &[u8], first_line: usize) -> Result<Table, Flaw> {
        let chunks = chunks(bytes, first_line, CHUNK);
        let mut parts: Vec<Result<Part, Flaw>> =
            chunks.par_iter().map(|(bytes, line)| self.part(bytes, *line)).collect();
        // The first flaw of the file, whichever thread found one first.
        let mut table = Table::default();
        let rows = parts.iter().flatten().map(|part| part.positions.len()).sum();
        table.positions.reserve_exact(rows);
        let mut values: Option<Vec<Values>> = None;
        for part in parts.drain(..) {
            let part = part?;
            table.lines.append(table.positions.len(), &part.lines, part.positions.len());
            table.positions.extend_from_slice(&part.positions);
            match &mut values {
                None => values = Some(part.values),
                Some(values) => {
                    values.iter_mut().zip(part.values).for_each(|(all, more)| all.append(more));
                }
            }
        }
        let values = values.unwrap_or_else(|| self.empty());
        let names = self.columns().map(|(_, field)| field.name.clone());
        table.columns = names.zip(values).map(|(name, values)| Column { name, values }).collect();
        Ok(table)
    }

    /// The fields that become columns, with where they stand in a row.
    fn columns(&self) -> impl Iterator<Item = (usize, &Field)> {
        let becomes_column =
            |field: &Field| matches!(field.becomes, Becomes::Number | Becomes::Word);
        self.fields.iter().enumerate().filter(move |(_, field)| becomes_column(field))
    }

    fn empty(&self) -> Vec<Values> {
        let values = |(_, field): (usize, &Field)| match field.becomes {
            Becomes::Word => Values::Words(Words::default()),
            _ => Values::Numbers(Vec::new()),
        };
        self.columns().map(values).collect()
    }

    fn part(&self, bytes: &[u8], first_line: usize) -> Result<Part, Flaw> {
        let mut part =
            Part { positions: Vec::new(), values: self.empty(), lines: Lines::default() };
        let mut fields = Vec::new();
        for (number, line) in lines(bytes, first_line) {
            let start = line.trim_ascii_start();
            if self.skips.is_some_and(|marks| start.first().is_none_or(|byte| marks.contains(byte)))
            {
                continue;
            }
            if self.skips.is_some() && self.is_empty_row(start) {
                continue;
            }
            fields.clear();
            self.split(line, &mut fields).map_err(|flaw| flaw.at_line(number))?;
            self.row(&fields, &mut part).map_err(|flaw| flaw.at_line(number))?;
            part.lines.push(part.positions.len() - 1, number);
        }
        Ok(part)
    }

    /// Whether a line has separators only, as spreadsheets end their tables.
    fn is_empty_row(&self, line: &[u8]) -> bool {
        let Separator::Byte(separator) = self.separator else { return false };
        let is_nothing = |byte: &u8| *byte == separator || byte.is_ascii_whitespace();
        line.first() == Some(&separator) && line.iter().all(is_nothing)
    }

    /// The fields of a line.
    pub(crate) fn split<'a>(&self, line: &'a [u8], into: &mut Vec<&'a [u8]>) -> Result<(), Flaw> {
        match self.separator {
            Separator::Blanks => into.extend(text::fields(line)),
            Separator::Byte(separator) => split_quoted(line, separator, into)?,
        }
        Ok(())
    }

    fn row(&self, fields: &[&[u8]], part: &mut Part) -> Result<(), Flaw> {
        self.check_width(fields)?;
        let mut position = DVec3::ZERO;
        let mut column = 0;
        for (index, field) in self.fields.iter().enumerate() {
            let found = fields.get(index).copied().unwrap_or_default();
            match field.becomes {
                Becomes::Nothing => continue,
                Becomes::Coordinate(axis) => {
                    let number = number(found, self.mark).filter(|number| number.is_finite());
                    position[axis] = number.ok_or_else(|| self.no_number(index, found))?;
                    continue;
                }
                Becomes::Number => {
                    let number = number(found, self.mark);
                    let number = number.or(found.trim_ascii().is_empty().then_some(f64::NAN));
                    let number = number.ok_or_else(|| self.no_number(index, found))?;
                    if let Values::Numbers(numbers) = &mut part.values[column] {
                        numbers.push(number);
                    }
                }
                Becomes::Word => {
                    if let Values::Words(words) = &mut part.values[column] {
                        let found = word(found.trim_ascii());
                        match self.separator {
                            Separator::Byte(_) if found.contains('"') => {
                                words.push(&found.replace("\"\"", "\""));
                            }
                            _ => words.push(&found),
                        }
                    }
                }
            }
            column += 1;
        }
        part.positions.push(position);
        Ok(())
    }

    fn check_width(&self, fields: &[&[u8]]) -> Result<(), Flaw> {
        if self.width == Width::AsNeeded {
            return Ok(());
        }
        let (needed, found) = (self.fields.len(), fields.len());
        let behind = fields.get(needed..).unwrap_or_default();
        if found < needed || behind.iter().any(|field| !field.trim_ascii().is_empty()) {
            let expected = format!("{} as in the first line", counted(needed, "field"));
            let flaw = Flaw::needed(&expected, found);
            let is_comma = self.separator == Separator::Byte(b',');
            return Err(if is_comma && found > needed {
                flaw.or("if its numbers have a decimal comma, write ; between fields")
            } else {
                flaw
            });
        }
        Ok(())
    }

    fn no_number(&self, index: usize, found: &[u8]) -> Flaw {
        let shown = word(found.trim_ascii());
        let flaw = Flaw::needed("a finite number", format_args!("{shown:?}"));
        let flaw = flaw.at_column(index + 1).at_key(&self.fields[index].name);
        match self.mark {
            DecimalMark::Point if number(found, DecimalMark::Comma).is_some_and(f64::is_finite) => {
                flaw.or("a decimal comma is read where ; or a tab stands between fields")
            }
            _ if has_thousands(&shown) => flaw.or("write numbers without separators of thousands"),
            _ => flaw,
        }
    }
}

/// Whether a text is a number but for points, commas, blanks or apostrophes before three digits.
fn has_thousands(text: &str) -> bool {
    let is_separator = |c: char| ".,' \u{a0}\u{2019}\u{202f}".contains(c);
    let digits = text.trim_start_matches(['-', '+']);
    let mut groups = digits.split(is_separator);
    let is_digits = |group: &str| !group.is_empty() && group.bytes().all(|b| b.is_ascii_digit());
    groups.next().is_some_and(|first| first.len() <= 3 && is_digits(first))
        && groups.next().is_some_and(|group| group.len() == 3)
        && digits.split(is_separator).all(is_digits)
}

/// Fields with one byte between them, in double quotes or not. A quote within quotes is written twice;
/// such a field is handed on as it is written.
fn split_quoted<'a>(line: &'a [u8], separator: u8, into: &mut Vec<&'a [u8]>) -> Result<(), Flaw> {
    let mut rest = line;
    loop {
        let start = rest.trim_ascii_start();
        if let Some(quoted) = start.strip_prefix(b"\"") {
            let end = closing_quote(quoted).ok_or_else(|| {
                Flaw::needed("a field that ends on its line", "a quote that does not end")
            })?;
            into.push(&quoted[..end]);
            match memchr::memchr(separator, &quoted[end + 1..]) {
                Some(at) => rest = &quoted[end + 2 + at..],
                None => return Ok(()),
            }
            continue;
        }
        match memchr::memchr(separator, rest) {
            Some(at) => {
                into.push(&rest[..at]);
                rest = &rest[at + 1..];
            }
            None => {
                into.push(rest);
                return Ok(());
            }
        }
    }
}

fn closing_quote(quoted: &[u8]) -> Option<usize> {
    let mut from = 0;
    loop {
        let at = from + memchr::memchr(b'"', &quoted[from..])?;
        if quoted.get(at + 1) != Some(&b'"') {
            return Some(at);
        }
        from = at + 2;
    }
}

/// The text in pieces of whole lines, each with the number of its first line.
pub(crate) fn chunks(bytes: &[u8], first_line: usize, size: usize) -> Vec<(&[u8], usize)> {
    let mut pieces = Vec::new();
    let mut rest = bytes;
    while !rest.is_empty() {
        let end = memchr::memchr(b'\n', rest.get(size..).unwrap_or_default());
        let (piece, behind) = rest.split_at(end.map_or(rest.len(), |end| size + end + 1));
        pieces.push(piece);
        rest = behind;
    }
    let counts: Vec<usize> =
        pieces.par_iter().map(|piece| memchr::memchr_iter(b'\n', piece).count()).collect();
    let mut line = first_line;
    let numbered = pieces.into_iter().zip(counts).map(|(piece, count)| {
        let first = line;
        line += count;
        (piece, first)
    });
    numbered.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Rows {
        let field = |name: &str, becomes| Field { name: name.to_owned(), becomes };
        Rows {
            separator: Separator::Byte(b','),
            mark: DecimalMark::Point,
            fields: vec![
                field("x", Becomes::Coordinate(0)),
                field("what", Becomes::Word),
                field("y", Becomes::Coordinate(1)),
                field("z", Becomes::Coordinate(2)),
                field("mass", Becomes::Number),
            ],
            width: Width::Exactly,
            skips: Some(b"#"),
        }
    }

    #[test]
    fn fields_become_positions_and_columns() {
        let text = b"1,a,2,3,4\n\n# no row\n5, \"b,c\" ,6,7,\n,,,,\n , ,,,\r\n";
        let table = rows().read(text, 2).expect("legal");
        assert_eq!(table.positions, [DVec3::new(1.0, 2.0, 3.0), DVec3::new(5.0, 6.0, 7.0)]);
        assert_eq!(table.lines, Lines::Each(vec![2, 5]));
        let words = table.column("WHAT").map(|column| &column.values);
        assert_eq!(words, Some(&Values::Words(["a", "b,c"].into_iter().collect())));
        let Some(Values::Numbers(masses)) = table.column("mass").map(|column| &column.values)
        else {
            panic!("needed numbers");
        };
        assert!(masses[0] == 4.0 && masses[1].is_nan());
    }

    #[test]
    fn flaws_are_the_first_of_the_file_and_located() {
        let good = "1,a,2,3,4\n".repeat(CHUNK / 4);
        let text = format!("{good}1,a,x,3,4\n{good}1,a\n");
        let flaw = rows().read(text.as_bytes(), 1).expect_err("refused");
        assert_eq!(flaw.location.line, Some(CHUNK / 4 + 1));
        assert_eq!((flaw.location.column, flaw.location.key.as_deref()), (Some(3), Some("y")));
        let problem = |text: &str| rows().read(text.as_bytes(), 1).expect_err("refused").problem;
        assert!(problem("1,a,2,3\n").contains("needed 5 fields"));
        assert!(problem(",a,,,\n").contains("a finite number"));
        assert!(problem("1,a,\"2,5\",3,4\n").contains("decimal comma"));
        assert!(problem("1,a,2,3,4,5\n").contains("decimal comma"));
        assert!(problem("1,\"a,2,3,4\n").contains("quote"));
    }

    #[test]
    fn separators_of_thousands_are_named() {
        for text in ["1.234,5", "1,234.5", "-1'234.5", "12 345,6", "1.234.567", "1\u{2019}000"] {
            assert!(has_thousands(text), "{text}");
        }
        for text in ["1.5", "1,25,5", "1234,500", "a.123", "", "-", "1..234", "1.2345,6"] {
            assert!(!has_thousands(text), "{text}");
        }
        let flaw = rows().read(b"1,a,\"1,234.5\",3,4\n", 1).expect_err("refused");
        assert!(flaw.problem.ends_with("without separators of thousands"), "{}", flaw.problem);
    }

    #[test]
    fn chunks_are_whole_lines_with_their_numbers() {
        let text = b"a\nbb\n\nccc";
        let found: Vec<(&[u8], usize)> = vec![(b"a\n", 5), (b"bb\n", 6), (b"\nccc", 7)];
        assert_eq!(chunks(text, 5, 1), found);
        assert_eq!(chunks(text, 5, 100), [(&text[..], 5)]);
        assert!(chunks(b"", 1, 10).is_empty());
    }
}
