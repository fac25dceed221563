//! Rows of the loop of atoms.

use std::collections::HashMap;
use std::ops::Range;

use super::sites::{Sites, Values};
use super::tokens::{Token, Tokens};
use crate::error::Flaw;
use crate::formats::Span;
use crate::formats::models::Model;
use crate::text::{first_line, lines};

/// Hands on the values of each row, one row after the other.
pub(super) fn for_each<'a>(
    bytes: &'a [u8],
    span: &Span,
    width: usize,
    mut row: impl FnMut(&[Token<'a>]) -> Result<(), Flaw>,
) -> Result<(), Flaw> {
    let rows = &bytes[..span.bytes.end];
    let mut values: Vec<Token<'a>> = Vec::with_capacity(width);
    for token in Tokens::from(rows, span.bytes.start, span.line) {
        if token.is_reserved() {
            break;
        }
        values.push(token);
        if values.len() == width {
            row(&values)?;
            values.clear();
        }
    }
    match values.first() {
        None => Ok(()),
        Some(first) => Err(broken_line(bytes, span, width)
            .unwrap_or_else(|| too_few(width, values.len(), first.line))),
    }
}

/// The same for lines that are a row each. `Ok(false)` as soon as one is not, which says nothing of
/// rows.
pub(super) fn for_each_line(
    bytes: &[u8],
    first: usize,
    width: usize,
    mut row: impl FnMut(&[Token<'_>]) -> Result<(), Flaw>,
) -> Result<bool, Flaw> {
    let mut values = Vec::with_capacity(width);
    for (number, line) in lines(bytes, first) {
        values.clear();
        values.extend(Tokens::from(line, 0, number));
        if values.is_empty() {
            continue;
        }
        let is_row = values.len() == width && line[0] != b';';
        if !is_row || values.iter().any(Token::is_reserved) {
            return Ok(false);
        }
        row(&values)?;
    }
    Ok(true)
}

/// The first line that is no row, where the one that begins the rows is: values are missing, or there are
/// too many.
pub(super) fn broken_line(bytes: &[u8], span: &Span, width: usize) -> Option<Flaw> {
    let mut rows = lines(&bytes[span.bytes.clone()], span.line)
        .map(|(number, line)| (number, Tokens::from(line, 0, number).count()))
        .filter(|(_, count)| *count > 0);
    let (_, first) = rows.next()?;
    let (line, found) = rows.find(|(_, count)| *count != width).filter(|_| first == width)?;
    Some(too_few(width, found, line))
}

fn too_few(width: usize, found: usize, line: usize) -> Flaw {
    Flaw::needed(&format!("{width} values for each atom, one for each key"), found).at_line(line)
}

/// The models of the atoms, by their column of models; all are one where there is none.
pub(super) fn models(bytes: &[u8], sites: &Sites<'_>) -> Result<Vec<Model>, Flaw> {
    let mut models = Models::default();
    match (sites.column("pdbx_pdb_model_num"), &sites.values) {
        (None, _) => models.add(b"", sites.span.bytes.clone(), sites.span.line),
        (Some(column), Values::One(values)) => {
            models.add(values[column].text, sites.span.bytes.clone(), sites.span.line);
        }
        (Some(column), Values::Loop) => {
            let width = sites.names.len();
            let rows = &bytes[..sites.span.bytes.end];
            for_each(rows, &sites.span, width, |row| {
                // The line that follows is still within the rows.
                let start = row[0].start;
                let last = row[width - 1].start;
                let (_, behind) = first_line(&rows[last..]);
                models.add(row[column].text, start..rows.len() - behind.len(), row[0].line);
                Ok(())
            })?;
        }
    }
    Ok(models.all)
}

/// Models while their rows are found.
#[derive(Debug, Default)]
struct Models<'a> {
    all: Vec<Model>,
    index_of: HashMap<&'a [u8], usize>,
    last: Option<(&'a [u8], usize)>,
}

impl<'a> Models<'a> {
    fn add(&mut self, name: &'a [u8], row: Range<usize>, line: usize) {
        let index = match self.last {
            Some((last, index)) if last == name => index,
            _ => *self.index_of.entry(name).or_insert(self.all.len()),
        };
        self.last = Some((name, index));
        if index == self.all.len() {
            let number = std::str::from_utf8(name).ok().and_then(|text| text.parse().ok());
            self.all.push(Model { span: Span { bytes: row.clone(), line }, number });
        }
        self.all[index].span.bytes.end = row.end;
    }
}
