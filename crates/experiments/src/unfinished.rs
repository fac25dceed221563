//! What an interrupted run has left: the file of its results so far.

use std::fs;
use std::path::Path;

use serde::de::DeserializeOwned;

use crate::console;

/// The results, if there are any that can be read.
pub(crate) fn read<R: DeserializeOwned>(path: &Path) -> Option<R> {
    serde_json::from_str(&fs::read_to_string(path).ok()?).ok()
}

/// Removes the file once the run is finished. It may well be gone already.
pub(crate) fn remove(path: &Path) {
    if let Err(error) = fs::remove_file(path) {
        console::note(&format!("{}: {error}", path.display()));
    }
}
