//! What a file says to its readers: comments, or all of a text.

/// A line of prose.
pub(crate) struct Line {
    /// Counted from 1.
    pub(crate) number: usize,
    pub(crate) text: String,
    /// Whether it stands in a fenced block of code.
    pub(crate) is_code: bool,
}

/// Whether a file has comments that are understood, or is a text.
pub(crate) fn is_known(file: &str) -> bool {
    [".rs", ".wgsl", ".toml", ".md"].iter().any(|ending| file.ends_with(ending))
}

/// The prose of a file.
pub(crate) fn of(file: &str, text: &str) -> Vec<Line> {
    let comments = if file.ends_with(".md") {
        text.to_owned()
    } else if file.ends_with(".toml") {
        comments_of_toml(text)
    } else {
        comments_of_rust(text)
    };
    // Text of a fence without a language is code in Rust's comments, and prose elsewhere.
    let plain_is_code = file.ends_with(".rs");
    let mut open: Option<bool> = None;
    let mut lines = Vec::new();
    for (index, line) in comments.lines().enumerate() {
        let line = line.trim();
        if let Some(language) = line.strip_prefix("```") {
            open = match open {
                Some(_) => None,
                None => Some(if language.is_empty() { plain_is_code } else { language != "text" }),
            };
        }
        if line.is_empty() && !file.ends_with(".md") {
            // A comment has ended.
            open = None;
        }
        let is_code = open.unwrap_or(false);
        lines.push(Line { number: index + 1, text: line.to_owned(), is_code });
    }
    lines
}

/// A text of as many lines with nothing but the comments in them. WGSL's are made as Rust's.
fn comments_of_rust(text: &str) -> String {
    let mut comments = String::new();
    let mut rest = text;
    // The next `length` bytes are taken, as a comment or not.
    let mut take = |rest: &mut &str, length: usize, is_comment: bool| {
        let (taken, left) = rest.split_at(length);
        if is_comment {
            comments.push_str(taken.trim_start_matches(['/', '!', '*']));
        } else {
            comments.extend(taken.chars().filter(|&letter| letter == '\n'));
        }
        *rest = left;
    };
    while let Some(letter) = rest.chars().next() {
        if rest.starts_with("//") {
            let end = rest.find('\n').unwrap_or(rest.len());
            take(&mut rest, end, true);
        } else if rest.starts_with("/*") {
            let end = rest.find("*/").map_or(rest.len(), |end| end + 2);
            take(&mut rest, end, true);
        } else if let Some(length) = string_length(rest) {
            take(&mut rest, length, false);
        } else if letter.is_alphanumeric() || letter == '_' {
            // A whole word, so that its last letter is not taken for a raw string's first.
            let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
            let end = rest.find(|letter| !is_word(letter)).unwrap_or(rest.len());
            take(&mut rest, end, false);
        } else {
            take(&mut rest, letter.len_utf8(), false);
        }
    }
    comments
}

/// Bytes of the literal string or character that a piece of Rust begins with.
fn string_length(text: &str) -> Option<usize> {
    let plain = text.strip_prefix('b').unwrap_or(text);
    let before = text.len() - plain.len();
    if let Some(raw) = plain.strip_prefix('r') {
        let hashes = raw.len() - raw.trim_start_matches('#').len();
        let inside = raw[hashes..].strip_prefix('"')?;
        let close = format!("\"{}", "#".repeat(hashes));
        let end = inside.find(&close).map_or(inside.len(), |end| end + close.len());
        return Some(before + 2 + hashes + end);
    }
    if let Some(inside) = plain.strip_prefix('"') {
        return Some(before + 1 + closed_by(inside, '"'));
    }
    let inside = plain.strip_prefix('\'')?;
    // A lifetime has no second quotation mark right behind its first letter.
    let mut letters = inside.chars();
    let is_character = letters.next() == Some('\\') || letters.next() == Some('\'');
    is_character.then(|| before + 1 + closed_by(inside, '\''))
}

/// Bytes up to and with a quotation mark that no backslash escapes.
fn closed_by(text: &str, mark: char) -> usize {
    let mut is_escaped = false;
    for (at, letter) in text.char_indices() {
        if letter == mark && !is_escaped {
            return at + 1;
        }
        is_escaped = letter == '\\' && !is_escaped;
    }
    text.len()
}

/// A text of as many lines with nothing but the comments in them.
fn comments_of_toml(text: &str) -> String {
    let mut comments = String::new();
    for line in text.lines() {
        let mut quoted_by = None;
        let comment = line.char_indices().find(|&(_, letter)| {
            match (quoted_by, letter) {
                (None, '"' | '\'') => quoted_by = Some(letter),
                (Some(mark), _) if mark == letter => quoted_by = None,
                (None, '#') => return true,
                _ => {}
            }
            false
        });
        comments += comment.map_or("", |(at, _)| line[at..].trim_start_matches('#'));
        comments.push('\n');
    }
    comments
}
