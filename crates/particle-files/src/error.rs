//! What can be wrong with a file, and where in it.

use std::fmt;
use std::io;

use metaball_core::SceneError;
use thiserror::Error;

/// Why there are no particles, or no scene of them.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// A file's content is that of no format.
    #[error(
        "{file}: needed particles in one of the formats {formats}; found {found}; convert it to one of them, \
         such as extended XYZ, CSV or VTP"
    )]
    UnknownFormat {
        /// The path.
        file: String,
        /// The names of the formats, separated by commas.
        formats: String,
        /// What the content looks like.
        found: String,
    },
    /// A file has the particles of one scene where frames were needed.
    #[error(
        "{file}: needed a particle file for each frame, such as frame-%04d.xyz, a file that holds several \
         frames, a scene file that names either, or a .frames file; found one frame"
    )]
    NotASequence {
        /// The path.
        file: String,
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
    #[error("{}{problem}", location.prefix())]
    Content {
        /// Where the problem is.
        location: Location,
        /// What was needed, what was found, and the way out.
        problem: String,
    },
    /// An argument or an override cannot be used.
    #[error("{name}: needed {needed}, found {found}")]
    Parameter {
        /// What was wrong, for instance `kernel exponent`.
        name: String,
        /// What it should be.
        needed: String,
        /// What it is.
        found: String,
    },
    /// An override makes no scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// A position in a file. Lines and columns count from 1, bytes from 0; what is not known is `None`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Location {
    /// The path; `None` for bytes that came without one.
    pub file: Option<String>,
    /// The line.
    pub line: Option<usize>,
    /// The byte, of a binary format.
    pub byte: Option<usize>,
    /// The column: of text in a scene file or a structure, of fields in a table.
    pub column: Option<usize>,
    /// The key of a scene file, or the name of a table's column.
    pub key: Option<String>,
}

impl Location {
    /// What stands before a message about it: nothing where nothing is known.
    fn prefix(&self) -> String {
        let location = self.to_string();
        if location.is_empty() { location } else { format!("{location}: ") }
    }
}

impl fmt::Display for Location {
    /// For instance `pool.csv, line 3, column 4 (radius)`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = self.line.map(|line| format!("line {line}"));
        let byte = self.byte.map(|byte| format!("byte {byte}"));
        let column = match (self.column, &self.key) {
            (Some(column), Some(key)) => Some(format!("column {column} ({key})")),
            (Some(column), None) => Some(format!("column {column}")),
            (None, key) => key.clone(),
        };
        let known = [self.file.clone(), line, byte, column];
        let known: Vec<String> = known.into_iter().flatten().collect();
        formatter.write_str(&known.join(", "))
    }
}

/// What a parser finds wrong with a content whose file it does not know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Flaw {
    pub(crate) location: Location,
    pub(crate) problem: String,
}

impl Flaw {
    /// A flaw of the whole content.
    pub(crate) fn new(problem: impl Into<String>) -> Self {
        Self { location: Location::default(), problem: problem.into() }
    }

    /// Something else than was needed.
    pub(crate) fn needed(needed: &str, found: impl fmt::Display) -> Self {
        Self::new(format!("needed {needed}, found {found}"))
    }

    /// The flaw with what can be done about it.
    pub(crate) fn or(mut self, way_out: impl fmt::Display) -> Self {
        self.problem = format!("{}; {way_out}", self.problem);
        self
    }

    /// The flaw at a line, counted from 1.
    pub(crate) fn at_line(mut self, line: usize) -> Self {
        self.location.line = Some(line);
        self
    }

    /// The flaw at a byte, counted from 0.
    pub(crate) fn at_byte(mut self, byte: usize) -> Self {
        self.location.byte = Some(byte);
        self
    }

    /// The flaw at a column, counted from 1.
    pub(crate) fn at_column(mut self, column: usize) -> Self {
        self.location.column = Some(column);
        self
    }

    /// The flaw at a key or a named column.
    pub(crate) fn at_key(mut self, key: &str) -> Self {
        self.location.key = Some(key.to_owned());
        self
    }

    /// The flaw of a file.
    pub(crate) fn in_file(mut self, file: &str) -> LoadError {
        self.location.file = Some(file.to_owned());
        self.into()
    }
}

impl From<Flaw> for LoadError {
    fn from(Flaw { location, problem }: Flaw) -> Self {
        Self::Content { location, problem }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_begin_with_what_is_known_of_the_location() {
        let flaw = Flaw::needed("a number", "none");
        let at = |flaw: &Flaw| flaw.clone().in_file("a.csv").to_string();
        assert_eq!(LoadError::from(flaw.clone()).to_string(), "needed a number, found none");
        assert_eq!(at(&flaw), "a.csv: needed a number, found none");
        let flaw = flaw.at_key("radius");
        assert_eq!(at(&flaw), "a.csv, radius: needed a number, found none");
        let flaw = flaw.at_line(3).at_column(4);
        assert_eq!(at(&flaw), "a.csv, line 3, column 4 (radius): needed a number, found none");
        let message = LoadError::from(flaw).to_string();
        assert_eq!(message, "line 3, column 4 (radius): needed a number, found none");
    }
}
