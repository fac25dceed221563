//! Results as JSON.

use std::io::{self, Write};
use std::path::Path;

use anyhow::Context;
use picture_files::write_atomically;
use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::Formatter;

/// Writes a file of JSON, for people too, whole or not at all.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_json(path: &Path, value: &impl Serialize) -> anyhow::Result<()> {
    let mut text = serde_json::to_string_pretty(value)
        .with_context(|| format!("no JSON for {}", path.display()))?;
    text.push('\n');
    Ok(write_atomically(path, text.as_bytes())?)
}

/// As [`write_json`], for long lists of small things: each of them has a line to itself.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_json_lines(path: &Path, value: &impl Serialize) -> anyhow::Result<()> {
    let mut text = Vec::new();
    value
        .serialize(&mut Serializer::with_formatter(&mut text, Lines::default()))
        .with_context(|| format!("no JSON for {}", path.display()))?;
    text.push(b'\n');
    Ok(write_atomically(path, &text)?)
}

/// Lists and objects in lists stay on one line.
#[derive(Default)]
struct Lines {
    depth: usize,
}

impl Lines {
    /// Members of the whole and of its lists, this deep, have a line each.
    const DEEPEST: usize = 2;

    fn open<W: ?Sized + Write>(&mut self, writer: &mut W, bracket: u8) -> io::Result<()> {
        self.depth += 1;
        writer.write_all(&[bracket])
    }

    fn close<W: ?Sized + Write>(&mut self, writer: &mut W, bracket: u8) -> io::Result<()> {
        self.depth -= 1;
        if self.depth < Self::DEEPEST {
            Self::new_line(writer, self.depth)?;
        }
        writer.write_all(&[bracket])
    }

    fn part<W: ?Sized + Write>(&self, writer: &mut W, is_first: bool) -> io::Result<()> {
        let is_deep = self.depth > Self::DEEPEST;
        match (is_first, is_deep) {
            (true, true) => {}
            (false, true) => writer.write_all(b", ")?,
            (true, false) => Self::new_line(writer, self.depth)?,
            (false, false) => {
                writer.write_all(b",")?;
                Self::new_line(writer, self.depth)?;
            }
        }
        Ok(())
    }

    fn new_line<W: ?Sized + Write>(writer: &mut W, depth: usize) -> io::Result<()> {
        writer.write_all(b"\n")?;
        (0..depth).try_for_each(|_| writer.write_all(b"  "))
    }
}

impl Formatter for Lines {
    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open(writer, b'[')
    }

    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b']')
    }

    fn begin_array_value<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.part(writer, first)
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open(writer, b'{')
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b'}')
    }

    fn begin_object_key<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.part(writer, first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn things_in_lists_have_a_line_each() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("lines.json");
        let value = serde_json::json!({"a": [{"b": 1, "c": [2, 3]}, {"b": 4}], "d": [], "e": {}});
        write_json_lines(&path, &value).expect("written");
        let text = fs::read_to_string(&path).expect("readable");
        assert!(
            text.contains("\n    {\"b\": 1, \"c\": [2, 3]},\n    {\"b\": 4}\n  ],\n"),
            "{text}"
        );
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).expect("JSON"), value);
    }
}
