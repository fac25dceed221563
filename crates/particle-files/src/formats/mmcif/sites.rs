//! Where a CIF file has its atoms: a loop of `_atom_site`, or keys with one value each.

use super::tokens::{Token, Tokens};
use crate::cell::Cell;
use crate::formats::Span;
use crate::number::{DecimalMark, number};
use crate::text::first_line;

/// The atoms of a block.
#[derive(Debug)]
pub(super) struct Sites<'a> {
    /// Lower-case names of what stands in each column, without `_atom_site.` before them.
    pub(super) names: Vec<String>,
    pub(super) values: Values<'a>,
    pub(super) cell: Option<Cell>,
    /// Where the values are.
    pub(super) span: Span,
}

#[derive(Debug)]
pub(super) enum Values<'a> {
    /// Rows with a value for each name.
    Loop,
    /// One value for each name.
    One(Vec<Token<'a>>),
}

impl Sites<'_> {
    /// The column of a name.
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|own| own == name)
    }

    /// Whether atoms have coordinates of either kind.
    fn has_coordinates(&self) -> bool {
        let has = |names: [&str; 3]| names.iter().all(|name| self.column(name).is_some());
        has(CARTESIAN) || has(FRACTIONAL)
    }
}

pub(super) const CARTESIAN: [&str; 3] = ["cartn_x", "cartn_y", "cartn_z"];
pub(super) const FRACTIONAL: [&str; 3] = ["fract_x", "fract_y", "fract_z"];

/// The atoms of all blocks that have some.
pub(super) fn sites(bytes: &[u8]) -> Vec<Sites<'_>> {
    let mut all = Vec::new();
    let mut block = Block::default();
    let mut tokens = Tokens::from(bytes, 0, 1);
    while let Some(token) = tokens.next() {
        if token.begins(b"data_") {
            all.extend(std::mem::take(&mut block).ended());
        } else if token.begins(b"loop_") {
            if let Some(sites) = of_loop(bytes, &mut tokens) {
                block.sites.push(sites);
            }
        } else if token.is_key() {
            let value = tokens.clone().next().filter(|value| !value.is_reserved());
            if let Some(value) = value {
                tokens.next();
                block.add(token, value, tokens.at());
            }
        }
    }
    all.extend(block.ended());
    all
}

/// A block while it is read.
#[derive(Debug, Default)]
struct Block<'a> {
    sites: Vec<Sites<'a>>,
    /// Keys of `_atom_site` with one value each, and where they are.
    names: Vec<String>,
    values: Vec<Token<'a>>,
    span: Option<Span>,
    /// Lengths and angles.
    cell: [Option<f64>; 6],
}

impl<'a> Block<'a> {
    fn add(&mut self, key: Token<'a>, value: Token<'a>, end: usize) {
        const CELL: [&str; 6] =
            ["length_a", "length_b", "length_c", "angle_alpha", "angle_beta", "angle_gamma"];
        if let Some(name) = name_in(b"_atom_site", key.text) {
            self.names.push(name);
            self.values.push(value);
            let span = self.span.get_or_insert(Span { bytes: key.start..end, line: key.line });
            span.bytes.end = end;
        } else if let Some(name) = name_in(b"_cell", key.text)
            && let Some(index) = CELL.iter().position(|own| *own == name)
        {
            self.cell[index] = value_number(value.text);
        }
    }

    /// The atoms of the block, with its cell.
    fn ended(mut self) -> Vec<Sites<'a>> {
        if let Some(span) = self.span {
            let values = Values::One(self.values);
            let sites = Sites { names: self.names, values, cell: None, span };
            self.sites.extend(sites.has_coordinates().then_some(sites));
        }
        let [a, b, c, alpha, beta, gamma] = self.cell;
        // Angles that are not given are right.
        let angles = [alpha, beta, gamma].map(|angle| angle.unwrap_or(90.0));
        let lengths = a.zip(b).zip(c).map(|((a, b), c)| [a, b, c]);
        // A cube of one ångström stands for no cell.
        let lengths = lengths.filter(|lengths| *lengths != [1.0; 3]);
        let cell = lengths.and_then(|lengths| Cell::of_lengths_and_angles(lengths, angles));
        self.sites.iter_mut().for_each(|sites| sites.cell = cell);
        self.sites
    }
}

/// A number with or without its uncertainty: `1.234(5)`.
pub(super) fn value_number(text: &[u8]) -> Option<f64> {
    let end = text.iter().position(|byte| *byte == b'(').unwrap_or(text.len());
    number(&text[..end], DecimalMark::Point)
}

/// What follows a category's name in a key: `_atom_site.Cartn_x`, or `_atom_site_Cartn_x` in the older
/// form.
fn name_in(category: &[u8], key: &[u8]) -> Option<String> {
    let (begin, name) = key.split_at_checked(category.len())?;
    let name = name.strip_prefix(b".").or_else(|| name.strip_prefix(b"_"))?;
    let is_named = begin.eq_ignore_ascii_case(category);
    is_named.then(|| String::from_utf8_lossy(name).to_ascii_lowercase())
}

/// The atoms of a loop whose names come next, if it is one of atoms; goes past it then.
fn of_loop<'a>(bytes: &'a [u8], tokens: &mut Tokens<'a>) -> Option<Sites<'a>> {
    let mut names = Vec::new();
    let mut next = tokens.clone();
    let first = loop {
        let token = next.next()?;
        if !token.is_key() {
            break token;
        }
        *tokens = next.clone();
        names.push(name_in(b"_atom_site", token.text).unwrap_or_default());
    };
    let span = Span { bytes: first.start..first.start, line: first.line };
    let mut sites = Sites { names, values: Values::Loop, cell: None, span };
    if first.is_reserved() || !sites.has_coordinates() {
        return None;
    }
    *tokens = end_of_rows(bytes, first.start, first.line);
    sites.span.bytes.end = tokens.at();
    Some(sites)
}

/// The words from the first line on that begins with none of a row.
fn end_of_rows(bytes: &[u8], start: usize, line: usize) -> Tokens<'_> {
    let mut rest = &bytes[start..];
    let mut number = line;
    while !rest.is_empty() {
        let at = bytes.len() - rest.len();
        let (line, behind) = first_line(rest);
        let begin = line.trim_ascii_start().first().copied();
        let is_line_start = at == 0 || bytes[at - 1] == b'\n';
        if begin == Some(b';') && is_line_start && line.starts_with(b";") {
            let mut tokens = Tokens::from(bytes, at, number);
            let text = tokens.next();
            number += text.map_or(0, |text| memchr::memchr_iter(b'\n', text.text).count() + 1);
            rest = &bytes[tokens.at()..];
            continue;
        }
        let may_end = matches!(begin, Some(b'_' | b'l' | b'L' | b'd' | b'D' | b's' | b'S'));
        if may_end && Tokens::from(line, 0, 1).next().is_some_and(|token| token.is_reserved()) {
            return Tokens::from(bytes, at, number);
        }
        rest = behind;
        number += 1;
    }
    Tokens::from(bytes, bytes.len(), number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Vec<(Vec<String>, String, usize, bool)> {
        let found = sites(text.as_bytes()).into_iter();
        let values = |sites: &Sites<'_>| text[sites.span.bytes.clone()].trim_end().to_owned();
        found
            .map(|sites| {
                (sites.names.clone(), values(&sites), sites.span.line, sites.cell.is_some())
            })
            .collect()
    }

    #[test]
    fn loops_and_keys_of_atoms_are_found() {
        let names = ["cartn_x", "cartn_y", "cartn_z", "id"].map(str::to_owned).to_vec();
        let keys = "_atom_site.Cartn_x\n_ATOM_SITE.CARTN_Y\n_atom_site_Cartn_z _atom_site.id\n";
        let rows = "0 0 0 1\n;1\n_no.key\n; 1 1 2 # comment\n\n2 2 2\nloop 4";
        let text = format!(
            "data_a\n_cell.length_a 2(1)\nloop_\n_b.c\n1 2\nLOOP_ {keys}{rows}\n_z.z 1\n_cell_length_b 2\n_cell.length_c 3"
        );
        assert_eq!(found(&text), [(names.clone(), rows.to_owned(), 9, true)]);
        let pairs = "data_a _atom_site.Cartn_x 1 _atom_site.Cartn_y 2\n_atom_site.Cartn_z 3 _atom_site.id '_4'";
        let values = pairs["data_a ".len()..].to_owned();
        assert_eq!(found(pairs), [(names.clone(), values, 1, false)]);
        let two =
            format!("data_a loop_ {keys} 0 0 0 1\ndata_b loop_ {keys} 0 0 0 1\ndata_c _x.y 1");
        assert_eq!(found(&two).len(), 2);
        for none in [
            "",
            "data_a",
            &format!("data_a loop_ {keys}"),
            "loop_ _atom_site.Cartn_x 1 2",
            "_atom_site.Cartn_x",
        ] {
            assert!(found(none).is_empty(), "{none}");
        }
    }

    #[test]
    fn cells_that_say_nothing_are_none() {
        let cell = |cell: &str| {
            let text = format!(
                "{cell}\nloop_ _atom_site.fract_x _atom_site.fract_y _atom_site.fract_z 0 0 0"
            );
            sites(text.as_bytes())[0].cell.map(|cell| cell.edges[2].z)
        };
        let lengths = "_cell.length_a 2 _cell.length_b 3 _cell.length_c 4.0(2)";
        assert_eq!(cell(lengths), Some(4.0));
        assert_eq!(cell(&lengths.replace(['2', '3', '4'], "?")), None);
        assert_eq!(cell("_cell.length_a 1 _cell.length_b 1.0 _cell.length_c 1.000"), None);
        assert_eq!(cell(&format!("{lengths} _cell.angle_beta 200")), None);
    }
}
