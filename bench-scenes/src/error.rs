//! What can be wrong with a scene that was asked for.

use std::fmt;
use std::io;

use metaball_core::{CameraError, SceneError, ViewError};
use thiserror::Error;

/// Why there is no scene.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The words name neither a known scene nor a generator nor a kind of file.
    #[error(
        "{spec:?} is no scene. Needed one of\n  a known name: {known}\n  a generator: {generators}, \
         each as name:count[:density[:seed]]\n  a scene file (.toml) or a particle file (.csv, .xyz, \
         .pdb, .ent, .cif, .mmcif, .balls), each of these also with .gz"
    )]
    Unknown {
        /// What was asked for.
        spec: String,
        /// Names of known scenes, separated by commas.
        known: String,
        /// Names of generators, separated by commas.
        generators: String,
    },
    /// The words name a scene that does not move, or none.
    #[error(
        "{spec:?} does not move. Needed one of\n  a known name: {known}\n  a generator: {generators}, \
         each as name:count[:density[:seed]]\n  a particle file for each frame, such as \
         frame-%04d.xyz, or a scene file that names such particles\n  a .frames file"
    )]
    Still {
        /// What was asked for.
        spec: String,
        /// Names of moving scenes, separated by commas.
        known: String,
        /// Names of generators that move, separated by commas.
        generators: String,
    },
    /// A generator's spec or an override cannot be used.
    #[error("{name}: needed {needed}, found {found}")]
    Parameter {
        /// What was wrong, for instance `count of "tornado:x"`.
        name: String,
        /// What it should be.
        needed: String,
        /// What it is.
        found: String,
    },
    /// A file cannot be read.
    #[error("cannot read {file}")]
    Read {
        /// The path.
        file: String,
        /// The system's reason.
        source: io::Error,
    },
    /// A file's content cannot be used.
    #[error("{file}{place}: {problem}")]
    Content {
        /// The path.
        file: String,
        /// Where in the file.
        place: Place,
        /// What was needed and what was found.
        problem: String,
    },
    /// The parts make no scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The numbers make no camera.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The numbers make no picture.
    #[error(transparent)]
    View(#[from] ViewError),
}

/// A place in a file. Lines and columns count from 1; what is not known is `None`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Place {
    /// The line.
    pub line: Option<usize>,
    /// The column: of text in a scene file or a structure, of fields in a table.
    pub column: Option<usize>,
    /// The key of a scene file, or the name of a table's column.
    pub key: Option<String>,
}

impl fmt::Display for Place {
    /// For instance `, line 3, column 4 (radius)`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(formatter, ", line {line}")?;
        }
        if let Some(column) = self.column {
            write!(formatter, ", column {column}")?;
        }
        match &self.key {
            Some(key) if self.column.is_some() => write!(formatter, " ({key})"),
            Some(key) => write!(formatter, ", {key}"),
            None => Ok(()),
        }
    }
}

/// What a parser finds wrong with a text whose name it does not know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Flaw {
    pub(crate) place: Place,
    pub(crate) problem: String,
}

impl Flaw {
    /// A flaw of the whole text.
    pub(crate) fn new(problem: impl Into<String>) -> Self {
        Self { place: Place::default(), problem: problem.into() }
    }

    /// Something else than was needed.
    pub(crate) fn needed(needed: &str, found: impl fmt::Display) -> Self {
        Self::new(format!("needed {needed}, found {found}"))
    }

    /// The flaw at a line, counted from 1.
    pub(crate) fn at_line(mut self, line: usize) -> Self {
        self.place.line = Some(line);
        self
    }

    /// The flaw at a column, counted from 1.
    pub(crate) fn at_column(mut self, column: usize) -> Self {
        self.place.column = Some(column);
        self
    }

    /// The flaw at a key or a named column.
    pub(crate) fn at_key(mut self, key: &str) -> Self {
        self.place.key = Some(key.to_owned());
        self
    }

    /// The flaw of a file.
    pub(crate) fn in_file(self, file: &str) -> LoadError {
        LoadError::Content { file: file.to_owned(), place: self.place, problem: self.problem }
    }
}
