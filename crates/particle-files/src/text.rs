//! Bytes as text, whatever program wrote them.

use std::borrow::Cow;

use crate::error::Flaw;
use crate::notes::Notes;

/// Text with lines that end in `\n` or `\r\n`, in an encoding that has ASCII in it: without a byte order
/// mark, recoded from UTF-16, with a `\n` for each `\r` that stands alone. Bytes that are no UTF-8 stay:
/// [`word`] reads them as Latin-1.
pub(crate) fn decoded<'a>(bytes: Cow<'a, [u8]>, notes: &mut Notes) -> Result<Cow<'a, [u8]>, Flaw> {
    let bytes = match Encoding::of(&bytes) {
        Encoding::Utf16 { mark, order } => {
            notes.read("its text is UTF-16");
            recoded(&bytes[mark..], order)?.into()
        }
        Encoding::MarkedUtf8 => match bytes {
            Cow::Borrowed(bytes) => Cow::Borrowed(&bytes[3..]),
            Cow::Owned(mut bytes) => {
                bytes.drain(..3);
                bytes.into()
            }
        },
        Encoding::Other => bytes,
    };
    if let Some(at) = memchr::memchr(0, &bytes) {
        let line = 1 + memchr::memchr_iter(b'\n', &bytes[..at]).count();
        let needed = "text, or what begins as a binary format of those that are read";
        return Err(Flaw::needed(needed, "a byte 0").at_line(line));
    }
    if std::str::from_utf8(&bytes).is_err() {
        notes.read("its text is not UTF-8 and is taken as Latin-1");
    }
    Ok(with_line_feeds(bytes))
}

enum Encoding {
    /// UTF-16, after a mark of so many bytes.
    Utf16 {
        mark: usize,
        order: fn([u8; 2]) -> u16,
    },
    MarkedUtf8,
    Other,
}

impl Encoding {
    /// By the byte order mark, or by the zero bytes of ASCII in UTF-16.
    fn of(bytes: &[u8]) -> Self {
        match bytes {
            [0xef, 0xbb, 0xbf, ..] => Self::MarkedUtf8,
            [0xff, 0xfe, ..] => Self::Utf16 { mark: 2, order: u16::from_le_bytes },
            [0xfe, 0xff, ..] => Self::Utf16 { mark: 2, order: u16::from_be_bytes },
            [1..=127, 0, 1..=127, 0, ..] => Self::Utf16 { mark: 0, order: u16::from_le_bytes },
            [0, 1..=127, 0, 1..=127, ..] => Self::Utf16 { mark: 0, order: u16::from_be_bytes },
            _ => Self::Other,
        }
    }
}

fn recoded(bytes: &[u8], order: fn([u8; 2]) -> u16) -> Result<Vec<u8>, Flaw> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    if !rest.is_empty() {
        return Err(Flaw::needed("UTF-16 text of whole characters", "an odd number of bytes"));
    }
    let text: Result<String, _> =
        char::decode_utf16(pairs.iter().map(|pair| order(*pair))).collect();
    let text = text.map_err(|error| Flaw::needed("UTF-16 text", error))?;
    Ok(text.into_bytes())
}

/// Old programs end lines with `\r` alone.
fn with_line_feeds(bytes: Cow<'_, [u8]>) -> Cow<'_, [u8]> {
    let alone = |at: usize| bytes.get(at + 1) != Some(&b'\n');
    let alone: Vec<usize> = memchr::memchr_iter(b'\r', &bytes)
        .filter(|at| alone(*at) && at + 1 < bytes.len())
        .collect();
    if alone.is_empty() {
        return bytes;
    }
    let mut bytes = bytes.into_owned();
    alone.into_iter().for_each(|at| bytes[at] = b'\n');
    bytes.into()
}

/// The lines of a text with their numbers, the first of which is given; without their ends.
pub(crate) fn lines(bytes: &[u8], first: usize) -> impl Iterator<Item = (usize, &[u8])> + Clone {
    Lines { bytes, number: first }
}

#[derive(Clone)]
struct Lines<'a> {
    bytes: &'a [u8],
    number: usize,
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.bytes.is_empty() {
            return None;
        }
        let (line, rest) = first_line(self.bytes);
        let number = self.number;
        self.bytes = rest;
        self.number += 1;
        Some((number, line))
    }
}

/// A text's first line without its end, and what follows it.
pub(crate) fn first_line(bytes: &[u8]) -> (&[u8], &[u8]) {
    let (line, rest) = match memchr::memchr(b'\n', bytes) {
        Some(end) => (&bytes[..end], &bytes[end + 1..]),
        None => (bytes, &[][..]),
    };
    (line.strip_suffix(b"\r").unwrap_or(line), rest)
}

/// The fields of a line with blanks and tabs between them.
pub(crate) fn fields(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    line.split(u8::is_ascii_whitespace).filter(|field| !field.is_empty())
}

/// Bytes as words: UTF-8, or else Latin-1.
pub(crate) fn word(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

/// The bytes as UTF-8 text.
pub(crate) fn utf8(bytes: &[u8]) -> Result<&str, Flaw> {
    std::str::from_utf8(bytes).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        Flaw::needed("UTF-8 text", "other bytes").at_line(line)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decode(bytes: &[u8]) -> Result<Vec<u8>, Flaw> {
        decoded(bytes.into(), &mut Notes::default()).map(Cow::into_owned)
    }

    fn utf16(text: &str, order: fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(order).collect()
    }

    #[test]
    fn every_encoding_gives_the_same_lines() {
        let text = "1\nÅ\n".as_bytes();
        for bytes in [
            text.to_vec(),
            "\u{feff}1\nÅ\n".into(),
            utf16("\u{feff}1\nÅ\n", u16::to_le_bytes),
            utf16("\u{feff}1\nÅ\n", u16::to_be_bytes),
            utf16("1\nÅ\n", u16::to_le_bytes),
            utf16("1\nÅ\n", u16::to_be_bytes),
            "1\rÅ\r".into(),
            "1\r\nÅ\r\n".into(),
            b"1\n\xc5\n".to_vec(),
        ] {
            let read = decode(&bytes).expect("legal");
            let words: Vec<_> = lines(&read, 1).map(|(_, line)| word(line).into_owned()).collect();
            assert_eq!(words, ["1", "Å"], "{bytes:?}");
        }
    }

    #[test]
    fn what_is_no_text_is_refused() {
        assert_eq!(decode(b"one\ntwo\0").expect_err("refused").location.line, Some(2));
        assert!(decode(b"\xff\xfea").expect_err("refused").problem.contains("UTF-16"));
        assert!(decode(b"\xff\xfe\x00\xd8").expect_err("refused").problem.contains("UTF-16"));
        assert_eq!(utf8(b"one\ntwo\n\xff").expect_err("refused").location.line, Some(3));
    }

    #[test]
    fn lines_are_numbered() {
        let all: Vec<_> = lines(b"a\r\n\nb", 7).collect();
        assert_eq!(all, [(7, &b"a"[..]), (8, b""), (9, b"b")]);
        assert_eq!(fields(b" a\tb  c ").collect::<Vec<_>>(), [b"a", b"b", b"c"]);
    }
}
