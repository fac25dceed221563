//! Output files appear whole or not at all.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

use anyhow::Context;
use serde::Serialize;

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
