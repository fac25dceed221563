//! What a load says: what was read, guessed, left out and changed.

use std::fmt;

/// A sentence about a file that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Note {
    /// What sort of sentence it is.
    pub kind: NoteKind,
    /// The sentence, without the file's name.
    pub text: String,
}

/// What a [`Note`] is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum NoteKind {
    /// What the file is and holds.
    Read,
    /// What the file does not say and was decided; names the option that decides otherwise.
    Guessed,
    /// What is in the file and not in the scene.
    LeftOut,
    /// What is not in the scene as it is in the file.
    Changed,
}

impl fmt::Display for Note {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.text)
    }
}

/// All that a load has to say, in the order in which it happened.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Notes(Vec<Note>);

impl Notes {
    /// The sentences.
    pub fn iter(&self) -> std::slice::Iter<'_, Note> {
        self.0.iter()
    }

    /// Whether there is nothing to say.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn read(&mut self, text: impl Into<String>) {
        self.add(NoteKind::Read, text);
    }

    pub(crate) fn guessed(&mut self, text: impl Into<String>) {
        self.add(NoteKind::Guessed, text);
    }

    pub(crate) fn left_out(&mut self, text: impl Into<String>) {
        self.add(NoteKind::LeftOut, text);
    }

    pub(crate) fn changed(&mut self, text: impl Into<String>) {
        self.add(NoteKind::Changed, text);
    }

    fn add(&mut self, kind: NoteKind, text: impl Into<String>) {
        self.0.push(Note { kind, text: text.into() });
    }
}

impl<'a> IntoIterator for &'a Notes {
    type Item = &'a Note;
    type IntoIter = std::slice::Iter<'a, Note>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// A number of things in words: `1 atom`, `3 atoms`.
pub(crate) fn counted(count: usize, thing: &str) -> String {
    match count {
        1 => format!("1 {thing}"),
        _ => format!("{count} {thing}s"),
    }
}
