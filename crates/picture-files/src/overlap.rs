//! No output of a run is one of its inputs, nor another of its outputs.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::PictureFileError;
use crate::target::behind_links;

/// A file of a run: what it is, such as `picture` or `scene`, and its path.
pub type RunFile = (&'static str, PathBuf);

/// Makes sure that no output is an input or another output, by any name: another spelling, a symbolic
/// link, and on Unix a hard link. Devices such as `/dev/null` hold nothing and may come any number of
/// times.
///
/// # Errors
/// Names the first output that is not a file of its own, and what else it is.
pub fn refuse_overlap(outputs: &[RunFile], inputs: &[RunFile]) -> Result<(), PictureFileError> {
    let mut files = HashMap::new();
    for file in inputs {
        if let Some(identity) = Identity::of(&file.1) {
            files.entry(identity).or_insert(file);
        }
    }
    for output in outputs {
        let Some(identity) = Identity::of(&output.1) else { continue };
        if let Some((other, other_path)) = files.insert(identity, output) {
            let ((what, path), (other_path, other)) = (output, (other_path.clone(), *other));
            return Err(PictureFileError::Taken { path: path.clone(), what, other, other_path });
        }
    }
    Ok(())
}

/// What tells files apart, whatever they are called.
#[derive(Debug, PartialEq, Eq, Hash)]
enum Identity {
    /// A file that is there: its device and its number there.
    #[cfg(unix)]
    Numbers(u64, u64),
    /// A file by its path without links: one that is not there yet.
    Path(PathBuf),
}

impl Identity {
    /// `None` for a device.
    #[cfg(unix)]
    fn of(path: &Path) -> Option<Self> {
        use std::os::unix::fs::{FileTypeExt, MetadataExt};

        match fs::metadata(path) {
            Ok(found) if found.file_type().is_char_device() => None,
            Ok(found) => Some(Self::Numbers(found.dev(), found.ino())),
            Err(_) => Some(Self::Path(canonical(&behind_links(path)))),
        }
    }

    /// `None` for a device.
    #[cfg(not(unix))]
    fn of(path: &Path) -> Option<Self> {
        match fs::metadata(path) {
            Ok(found) if !found.is_file() => None,
            _ => Some(Self::Path(canonical(&behind_links(path)))),
        }
    }
}

/// A path from the root without links and `..`, as far as its folders are there.
fn canonical(path: &Path) -> PathBuf {
    if let Ok(found) = fs::canonicalize(path) {
        return found;
    }
    let Ok(path) = std::path::absolute(path) else { return path.to_owned() };
    match (path.parent(), path.file_name()) {
        (Some(folder), Some(name)) => canonical(folder).join(name),
        // The last part is `..`.
        (Some(folder), None) => {
            let folder = canonical(folder);
            folder.parent().map_or(folder.clone(), Path::to_owned)
        }
        (None, _) => path,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(outputs: &[&Path], inputs: &[&Path]) -> Option<String> {
        let files = |what, paths: &[&Path]| -> Vec<RunFile> {
            paths.iter().map(|path| (what, path.to_path_buf())).collect()
        };
        let found = refuse_overlap(&files("picture", outputs), &files("scene", inputs));
        found.err().map(|error| error.to_string())
    }

    #[test]
    fn an_output_is_no_input_however_it_is_spelled() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("b.xyz"), "").expect("written");
        fs::create_dir(at("deep")).expect("made");
        let scene = at("b.xyz");
        let plain = refusal(&[&scene], &[&scene]).expect("refused");
        let named = scene.display();
        assert_eq!(
            plain,
            format!(
                "{named}: needed a file of its own for the picture, found the scene {named}; give \
                 another name"
            )
        );
        assert!(refusal(&[&at("deep/../b.xyz")], &[&scene]).is_some());
        for other in ["c.xyz", "b.png", "deep/b.xyz", "new/b.xyz"] {
            assert_eq!(refusal(&[&at(other)], &[&scene]), None, "{other}");
        }
        assert_eq!(refusal(&[], &[&scene, &scene]), None, "an input may be named twice");
    }

    #[test]
    fn outputs_that_are_not_there_yet_are_told_apart() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        assert!(refusal(&[&at("a.png"), &at("a.png")], &[]).is_some());
        assert!(refusal(&[&at("new/a.png"), &at("new/../new/./a.png")], &[]).is_some());
        assert_eq!(refusal(&[&at("new/a.png"), &at("a.png"), &at("b.png")], &[]), None);
    }

    #[test]
    #[cfg(unix)]
    fn links_are_seen_through_and_devices_may_come_twice() {
        use std::os::unix::fs::symlink;

        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("b.xyz"), "").expect("written");
        symlink("b.xyz", at("soft.png")).expect("linked");
        fs::hard_link(at("b.xyz"), at("hard.png")).expect("linked");
        symlink(folder.path(), at("folder")).expect("linked");
        symlink("missing.png", at("dangling.png")).expect("linked");
        let scene = at("b.xyz");
        for other in ["soft.png", "hard.png", "folder/b.xyz", "folder/folder/soft.png"] {
            assert!(refusal(&[&at(other)], &[&scene]).is_some(), "{other}");
        }
        assert_eq!(refusal(&[&at("dangling.png")], &[&scene]), None);
        assert!(refusal(&[&at("dangling.png"), &at("folder/missing.png")], &[]).is_some());
        let null = Path::new("/dev/null");
        assert_eq!(refusal(&[null, null], &[null]), None);
    }
}
