//! Errors of the library as Python's, in the library's words.

use std::error::Error;
use std::io;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// An error of the library: an `OSError` of its kind where a file is the reason, else a `ValueError`.
pub(crate) fn raised(error: impl Error + 'static) -> PyErr {
    let text = sentence(&error);
    match kind_of(&error) {
        Some(kind) => io::Error::new(kind, text).into(),
        None => PyValueError::new_err(text),
    }
}

/// A value that an argument cannot have.
pub(crate) fn refused(argument: &str, needed: &str, found: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(format!("{argument}: needed {needed}, found {found}"))
}

/// The error with its causes, in one line.
fn sentence(error: &dyn Error) -> String {
    match error.source() {
        Some(source) => format!("{error}: {}", sentence(source)),
        None => error.to_string(),
    }
}

/// What the system said of a file, if that is the cause.
fn kind_of(error: &(dyn Error + 'static)) -> Option<io::ErrorKind> {
    match error.downcast_ref::<io::Error>() {
        Some(error) => Some(error.kind()),
        None => kind_of(error.source()?),
    }
}
