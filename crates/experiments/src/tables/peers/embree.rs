//! Embree 3: its tree over the balls' supports, and our search along what it gathers; a C++ program beside
//! this file, compiled where it is run.

use std::fs;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::Command;

use anyhow::Context;
use metaball_core::{Scene, View};
use tempfile::TempDir;

use super::array_job::ArrayJob;

const COMPILER: &str = "c++";
const SOURCE: &str = include_str!("embree/gather.cpp");

/// What the source says where there is no Embree.
const ABSENT: &str = "Embree 3 is not installed";

/// How a reader comes by it.
pub(super) const INSTALL: &str =
    "To install it: `apt-get install g++ libembree-dev` (Debian 12, Ubuntu 22.04).";

/// The compiled program.
#[derive(Debug)]
pub struct Embree {
    version: String,
    program: PathBuf,
    /// Where it is.
    _folder: TempDir,
}

/// How much of a ray is gathered at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Gather {
    /// Every ball that the ray meets, however far.
    Whole,
    /// Two mean support radii from the next support on.
    Windows,
}

impl Gather {
    /// Both.
    pub(super) const ALL: [Self; 2] = [Self::Whole, Self::Windows];

    /// In tables.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Whole => "Embree 3, whole rays",
            Self::Windows => "Embree 3, windows",
        }
    }

    /// Mean support radii; 0 for whole rays.
    fn window(self) -> f64 {
        match self {
            Self::Whole => 0.0,
            Self::Windows => 2.0,
        }
    }
}

impl Embree {
    /// Compiles the program for this machine; `None` where a compiler or Embree is missing.
    ///
    /// # Errors
    /// When it does not compile for another reason, or does not run.
    pub(super) fn find() -> anyhow::Result<Option<Self>> {
        let folder = TempDir::new().context("cannot make a temporary folder")?;
        let source = folder.path().join("gather.cpp");
        let program = folder.path().join("gather");
        fs::write(&source, SOURCE).context("cannot write gather.cpp to a temporary folder")?;
        let mut command = Command::new(COMPILER);
        command.args(["-std=c++17", "-O3", "-march=native", "-pthread", "-o"]);
        let output = match command.arg(&program).arg(&source).arg("-lembree3").output() {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            output => output.with_context(|| format!("cannot run {COMPILER}"))?,
        };
        let complaint = String::from_utf8_lossy(&output.stderr);
        if complaint.contains(ABSENT) {
            return Ok(None);
        }
        anyhow::ensure!(output.status.success(), "{COMPILER} gather.cpp: {}", complaint.trim());
        let output = Command::new(&program).arg("--version").output();
        let output = output.context("cannot run what gather.cpp compiled to")?;
        let version = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        Ok(Some(Self { version, program, _folder: folder }))
    }

    /// What it calls itself.
    pub(super) fn version(&self) -> &str {
        &self.version
    }

    /// A view to be traced.
    ///
    /// # Errors
    /// When the arrays cannot be written.
    pub(super) fn job(
        &self,
        (scene, view): (&Scene, &View),
        threads: usize,
        gather: Gather,
    ) -> anyhow::Result<ArrayJob> {
        ArrayJob::new(&[&self.program.to_string_lossy()], scene, view, threads, gather.window())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_source_says_where_embree_is_missing() {
        assert!(SOURCE.contains(&format!("#error \"{ABSENT}\"")));
    }
}
