//! A mesh: the field on a grid, VTK's triangles of it, and Mitsuba 3 to draw them; a Python program beside
//! this file.

use std::fs;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::Command;

use anyhow::Context;
use metaball_core::{Scene, View};
use tempfile::TempDir;

use super::array_job::ArrayJob;

const PYTHON: &str = "python3";
const SCRIPT: &str = include_str!("mesh/mesh.py");
const REQUIREMENTS: &str = include_str!("mesh/requirements.txt");

/// The script, and the packages that it needs.
#[derive(Debug)]
pub struct Mesh {
    versions: String,
    script: PathBuf,
    /// Where the script is, and what numba compiles of it.
    _folder: TempDir,
}

/// How a reader comes by the packages.
pub(super) fn install() -> String {
    let packages: Vec<_> = REQUIREMENTS.lines().collect();
    format!(
        "To install them: `python3 -m venv peers-venv && . peers-venv/bin/activate && pip install {}`, \
         and with the environment active run this again; on Linux Mitsuba also needs LLVM's library \
         (`apt-get install libllvm15`).",
        packages.join(" ")
    )
}

impl Mesh {
    /// The script with what Python on the PATH has; `None` where Python or a package is missing.
    ///
    /// # Errors
    /// When Python cannot be run, or fails otherwise.
    pub(super) fn find() -> anyhow::Result<Option<Self>> {
        let folder = TempDir::new().context("cannot make a temporary folder")?;
        let script = folder.path().join("mesh.py");
        fs::write(&script, SCRIPT).context("cannot write mesh.py to a temporary folder")?;
        let output = match Command::new(PYTHON).arg(&script).arg("--version").output() {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            output => output.with_context(|| format!("cannot run {PYTHON}"))?,
        };
        let complaint = String::from_utf8_lossy(&output.stderr);
        if complaint.contains("PackageNotFoundError") {
            return Ok(None);
        }
        anyhow::ensure!(output.status.success(), "{PYTHON} mesh.py: {}", complaint.trim());
        let versions = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        Ok(Some(Self { versions, script, _folder: folder }))
    }

    /// The packages with their versions.
    pub(super) fn versions(&self) -> &str {
        &self.versions
    }

    /// A mesh from a grid of so many cells along its longest side, to be drawn.
    ///
    /// # Errors
    /// When the arrays cannot be written.
    pub(super) fn job(
        &self,
        (scene, view): (&Scene, &View),
        threads: usize,
        cells: u32,
    ) -> anyhow::Result<ArrayJob> {
        let script = self.script.to_string_lossy();
        ArrayJob::new(&[PYTHON, &script], scene, view, threads, cells.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The script asks for the versions of what is pinned, and of nothing else.
    #[test]
    fn what_the_script_takes_is_pinned() {
        let names: Vec<_> = REQUIREMENTS
            .lines()
            .map(|line| line.split_once("==").expect("a pinned version").0)
            .map(|name| format!("\"{name}\""))
            .collect();
        let list = format!("PACKAGES = [{}]", names.join(", "));
        assert!(SCRIPT.contains(&list), "{list}");
        assert!(install().contains("mitsuba=="));
    }
}
