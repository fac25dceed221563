//! The files of the repository, and which of them a name means.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::names::Name;

/// Where shaders name each other from.
const SHADERS: &str = "shaders/wgsl";

/// Files, by their paths from the root.
pub(crate) struct Tree {
    files: BTreeSet<String>,
    /// All folders of the files.
    folders: BTreeSet<String>,
}

impl Tree {
    pub(crate) fn new(files: &[&str]) -> Self {
        let files: BTreeSet<_> = files.iter().map(|&file| file.to_owned()).collect();
        let mut folders = BTreeSet::new();
        for file in &files {
            let ends = file.match_indices('/').map(|(end, _)| end);
            folders.extend(ends.map(|end| file[..end].to_owned()));
        }
        Self { files, folders }
    }

    /// What git tracks, and what it would if it were added.
    pub(crate) fn of_repository() -> Self {
        let mut git = Command::new("git");
        git.args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"]);
        let output = git.current_dir(root()).output().expect("git runs");
        assert!(output.status.success(), "git: {}", String::from_utf8_lossy(&output.stderr));
        let listed = String::from_utf8(output.stdout).expect("names in UTF-8");
        let files = listed.split_terminator('\0').filter(|file| root().join(file).is_file());
        Self::new(&files.collect::<Vec<_>>())
    }

    pub(crate) fn files(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(String::as_str)
    }

    /// The text of a file of the repository.
    pub(crate) fn read(&self, file: &str) -> String {
        fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
    }

    /// Whether a path begins with a folder at the root.
    pub(crate) fn has_root(&self, path: &str) -> bool {
        let (first, _) = path.split_once('/').unwrap_or((path, ""));
        self.folders.contains(first)
    }

    /// Whether a name in a file means something that is there.
    pub(crate) fn has(&self, file: &str, name: &Name) -> bool {
        let folder = parent(file);
        if name.is_link {
            return self.exists(folder, &name.path);
        }
        let package = self.package(folder);
        if !name.path.contains('/') {
            return self.has_bare(folder, package, &name.path);
        }
        let source = join(package, "src");
        let from = ["", package, &source, SHADERS];
        from.iter().any(|from| self.exists(from, &name.path))
            || file.ends_with(".md") && self.exists(folder, &name.path)
    }

    /// Whether a name without folders means one file.
    fn has_bare(&self, folder: &str, package: &str, name: &str) -> bool {
        let among = if name.ends_with(".wgsl") { SHADERS } else { package };
        let inside = |file: &&String| among.is_empty() || file.starts_with(&format!("{among}/"));
        let is_named = |file: &&String| file.rsplit('/').next() == Some(name);
        self.exists(folder, name)
            || self.exists("", name)
            || self.files.iter().filter(inside).filter(is_named).count() == 1
    }

    fn exists(&self, folder: &str, path: &str) -> bool {
        let Some(path) = resolved(&join(folder, path)) else { return false };
        path.is_empty() || self.files.contains(&path) || self.folders.contains(&path)
    }

    /// The innermost folder of a package around a folder, or the root.
    fn package<'a>(&self, folder: &'a str) -> &'a str {
        let mut folder = folder;
        while !folder.is_empty() && !self.files.contains(&join(folder, "Cargo.toml")) {
            folder = parent(folder);
        }
        folder
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn parent(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

fn join(folder: &str, path: &str) -> String {
    if folder.is_empty() { path.to_owned() } else { format!("{folder}/{path}") }
}

/// A path without `.` and `..`; `None` when it leaves the repository.
fn resolved(path: &str) -> Option<String> {
    let mut parts = Vec::new();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            part => parts.push(part),
        }
    }
    Some(parts.join("/"))
}
