//! Output files appear whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

use anyhow::Context;
use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::Formatter;

/// Writes a file under a temporary name beside its place, then moves it there, so that a reader
/// never sees half a file and an interrupted run leaves the previous one. Makes missing folders.
///
/// # Errors
/// When the folder cannot be made or the file not be written; names the path.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let name = path.file_name().with_context(|| {
        format!("output: needed the path of a file, found \"{}\"", path.display())
    })?;
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;

    let temporary =
        folder.join(format!(".{}.{}.partial", name.to_string_lossy(), std::process::id()));
    let written = File::create(&temporary)
        .and_then(|mut file| {
            file.write_all(bytes)?;
            file.sync_all()
        })
        .and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        // The first error is the one to report; the leftover may well not exist.
        let _ = fs::remove_file(&temporary);
    }
    written.with_context(|| format!("cannot write {}", path.display()))
}

/// Writes a file of JSON, for people too, whole or not at all.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_json(path: &Path, value: &impl Serialize) -> anyhow::Result<()> {
    let mut text = serde_json::to_string_pretty(value)
        .with_context(|| format!("no JSON for {}", path.display()))?;
    text.push('\n');
    write_atomically(path, text.as_bytes())
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
    write_atomically(path, &text)
}

/// Lists and objects in lists stay on one line.
#[derive(Default)]
struct Lines {
    depth: usize,
}

impl Lines {
    /// What stands this deep has a line of its own: members of the whole, and of its lists.
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
pub(crate) mod tests {
    use std::path::PathBuf;

    use super::*;

    /// A folder of a test's own, empty at first.
    pub(crate) fn scratch(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("metaball-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("temporary folders can be made");
        folder
    }

    #[test]
    fn replaces_and_leaves_nothing_beside() {
        let folder = scratch("output");
        let path = folder.join("deep/er/file.txt");
        write_atomically(&path, b"first").expect("written");
        write_atomically(&path, b"second").expect("written");
        assert_eq!(fs::read(&path).expect("readable"), b"second");
        let beside = fs::read_dir(folder.join("deep/er")).expect("readable").count();
        assert_eq!(beside, 1);
        fs::remove_dir_all(folder).expect("removable");
    }

    #[test]
    fn things_in_lists_have_a_line_each() {
        let folder = scratch("lines");
        let path = folder.join("lines.json");
        let value = serde_json::json!({"a": [{"b": 1, "c": [2, 3]}, {"b": 4}], "d": [], "e": {}});
        write_json_lines(&path, &value).expect("written");
        let text = fs::read_to_string(&path).expect("readable");
        assert!(
            text.contains("\n    {\"b\": 1, \"c\": [2, 3]},\n    {\"b\": 4}\n  ],\n"),
            "{text}"
        );
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).expect("JSON"), value);
        fs::remove_dir_all(folder).expect("removable");
    }

    #[test]
    fn failures_name_the_path_and_leave_nothing() {
        let folder = scratch("output-failure");
        // A folder stands where the file should go: the final move fails.
        let path = folder.join("taken");
        fs::create_dir_all(path.join("inside")).expect("made");
        let error = write_atomically(&path, b"x").expect_err("a folder is in the way");
        assert!(error.to_string().contains("taken"), "{error}");
        assert_eq!(fs::read_dir(&folder).expect("readable").count(), 1);
        assert!(write_atomically(Path::new(".."), b"x").is_err());
        fs::remove_dir_all(folder).expect("removable");
    }
}
