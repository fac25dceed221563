//! Lines of a PDB file: what they are, and the columns of those that say an atom.
//!
//! Coordinates have eight columns each, from column 31 on, mostly with three decimals. Where programs have
//! moved a whole line, the points of three such numbers still stand eight columns apart: that says where
//! the columns are. What fits in no way is refused, never skipped.

use std::borrow::Cow;

use glam::DVec3;

use crate::atom_names::is_known_residue;
use crate::error::Flaw;
use crate::number::{DecimalMark, number};
use crate::text::{fields, word};

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Atom,
    /// A model begins.
    Model,
    /// A model, or a frame, ends.
    End,
    Other,
}

/// The index of a column, counted from 0, after which coordinates begin.
const X: usize = 30;
/// Columns of a coordinate.
const WIDTH: usize = 8;
/// The index behind the last coordinate.
const BEHIND: usize = X + 3 * WIDTH;

const WAY_OUT: &str = "the atoms of a PDB file have x, y and z in columns 31 to 54: write them there, or save \
                       the file as mmCIF or XYZ";

/// What a line is, by its first word.
///
/// # Errors
/// Where it may be an atom, but its first word is another.
pub(crate) fn kind(line: &[u8]) -> Result<Kind, Flaw> {
    let start = line.trim_ascii_start();
    let Some(first) = start.first() else { return Ok(Kind::Other) };
    match first.to_ascii_uppercase() {
        b'A' | b'H' if starts_with_atom(start) => {
            let is_exact = line.starts_with(b"ATOM") || line.starts_with(b"HETATM");
            return Ok(if is_exact || has_numbers(start) { Kind::Atom } else { Kind::Other });
        }
        b'E' | b'M' | b'T' => no_atom_inside(line)?,
        _ => {}
    }
    if has_word(start, b"MODEL") {
        return Ok(Kind::Model);
    }
    if has_word(start, b"ENDMDL") || has_word(start, b"END") {
        return Ok(Kind::End);
    }
    if has_coordinates(line) && !is_known(line) {
        let found = word(&line[..line.len().min(6)]).into_owned();
        let needed = "ATOM or HETATM before three coordinates";
        return Err(Flaw::needed(needed, format_args!("{found:?}")).at_column(1));
    }
    Ok(Kind::Other)
}

/// Whether three numbers of eight columns each stand somewhere.
fn has_coordinates(line: &[u8]) -> bool {
    memchr::memchr_iter(b'.', line).any(|point| point >= 4 && columns_at(line, point - 4))
}

fn starts_with_atom(start: &[u8]) -> bool {
    let begins =
        |name: &[u8]| start.get(..name.len()).is_some_and(|s| s.eq_ignore_ascii_case(name));
    begins(b"HETATM") || (begins(b"ATOM") && !start.get(4).is_some_and(u8::is_ascii_alphabetic))
}

/// Whether a line begins with a word, and no longer one.
fn has_word(start: &[u8], name: &[u8]) -> bool {
    start.get(..name.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(name))
        && !start.get(name.len()).is_some_and(u8::is_ascii_alphabetic)
}

/// Whether there are three decimal numbers, or stars in place of them.
pub(crate) fn has_numbers(line: &[u8]) -> bool {
    let is_decimal = |pair: &[u8]| pair[0] == b'.' && pair[1].is_ascii_digit();
    line.windows(2).filter(|pair| is_decimal(pair)).count() >= 3
        || line.windows(4).any(|four| four == b"****")
}

/// Whether such a line begins an atom of a PDB file, however well.
pub(crate) fn is_atom(line: &[u8]) -> bool {
    let start = line.trim_ascii_start();
    let is_exact = line.starts_with(b"ATOM  ") || line.starts_with(b"HETATM");
    is_exact || (starts_with_atom(start) && has_numbers(start))
}

/// Lines run together where an end of line was lost.
fn no_atom_inside(line: &[u8]) -> Result<(), Flaw> {
    let inside =
        [&b"ATOM  "[..], b"HETATM"].iter().find_map(|name| memchr::memmem::find(line, name));
    match inside.filter(|at| has_numbers(&line[*at..])) {
        Some(at) => {
            Err(Flaw::needed("one record in a line", "an atom behind another record")
                .at_column(at + 1))
        }
        None => Ok(()),
    }
}

/// Records that may have numbers where atoms have coordinates.
fn is_known(line: &[u8]) -> bool {
    const KNOWN: [&[u8]; 12] = [
        b"REMARK", b"SIGATM", b"ANISOU", b"SIGUIJ", b"ORIGX", b"SCALE", b"MTRIX", b"CRYST1",
        b"TITLE", b"USER", b"HETNAM", b"JRNL",
    ];
    KNOWN.iter().any(|name| line.get(..name.len()).is_some_and(|s| s.eq_ignore_ascii_case(name)))
}

/// A line that says an atom, in its columns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AtomLine<'a> {
    text: Cow<'a, [u8]>,
    pub(crate) position: DVec3,
    /// Whether the columns of the file are others.
    pub(crate) is_moved: bool,
}

impl<'a> AtomLine<'a> {
    /// Reads a line of the kind [`Kind::Atom`].
    pub(crate) fn read(line: &'a [u8]) -> Result<Self, Flaw> {
        if line.len() > 80 {
            no_atom_inside(&line[BEHIND..])?;
        }
        let is_plain = line.is_ascii() && line.get(27..X) == Some(b"   ");
        if let Some(position) = fixed_position(line).filter(|_| is_plain && line[0] > b' ') {
            return Ok(Self { text: line.into(), position, is_moved: false });
        }
        let text = without_tabs(line);
        let moved = in_columns(&text).ok_or_else(|| flaw(&text))?;
        let position = position(&moved).ok_or_else(|| flaw(&text))?;
        Ok(Self { is_moved: moved[..] != text[..], text: moved.into(), position })
    }

    /// What stands in these columns, counted from 1, without the blanks around it; nothing behind the end
    /// of the line.
    pub(crate) fn columns(&self, from: usize, to: usize) -> &[u8] {
        self.untrimmed(from, to).trim_ascii()
    }

    fn untrimmed(&self, from: usize, to: usize) -> &[u8] {
        self.text.get(from - 1..to.min(self.text.len())).unwrap_or_default()
    }

    /// Whether it ends within the coordinates.
    pub(crate) fn ends_early(&self) -> bool {
        self.text.len() < BEHIND
    }

    /// What follows the coordinates.
    pub(crate) fn behind(&self) -> &[u8] {
        self.text.get(BEHIND..).unwrap_or_default()
    }

    /// How many letters the element has by the columns of the name: symbols end in column 14.
    pub(crate) fn letters(&self) -> usize {
        if self.untrimmed(13, 13).iter().any(u8::is_ascii_alphabetic) { 2 } else { 1 }
    }

    /// The residue's name, and its chain. A letter between them may belong to either.
    pub(crate) fn residue_and_chain(&self) -> (&[u8], &[u8]) {
        let (short, long) = (self.columns(18, 20), self.columns(18, 21));
        let has_long_chain = self.untrimmed(21, 22).iter().all(u8::is_ascii_alphanumeric)
            && !is_known_residue(&word(long))
            && is_known_residue(&word(short));
        match has_long_chain {
            true => (short, self.columns(21, 22)),
            false => (long, self.columns(22, 22)),
        }
    }

    /// The residue's number, and what tells residues of one number apart.
    pub(crate) fn residue_number(&self) -> (&[u8], &[u8]) {
        match self.untrimmed(27, 27) {
            // Numbers above 9999 run over.
            [digit] if digit.is_ascii_digit() => (self.columns(23, 27), b""),
            _ => (self.columns(23, 26), self.columns(27, 27)),
        }
    }
}

/// Whether three numbers with three decimals stand from this index on.
fn columns_at(line: &[u8], at: usize) -> bool {
    (0..3).all(|axis| {
        let start = at + WIDTH * axis;
        line.get(start..start + WIDTH).is_some_and(|field| fixed(field).is_some())
    })
}

fn fixed_position(line: &[u8]) -> Option<DVec3> {
    let line = line.get(..BEHIND)?;
    Some(DVec3::new(fixed(&line[30..38])?, fixed(&line[38..46])?, fixed(&line[46..54])?))
}

/// A number in eight columns with three decimals: `%8.3f`.
fn fixed(field: &[u8]) -> Option<f64> {
    let [whole @ .., b'.', tenths, hundredths, thousandths] = field else { return None };
    let whole = whole.trim_ascii_start();
    let (is_negative, digits) = match whole {
        [b'-', digits @ ..] => (true, digits),
        digits => (false, digits),
    };
    let mut number = 0_u32;
    for byte in digits.iter().chain([tenths, hundredths, thousandths]) {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            return None;
        }
        number = 10 * number + u32::from(digit);
    }
    // Both are exact, so that their quotient is the double nearest to the decimal number.
    let magnitude = f64::from(number) / 1000.0;
    Some(if is_negative { -magnitude } else { magnitude })
}

/// The coordinates of a line in its columns; what is not in one column of numbers is none.
fn position(line: &[u8]) -> Option<DVec3> {
    if let Some(position) = fixed_position(line) {
        return Some(position);
    }
    let mut position = DVec3::ZERO;
    for axis in 0..3 {
        let (start, end) = (X + WIDTH * axis, (X + WIDTH * (axis + 1)).min(line.len()));
        let field = line.get(start..end)?;
        position[axis] = number(field, DecimalMark::Point).filter(|number| number.is_finite())?;
        // Without three decimals nothing says that a number does not go on in the next columns.
        let goes_on = |index: usize| {
            let blank = |index: usize| line.get(index).is_none_or(|byte| *byte == b' ');
            !blank(index - 1) && !blank(index)
        };
        if goes_on(start) || goes_on(end) {
            return None;
        }
    }
    Some(position)
}

/// The line with a byte for each character, and blanks for tabs, which end at multiples of eight.
fn without_tabs(line: &[u8]) -> Vec<u8> {
    let mut text = Vec::with_capacity(line.len());
    for character in word(line).chars() {
        match character {
            '\t' => text.resize((text.len() + 8) / 8 * 8, b' '),
            blank if blank.is_whitespace() => text.push(b' '),
            character => text.push(u8::try_from(character).unwrap_or(b'?').min(b'~')),
        }
    }
    text
}

/// The line with all in its columns; `None` where that is uncertain.
fn in_columns(text: &[u8]) -> Option<Vec<u8>> {
    let starts = 0..text.len().saturating_sub(3 * WIDTH - 1);
    let mut found = starts.filter(|start| columns_at(text, *start) && is_alone(text, *start));
    let start = match (found.next(), found.next()) {
        (Some(start), None) => start,
        (None, _) if fits(text, X) => X,
        _ => return None,
    };
    if start == X && fits(text, X) {
        return Some(text.to_vec());
    }
    let behind = &text[start..];
    if fits(text, start) {
        return Some([b"ATOM        ", &text[start - 18..start], behind].concat());
    }
    Some([&head(&text[..start])?[..], behind].concat())
}

/// Whether no digit of another number touches the coordinates that begin here.
fn is_alone(text: &[u8], start: usize) -> bool {
    let before = text.get(start.wrapping_sub(1)).is_none_or(|byte| *byte == b' ');
    before && !text.get(start + 3 * WIDTH).is_some_and(u8::is_ascii_digit)
}

/// Whether name, residue and its number stand where they do if x begins here.
fn fits(text: &[u8], x: usize) -> bool {
    let Some((before, columns)) =
        text.get(..x).and_then(|text| text.split_at_checked(x.wrapping_sub(18)))
    else {
        return false;
    };
    let is_word = |from: usize, to: usize| {
        let word = columns[from..to].trim_ascii();
        !word.is_empty() && !word.contains(&b' ')
    };
    let number = columns[10..15].trim_ascii();
    is_word(0, 4)
        && columns[5..9].trim_ascii().iter().all(|byte| *byte != b' ')
        && !number.contains(&b' ')
        && number.iter().all(|byte| byte.is_ascii_alphanumeric() || *byte == b'-' || *byte == b'*')
        && columns[15..].iter().all(|byte| *byte == b' ')
        && before.last() == Some(&b' ')
        && fields(before).count() <= 2
        && !columns.contains(&b'.')
}

/// The columns before x of a line whose words stand elsewhere: serial number, name, residue, chain or
/// none, number of the residue.
fn head(words: &[u8]) -> Option<Vec<u8>> {
    let words = words.trim_ascii_start();
    let record = if words[..4].eq_ignore_ascii_case(b"ATOM") { 4 } else { 6 };
    let words: Vec<&[u8]> = fields(&words[record..]).collect();
    let (name, residue, chain, number) = match words[..] {
        [_, name, residue, number] => match number {
            [chain @ b'A'..=b'Z', number @ ..] if !number.is_empty() => {
                (name, residue, *chain, number)
            }
            number => (name, residue, b' ', number),
        },
        [_, name, residue, [chain], number] => (name, residue, *chain, number),
        _ => return None,
    };
    let (number, insertion) = match number {
        [number @ .., letter @ b'A'..=b'Z'] => (number, *letter),
        number => (number, b' '),
    };
    let is_number = std::str::from_utf8(number).is_ok_and(|text| text.parse::<i32>().is_ok());
    let is_letters = |word: &[u8]| word.iter().any(u8::is_ascii_alphabetic);
    if !is_number || name.len() > 4 || residue.len() > 4 || !is_letters(name) || number.len() > 5 {
        return None;
    }
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (name, residue, number) = (text(name), text(residue), text(number));
    let chain = char::from(chain);
    let number = match number.len() {
        5 => number,
        _ => format!("{number:>4}{}", char::from(insertion)),
    };
    // In column 14 a name says that its element has one letter, which is most likely.
    let name = if name.len() < 4 { format!(" {name}") } else { name };
    Some(format!("ATOM        {name:<4} {residue:<4}{chain}{number}   ").into_bytes())
}

/// What is wrong with the coordinates of a line.
fn flaw(text: &[u8]) -> Flaw {
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let (start, end) = (X + WIDTH * axis, X + WIDTH * (axis + 1));
        let field = text.get(start.min(text.len())..end.min(text.len())).unwrap_or_default();
        if number(field, DecimalMark::Point).is_none_or(|number| !number.is_finite()) {
            let needed = format!("a finite number in columns {} to {end}", start + 1);
            let found = word(field).into_owned();
            let flaw = Flaw::needed(&needed, format_args!("{found:?}"));
            return flaw.at_column(start + 1).at_key(name).or(WAY_OUT);
        }
    }
    let found = word(text.get(..BEHIND).unwrap_or(text)).into_owned();
    let needed = "name, residue and coordinates in columns 13 to 54";
    Flaw::needed(needed, format_args!("{found:?}")).or(WAY_OUT)
}
