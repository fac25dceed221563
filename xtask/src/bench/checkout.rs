//! Commits, and another one's files beside ours.

use std::path::Path;
use std::process::Command;

use crate::run::to_the_end;

/// How people name what lies in the repository's folder: its commit, and whether it has changes.
pub(super) fn here(repository: &Path) -> Result<String, String> {
    git(repository, &["describe", "--always", "--dirty", "--exclude=*"])
}

/// Checks a commit out in a folder, and returns its short name. The folder is a worktree of the
/// repository that stays for the next time: what the commits share is not built again.
pub(super) fn at(repository: &Path, commit: &str, folder: &Path) -> Result<String, String> {
    let revision = format!("{commit}^{{commit}}");
    let hash = git(repository, &["rev-parse", "--verify", "--quiet", "--short", &revision])
        .map_err(|_| {
            format!("bench: --against needed a commit of this repository, found {commit}")
        })?;
    let mut command = Command::new("git");
    if folder.join(".git").exists() {
        command.arg("-C").arg(folder).args(["checkout", "--quiet", "--force", "--detach", &hash]);
    } else {
        // By force where the folder went with the target folder, of which git has not heard.
        command.arg("-C").arg(repository).args(["worktree", "add", "--force", "--detach"]);
        command.arg(folder).arg(&hash);
    }
    to_the_end(&mut command)?;
    Ok(hash)
}

/// What git says to it; an error in its own words.
fn git(repository: &Path, arguments: &[&str]) -> Result<String, String> {
    let output = Command::new("git").arg("-C").arg(repository).args(arguments).output();
    let output = output.map_err(|error| format!("git could not be started: {error}"))?;
    if !output.status.success() {
        let complaint = String::from_utf8_lossy(&output.stderr);
        return Err(format!("git {}: {}", arguments.join(" "), complaint.trim()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
