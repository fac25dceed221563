//! What can go wrong with a file.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a file was not written or not read. Every text names the file, or the picture that has none yet.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PictureFileError {
    /// The path names no file, such as `..`.
    #[error("output: needed the path of a file, found \"{}\"", path.display())]
    NoFileName {
        /// The path.
        path: PathBuf,
    },
    /// The system refused.
    #[error("cannot {verb} {}", path.display())]
    Io {
        /// What was tried: `make`, `write`, `open` or `read`.
        verb: &'static str,
        /// The path.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// An output is another file of the same run.
    #[error(
        "{}: needed a file of its own for the {what}, found the {other} {}; give another name",
        path.display(),
        other_path.display()
    )]
    Taken {
        /// The output.
        path: PathBuf,
        /// What it is to be.
        what: &'static str,
        /// What it is already.
        other: &'static str,
        /// How that is named.
        other_path: PathBuf,
    },
    /// What was to be written has another size or number than it needs.
    #[error("{what}: needed {needed}, found {found}")]
    Size {
        /// What was to be written.
        what: String,
        /// What it needs.
        needed: String,
        /// How much there is, or how many are otherwise.
        found: usize,
    },
    /// An encoder refused.
    #[error("cannot encode {what}")]
    Encode {
        /// A path, or a kind of file.
        what: String,
        /// The encoder's reason.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A decoder refused.
    #[error("cannot decode {}", path.display())]
    Decode {
        /// The path.
        path: PathBuf,
        /// The decoder's reason.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The file is something else.
    #[error("{}: needed {needed}, found {found}", path.display())]
    Content {
        /// The path.
        path: PathBuf,
        /// What it should hold.
        needed: &'static str,
        /// What it holds.
        found: String,
    },
}

impl PictureFileError {
    /// To be given the system's reason.
    pub(crate) fn io(verb: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { verb, path, source }
    }

    /// To be given an encoder's reason.
    pub(crate) fn encode<E>(what: impl Into<String>) -> impl FnOnce(E) -> Self
    where
        E: Into<Box<dyn std::error::Error + Send + Sync>>,
    {
        let what = what.into();
        move |source| Self::Encode { what, source: source.into() }
    }

    /// To be given a decoder's reason.
    pub(crate) fn decode<E>(path: &Path) -> impl FnOnce(E) -> Self
    where
        E: Into<Box<dyn std::error::Error + Send + Sync>>,
    {
        let path = path.to_owned();
        move |source| Self::Decode { path, source: source.into() }
    }
}
