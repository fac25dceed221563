//! What a command says about a run, line by line.

use std::path::Path;

use experiments::console;
use metaball::{NoteKind, Notes};

/// What says a line.
pub(crate) type Says = fn(&str);

/// Says what became of a run: on standard error where one of its files is standard output.
pub(crate) fn speaker<'a>(mut files: impl Iterator<Item = &'a Path>) -> Says {
    let names = ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].map(Path::new);
    if files.any(|path| names.contains(&path)) { console::note } else { console::line }
}

/// A name and what is said of it.
pub(crate) fn line(says: Says, name: &str, value: &str) {
    says(&format!("{name:<10} {value}"));
}

/// What was read of a file, guessed, left out and changed.
pub(crate) fn say_notes(says: Says, notes: &Notes) {
    for note in notes {
        let name = match note.kind {
            NoteKind::Read => "read",
            NoteKind::Guessed => "guessed",
            NoteKind::LeftOut => "left out",
            _ => "changed",
        };
        line(says, name, &note.text);
    }
}
