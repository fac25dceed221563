//! Files appear whole or not at all.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::PictureFileError;

/// Writes a file under a temporary name beside its final one, then moves it there, so that a reader
/// never sees half a file and an interrupted run leaves the previous one. Makes missing folders.
///
/// # Errors
/// When the folder cannot be made or the file not be written; names the path.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), PictureFileError> {
    let draft = Draft::create(path)?;
    draft.file().and_then(|mut file| file.write_all(bytes)).map_err(draft.error())?;
    draft.keep()
}

/// A file on its way: under a temporary name beside its final one, until it is [kept](Draft::keep).
/// Dropped before, it is removed.
#[derive(Debug)]
pub(crate) struct Draft {
    path: PathBuf,
    temporary: PathBuf,
    /// `None` once it is kept or removed.
    file: Option<File>,
}

impl Draft {
    /// An empty file. Makes missing folders.
    pub(crate) fn create(path: &Path) -> Result<Self, PictureFileError> {
        let name = path
            .file_name()
            .ok_or_else(|| PictureFileError::NoFileName { path: path.to_owned() })?;
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        fs::create_dir_all(folder).map_err(PictureFileError::io("make", folder))?;
        let temporary =
            folder.join(format!(".{}.{}.partial", name.to_string_lossy(), std::process::id()));
        let file = File::create(&temporary).map_err(PictureFileError::io("write", path))?;
        Ok(Self { path: path.to_owned(), temporary, file: Some(file) })
    }

    /// What it will be called.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Another handle to write with; all of them share a position.
    pub(crate) fn file(&self) -> std::io::Result<File> {
        self.file.as_ref().map_or_else(|| File::open(&self.path), File::try_clone)
    }

    /// To be given why it was not written.
    pub(crate) fn error(&self) -> impl FnOnce(std::io::Error) -> PictureFileError {
        PictureFileError::io("write", &self.path)
    }

    /// Moves it to its place.
    pub(crate) fn keep(mut self) -> Result<(), PictureFileError> {
        let Some(file) = self.file.take() else { return Ok(()) };
        let kept = file.sync_all().and_then(|()| {
            drop(file);
            fs::rename(&self.temporary, &self.path)
        });
        if kept.is_err() {
            self.remove();
        }
        kept.map_err(self.error())
    }

    /// What went wrong before is what to report; the leftover may well not exist.
    fn remove(&self) {
        let _ = fs::remove_file(&self.temporary);
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if self.file.take().is_some() {
            self.remove();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_and_leaves_nothing_beside() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("deep/er/file.txt");
        write_atomically(&path, b"first").expect("written");
        write_atomically(&path, b"second").expect("written");
        assert_eq!(fs::read(&path).expect("readable"), b"second");
        let beside = fs::read_dir(folder.path().join("deep/er")).expect("readable").count();
        assert_eq!(beside, 1);
    }

    #[test]
    fn failures_name_the_path_and_leave_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        // A folder stands where the file should go: the final move fails.
        let path = folder.path().join("taken");
        fs::create_dir_all(path.join("inside")).expect("made");
        let error = write_atomically(&path, b"x").expect_err("a folder is in the way");
        assert!(error.to_string().contains("taken"), "{error}");
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
        assert!(write_atomically(Path::new(".."), b"x").is_err());
    }
}
