//! Files appear whole or not at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::PictureFileError;
use crate::target::Target;

/// Writes a file under a temporary name beside its final one, then moves it there, so that a reader
/// never sees half a file and an interrupted run leaves the previous one. Makes missing folders.
///
/// A symbolic link stays: the file that it leads to is replaced. What is no regular file, such as
/// `/dev/null` or a pipe, is not replaced but written to.
///
/// # Errors
/// When the folder cannot be made or the file not be written; names the path.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), PictureFileError> {
    let draft = Draft::create(path)?;
    draft.file().and_then(|mut file| file.write_all(bytes)).map_err(draft.error())?;
    draft.keep()
}

/// Makes sure that [`write_atomically`] could write a file now, and leaves none. Makes missing folders.
///
/// # Errors
/// As [`write_atomically`].
pub fn ensure_writable(path: &Path) -> Result<(), PictureFileError> {
    Draft::create(path).map(drop)
}

/// A file on its way, until it is [kept](Draft::keep). Dropped before, it is removed.
#[derive(Debug)]
pub(crate) struct Draft {
    /// What it will be called, as the user says it.
    path: PathBuf,
    place: Place,
}

/// Where a file is on its way.
#[derive(Debug)]
enum Place {
    /// Beside the file that it becomes.
    Beside { temporary: NamedTempFile, target: PathBuf },
    /// Nowhere to be seen: its bytes are for what is no regular file.
    Unnamed(File),
}

impl Draft {
    /// An empty file. Makes missing folders.
    pub(crate) fn create(path: &Path) -> Result<Self, PictureFileError> {
        let place = match Target::of(path)? {
            Target::File(target) => Place::beside(target)?,
            Target::Stream(_) => {
                let unnamed = tempfile::tempfile();
                Place::Unnamed(unnamed.map_err(PictureFileError::io("write", path))?)
            }
        };
        Ok(Self { path: path.to_owned(), place })
    }

    /// What it will be called.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Another handle to write with; all of them share a position.
    pub(crate) fn file(&self) -> io::Result<File> {
        match &self.place {
            Place::Beside { temporary, .. } => temporary.as_file().try_clone(),
            Place::Unnamed(file) => file.try_clone(),
        }
    }

    /// To be given why it was not written.
    pub(crate) fn error(&self) -> impl FnOnce(io::Error) -> PictureFileError {
        PictureFileError::io("write", &self.path)
    }

    /// Moves it to its place.
    pub(crate) fn keep(self) -> Result<(), PictureFileError> {
        let Self { path, place } = self;
        let kept = match place {
            Place::Beside { temporary, target } => replace(temporary, &target),
            Place::Unnamed(file) => pour(file, &path),
        };
        kept.map_err(PictureFileError::io("write", &path))
    }
}

impl Place {
    /// A new file beside one that can be replaced, or is not there.
    fn beside(target: PathBuf) -> Result<Self, PictureFileError> {
        let folder = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        fs::create_dir_all(folder).map_err(PictureFileError::io("make", folder))?;
        let opened = if target.exists() {
            // Who may not write to it may not replace it either, whatever the folder allows.
            OpenOptions::new().write(true).open(&target).map(drop)
        } else {
            Ok(())
        };
        let temporary = opened.and_then(|()| temporary_in(folder, &target));
        let temporary = temporary.map_err(PictureFileError::io("write", &target))?;
        Ok(Self::Beside { temporary, target })
    }
}

fn temporary_in(folder: &Path, target: &Path) -> io::Result<NamedTempFile> {
    // The start of its name: all of it may be as long as names can be.
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    let prefix = format!(".{}.", name.chars().take(32).collect::<String>());
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".partial");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Puts a file in the place of another, with the permissions of that.
fn replace(temporary: NamedTempFile, target: &Path) -> io::Result<()> {
    if let Ok(replaced) = fs::metadata(target) {
        temporary.as_file().set_permissions(replaced.permissions())?;
    }
    temporary.as_file().sync_all()?;
    temporary.persist(target)?;
    Ok(())
}

/// Writes all of a file to what is no regular file.
fn pour(mut file: File, stream: &Path) -> io::Result<()> {
    file.rewind()?;
    let mut stream = OpenOptions::new().append(true).open(stream)?;
    io::copy(&mut file, &mut stream)?;
    stream.flush()
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
        let long = folder.path().join("ß".repeat(127));
        write_atomically(&long, b"x").expect("a name of 254 bytes is one");
    }

    #[test]
    fn failures_name_the_path_and_leave_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("taken");
        fs::create_dir_all(path.join("inside")).expect("made");
        for check in [ensure_writable(&path), write_atomically(&path, b"x")] {
            let error = check.expect_err("a folder is in the way").to_string();
            assert!(error.contains("taken: needed the path of a file"), "{error}");
        }
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
        assert!(write_atomically(Path::new(".."), b"x").is_err());
    }

    #[test]
    fn what_can_be_written_is_left_as_it_is() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("file.txt");
        ensure_writable(&path).expect("writable");
        assert!(!path.exists());
        fs::write(&path, "mine").expect("written");
        ensure_writable(&path).expect("writable");
        assert_eq!(fs::read(&path).expect("readable"), b"mine");
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
    }

    #[cfg(unix)]
    mod unix {
        use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
        use std::process::Command;
        use std::thread;

        use super::*;

        #[test]
        fn links_stay_and_their_files_are_replaced() {
            let folder = tempfile::tempdir().expect("a folder");
            let at = |name: &str| folder.path().join(name);
            fs::create_dir(at("real")).expect("made");
            fs::write(at("real/a.txt"), "before").expect("written");
            fs::hard_link(at("real/a.txt"), at("copy.txt")).expect("linked");
            symlink("real/a.txt", at("a.txt")).expect("linked");
            symlink("real/new.txt", at("new.txt")).expect("linked");
            for name in ["a.txt", "new.txt"] {
                write_atomically(&at(name), b"after").expect("written");
                assert!(at(name).is_symlink(), "{name}");
                assert_eq!(fs::read(at("real").join(name)).expect("written"), b"after");
            }
            assert_eq!(fs::read(at("copy.txt")).expect("there"), b"before", "written in place");
            assert_eq!(fs::read_dir(at("real")).expect("readable").count(), 2);
        }

        #[test]
        fn permissions_are_those_of_any_file_or_of_the_one_before() {
            let folder = tempfile::tempdir().expect("a folder");
            let at = |name: &str| folder.path().join(name);
            let mode =
                |name: &str| fs::metadata(at(name)).expect("there").permissions().mode() & 0o777;
            fs::write(at("plain.txt"), "").expect("written");
            write_atomically(&at("new.txt"), b"x").expect("written");
            assert_eq!(mode("new.txt"), mode("plain.txt"));
            fs::set_permissions(at("new.txt"), PermissionsExt::from_mode(0o640)).expect("set");
            write_atomically(&at("new.txt"), b"y").expect("written");
            assert_eq!(mode("new.txt"), 0o640);
        }

        #[test]
        fn a_pipe_is_written_to_and_stays() {
            let folder = tempfile::tempdir().expect("a folder");
            let pipe = folder.path().join("pipe");
            let made = Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs");
            assert!(made.success());
            // Neither waits for a reader.
            ensure_writable(&pipe).expect("writable");
            let draft = Draft::create(&pipe).expect("begun");
            draft.file().and_then(|mut file| file.write_all(b"through")).expect("written");
            let reader = {
                let pipe = pipe.clone();
                thread::spawn(move || fs::read(pipe).expect("readable"))
            };
            draft.keep().expect("written");
            assert_eq!(reader.join().expect("read"), b"through");
            assert!(fs::metadata(&pipe).expect("there").file_type().is_fifo());
            assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
        }

        #[test]
        fn devices_take_bytes_or_say_why_not() {
            write_atomically(Path::new("/dev/null"), b"x").expect("written");
            assert!(fs::metadata("/dev/null").expect("there").file_type().is_char_device());
            if Path::new("/dev/full").exists() {
                let error = write_atomically(Path::new("/dev/full"), b"x").expect_err("full");
                assert_eq!(error.to_string(), "cannot write /dev/full");
            }
        }
    }
}
