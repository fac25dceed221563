//! Words of a CIF file (International Tables for Crystallography G, chapter 2.2).

/// A word with what tells it from others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Token<'a> {
    /// Without quotes.
    pub(super) text: &'a [u8],
    /// Whether it was in quotes, or in lines between semicolons: it is a value whatever it says.
    pub(super) is_quoted: bool,
    pub(super) line: usize,
    /// The index of its first byte.
    pub(super) start: usize,
}

impl Token<'_> {
    /// Whether it is the name of a value.
    pub(super) fn is_key(&self) -> bool {
        !self.is_quoted && self.text.starts_with(b"_")
    }

    /// Whether it is a word of the format that begins so, in any capitals.
    pub(super) fn begins(&self, reserved: &[u8]) -> bool {
        let begin = self.text.get(..reserved.len());
        !self.is_quoted && begin.is_some_and(|begin| begin.eq_ignore_ascii_case(reserved))
    }

    /// Whether no value begins so.
    pub(super) fn is_reserved(&self) -> bool {
        const WORDS: [&[u8]; 5] = [b"loop_", b"data_", b"save_", b"stop_", b"global_"];
        self.is_key() || WORDS.iter().any(|word| self.begins(word))
    }
}

/// The words of a text, one after the other.
#[derive(Debug, Clone)]
pub(super) struct Tokens<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    /// For each sort of quotes the end of a line in which none ends any more.
    unclosed: [usize; 2],
}

impl<'a> Tokens<'a> {
    /// The words from an index on, which is on this line.
    pub(super) fn from(bytes: &'a [u8], at: usize, line: usize) -> Self {
        Self { bytes, at, line, unclosed: [0; 2] }
    }

    /// The index of the first byte that has not been read.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Goes past blanks and comments.
    fn skip(&mut self) {
        while let Some(byte) = self.bytes.get(self.at) {
            match byte {
                b'\n' => self.line += 1,
                b'#' => {
                    let rest = &self.bytes[self.at..];
                    self.at += memchr::memchr(b'\n', rest).unwrap_or(rest.len());
                    continue;
                }
                byte if byte.is_ascii_whitespace() => {}
                _ => return,
            }
            self.at += 1;
        }
    }

    /// Lines between semicolons; to the end of the text where the last one is missing.
    fn lines(&mut self) -> &'a [u8] {
        let text = &self.bytes[self.at + 1..];
        let end = memchr::memmem::find(text, b"\n;");
        let text = &text[..end.unwrap_or(text.len())];
        self.at += 1 + text.len() + if end.is_some() { 2 } else { 0 };
        self.line += memchr::memchr_iter(b'\n', text).count() + usize::from(end.is_some());
        text
    }

    /// What stands in quotes, which end with one before a blank, on the same line; `None` where they do
    /// not.
    fn quoted(&mut self, quote: u8) -> Option<&'a [u8]> {
        let unclosed = &mut self.unclosed[usize::from(quote == b'"')];
        if self.at < *unclosed {
            return None;
        }
        let rest = &self.bytes[self.at + 1..];
        let line = &rest[..memchr::memchr(b'\n', rest).unwrap_or(rest.len())];
        let ends = |at: &usize| line.get(at + 1).is_none_or(u8::is_ascii_whitespace);
        let Some(end) = memchr::memchr_iter(quote, line).find(ends) else {
            *unclosed = self.at + 1 + line.len();
            return None;
        };
        self.at += end + 2;
        Some(&line[..end])
    }

    fn bare(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }
}

impl<'a> Iterator for Tokens<'a> {
    type Item = Token<'a>;

    fn next(&mut self) -> Option<Token<'a>> {
        self.skip();
        let (start, line) = (self.at, self.line);
        let quoted = match *self.bytes.get(start)? {
            b';' if start == 0 || self.bytes[start - 1] == b'\n' => Some(self.lines()),
            quote @ (b'\'' | b'"') => self.quoted(quote),
            _ => None,
        };
        let text = quoted.unwrap_or_else(|| self.bare());
        Some(Token { text, is_quoted: quoted.is_some(), line, start })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<(String, usize)> {
        let tokens = Tokens::from(text.as_bytes(), 0, 1);
        let word = |token: Token<'_>| {
            let text = String::from_utf8_lossy(token.text).into_owned();
            (if token.is_quoted { format!("<{text}>") } else { text }, token.line)
        };
        tokens.map(word).collect()
    }

    #[test]
    fn words_are_bare_quoted_or_lines() {
        let text =
            "data_x # comment\n_a.b\t'O5''  \"a \"\"\n;line 1\n'line' 2\n;\nO5' a#b ''\n'open";
        let found = words(text);
        let expected = [
            ("data_x", 1),
            ("_a.b", 2),
            ("<O5'>", 2),
            ("<a \">", 2),
            ("<line 1\n'line' 2>", 3),
            ("O5'", 6),
            ("a#b", 6),
            ("<>", 6),
            ("'open", 7),
        ];
        let expected: Vec<(String, usize)> =
            expected.map(|(word, line)| (word.to_owned(), line)).to_vec();
        assert_eq!(found, expected);
        assert_eq!(words("\r\n;a\r\n;\r\nb"), [("<a\r>".to_owned(), 2), ("b".to_owned(), 4)]);
        assert_eq!(words(";never ends\n"), [("<never ends\n>".to_owned(), 1)]);
        assert_eq!(words("# only"), []);
    }

    #[test]
    fn quotes_that_do_not_end_are_looked_for_once() {
        // Looking for each one's end would take a minute.
        let words = "'a ".repeat(1 << 20);
        let tokens = Tokens::from(words.as_bytes(), 0, 1);
        assert_eq!(tokens.filter(|token| token.text == b"'a" && !token.is_quoted).count(), 1 << 20);
    }

    #[test]
    fn reserved_words_are_bare() {
        let reserved = |text: &str| {
            Tokens::from(text.as_bytes(), 0, 1).next().is_some_and(|token| token.is_reserved())
        };
        assert!(["LOOP_", "_a", "data_x", "Save_"].into_iter().all(reserved));
        assert!(!["'loop_'", "\"_a\"", "loop", "A_", ""].into_iter().any(reserved));
    }
}
