//! What the path of an output leads to.

use std::fs;
use std::io;
use std::path::{Path, PathBuf, is_separator};

use crate::PictureFileError;

/// Links that are followed: as many as Linux does.
const MOST_LINKS: usize = 40;

/// What the path of an output leads to, behind all symbolic links.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// A regular file, or none yet: it is replaced. Its path is the one given where that is no link.
    File(PathBuf),
    /// A device, a pipe, or an open file: it is written to, never replaced.
    Stream(PathBuf),
}

impl Target {
    /// The target of a path.
    ///
    /// # Errors
    /// When the path names no file or leads to a folder, or when the system does not tell.
    pub fn of(path: &Path) -> Result<Self, PictureFileError> {
        if names_open_file(path) {
            return Ok(Self::Stream(path.to_owned()));
        }
        let kind = match fs::metadata(path) {
            Ok(found) => Some(found.file_type()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(PictureFileError::io("write", path)(error)),
        };
        match kind {
            Some(kind) if kind.is_dir() => Err(PictureFileError::Content {
                path: path.to_owned(),
                needed: "the path of a file",
                found: "a folder".to_owned(),
            }),
            Some(kind) if !kind.is_file() => Ok(Self::Stream(path.to_owned())),
            _ if !ends_in_a_name(path) => {
                Err(PictureFileError::NoFileName { path: path.to_owned() })
            }
            _ => Ok(Self::File(behind_links(path))),
        }
    }

    /// Whether a path leads to what is written to, not replaced.
    pub(crate) fn is_stream(path: &Path) -> bool {
        matches!(Self::of(path), Ok(Self::Stream(_)))
    }
}

/// Whether a path names a file that a process has open, such as `/dev/stdout`.
fn names_open_file(path: &Path) -> bool {
    let numbered = |folder: &Path| {
        folder == Path::new("/dev/fd") || (folder.starts_with("/proc") && folder.ends_with("fd"))
    };
    ["/dev/stdout", "/dev/stderr"].map(Path::new).contains(&path)
        || path.parent().is_some_and(numbered)
}

/// The path at the end of a chain of links; the file need not be there.
pub(crate) fn behind_links(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&path) else { break };
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    path
}

/// Whether the last part of a path is a name: not a separator, `.` or `..`.
fn ends_in_a_name(path: &Path) -> bool {
    let text = path.to_string_lossy();
    !matches!(text.rsplit(is_separator).next(), None | Some("" | "." | ".."))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_files_will_do() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        for name in ["a.png", "new/a.png", ".png", "Wässer 1.png"] {
            assert_eq!(Target::of(&at(name)).expect("a file"), Target::File(at(name)));
        }
        fs::write(at("file"), "").expect("written");
        let error = |path: &Path| Target::of(path).expect_err("refused").to_string();
        for name in ["new/", "new/.", "new/..", "a.png/"] {
            assert!(error(&at(name)).starts_with("output: needed the path of a file"), "{name}");
        }
        assert!(error(Path::new("")).starts_with("output: needed the path of a file"));
        assert!(error(folder.path()).ends_with("needed the path of a file, found a folder"));
        assert!(error(&at("file/a.png")).starts_with("cannot write"));
    }

    #[test]
    #[cfg(unix)]
    fn links_are_followed_and_devices_are_streams() {
        use std::os::unix::fs::symlink;

        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("deep")).expect("made");
        symlink("deep/second", at("first")).expect("linked");
        symlink("../real.png", at("deep/second")).expect("linked");
        let wanted = Target::File(at("deep/../real.png"));
        assert_eq!(Target::of(&at("first")).expect("nothing there yet"), wanted);
        fs::write(at("real.png"), "").expect("written");
        assert_eq!(Target::of(&at("first")).expect("a file"), wanted);

        symlink("/dev/null", at("null.png")).expect("linked");
        for stream in ["/dev/null", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
            let stream = PathBuf::from(stream);
            assert_eq!(Target::of(&stream).expect("open"), Target::Stream(stream));
        }
        assert!(!names_open_file(Path::new("/proc/self/cwd/a.png")));
        assert!(!names_open_file(Path::new("fd/a.png")));
        assert!(Target::is_stream(&at("null.png")) && !Target::is_stream(&at("real.png")));
        symlink("round.png", at("round.png")).expect("linked");
        assert!(Target::of(&at("round.png")).is_err());
    }
}
