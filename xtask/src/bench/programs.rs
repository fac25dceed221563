//! Benches as programs: built by cargo, run by us, so that two builds can take turns.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use super::json;
use crate::run::cargo;

/// A built bench.
pub(super) struct Program {
    name: String,
    executable: PathBuf,
    /// Its package's, from which cargo would start it.
    folder: PathBuf,
}

/// Builds every bench of a checkout, by names like `fbvh/trace`; in a target folder of its own, or in the
/// one that is configured.
pub(super) fn build(
    root: &Path,
    target: Option<&Path>,
) -> Result<BTreeMap<String, Program>, String> {
    let mut command = cargo();
    command.current_dir(root).args(["bench", "--no-run", "--bench", "*"]);
    command.arg("--message-format=json-render-diagnostics");
    for package in packages(root)? {
        command.args(["--package", &package]);
    }
    if let Some(target) = target {
        command.env("CARGO_TARGET_DIR", target);
    }
    let output = command.stdout(Stdio::piped()).stderr(Stdio::inherit()).spawn();
    let output = output.and_then(std::process::Child::wait_with_output);
    let output = output.map_err(|error| format!("cargo could not be started: {error}"))?;
    if !output.status.success() {
        return Err(format!("the benches of {} were not built", root.display()));
    }
    let messages = String::from_utf8_lossy(&output.stdout);
    Ok(messages.lines().filter_map(program).map(|one| (one.name.clone(), one)).collect())
}

/// Packages, named like their folders, that have benches.
fn packages(root: &Path) -> Result<Vec<String>, String> {
    let crates = root.join("crates");
    let entries =
        fs::read_dir(&crates).map_err(|error| format!("{}: {error}", crates.display()))?;
    let folders = entries.flatten().filter(|entry| entry.path().join("benches").is_dir());
    let names: Vec<_> =
        folders.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    if names.is_empty() {
        return Err(format!("{}: needed a package with benches, found none", crates.display()));
    }
    Ok(names)
}

/// The bench of which a message of cargo tells, if it tells of one.
fn program(message: &str) -> Option<Program> {
    let (_, target) = message.split_once("\"target\":")?;
    let executable = PathBuf::from(json::string(message, "executable")?);
    let manifest = PathBuf::from(json::string(message, "manifest_path")?);
    let folder = manifest.parent()?.to_owned();
    let package = folder.file_name()?.to_string_lossy().into_owned();
    let name = format!("{package}/{}", json::string(target, "name")?);
    target.starts_with("{\"kind\":[\"bench\"]").then_some(Program { name, executable, folder })
}

impl Program {
    /// Whether a bench passes the filter.
    pub(super) fn has_bench(&self, filter: &str) -> Result<bool, String> {
        let output =
            self.output(Command::new(&self.executable).args(["--bench", "--list", filter]))?;
        Ok(String::from_utf8_lossy(&output.stdout)
            .lines()
            .any(|line| line.ends_with(": benchmark")))
    }

    /// Times the benches that pass the filter; criterion leaves its files in the folder `home`. Rounds take
    /// the place of long measurements.
    pub(super) fn run(&self, filter: &str, home: &Path) -> Result<(), String> {
        let mut command = Command::new(&self.executable);
        command.args(["--bench", "--noplot", "--warm-up-time", "1", "--measurement-time", "2"]);
        self.output(command.arg(filter).env("CRITERION_HOME", home)).map(|_| ())
    }

    fn output(&self, command: &mut Command) -> Result<Output, String> {
        let name = &self.name;
        let output = command.current_dir(&self.folder).output();
        let output = output.map_err(|error| format!("{name} could not be started: {error}"))?;
        if !output.status.success() {
            let complaint = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{name}: {}: {}", output.status, complaint.trim()));
        }
        Ok(output)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn benches_are_told_from_other_artifacts() {
        let message = |kind: &str, executable: &str| {
            format!(
                "{{\"reason\":\"compiler-artifact\",\"package_id\":\"x\",\"manifest_path\":\
                 \"/w/crates/fbvh/Cargo.toml\",\"target\":{{\"kind\":[\"{kind}\"],\"crate_types\":\
                 [\"bin\"],\"name\":\"trace\"}},\"executable\":{executable},\"fresh\":true}}"
            )
        };
        let bench = program(&message("bench", "\"/w/target/trace-1\"")).expect("a bench");
        assert_eq!(bench.name, "fbvh/trace");
        assert_eq!(bench.executable, Path::new("/w/target/trace-1"));
        assert_eq!(bench.folder, Path::new("/w/crates/fbvh"));
        assert!(program(&message("lib", "null")).is_none());
        assert!(program(&message("bin", "\"/w/target/trace\"")).is_none());
        assert!(program("{\"reason\":\"build-finished\",\"success\":true}").is_none());
    }
}
