//! POV-Ray as a process: scenes for its `blob`, its clocks, and what its pictures tell.

mod blob;
mod job;
pub mod lit;
mod log;
pub mod primary;

use std::io::ErrorKind;
use std::process::Command;

use anyhow::Context;

/// How a reader comes by the peer.
pub const INSTALL: &str = "To install it: `apt-get install povray` (Debian, Ubuntu), `brew install \
                           povray` (macOS), or its sources; `povray` has to be on the PATH.";

/// Its primary rays in tables.
pub(super) const NAME: &str = "POV-Ray blob";

const PROGRAM: &str = "povray";

/// The installed program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Povray {
    version: String,
}

impl Povray {
    /// The program on the PATH, with its version; `None` where there is none.
    ///
    /// # Errors
    /// When there is one that cannot be run, or that does not say a version.
    pub fn find() -> anyhow::Result<Option<Self>> {
        let output = match Command::new(PROGRAM).arg("--version").output() {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            output => output.with_context(|| format!("cannot run {PROGRAM} --version"))?,
        };
        let text = [output.stdout, output.stderr].concat();
        let text = String::from_utf8_lossy(&text);
        let version = text.lines().find(|line| line.starts_with("POV-Ray "));
        let version = version.with_context(|| {
            format!("{PROGRAM} --version: needed a line \"POV-Ray …\", found \"{}\"", text.trim())
        })?;
        Ok(Some(Self { version: version.trim().to_owned() }))
    }

    /// What it calls itself.
    pub fn version(&self) -> &str {
        &self.version
    }
}
