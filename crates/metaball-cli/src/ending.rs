//! How the process ends: what its exit code says.

use std::process::ExitCode;

use experiments::shortfall::Shortfall;
use metaball::is_trouble;
use thiserror::Error;

/// What whoever started the process may want to know of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ending {
    /// All was done.
    Done,
    /// The run came to its end without what it was asked for.
    Shortfall,
    /// What was given cannot be used, wherever it is tried. So end command lines that make no sense, too.
    Refused,
    /// The machine cannot do it now.
    Trouble,
}

/// The codes, for the help.
pub(crate) const CODES: &str = "\
Exit codes:
  0    done
  1    ran to its end, and what it was to show is not so, or nothing could be measured
  2    the command line, a file or an option cannot be used: the same command would fail again
  75   trouble of the machine, such as a full disk, a missing or lost adapter, a file in use: try again,
       or elsewhere
  101  a fault of this program
Ended by a signal (a shell says 128 and its number; memory that is not there ends it so, by 6 or 9), it
may be tried again. Files are whole or not there.";

/// Trouble that was met on the way, and that did not keep the rest from being done.
#[derive(Debug, Error)]
#[error("{0}")]
pub(crate) struct Trouble(pub(crate) String);

impl Ending {
    pub(crate) fn of(outcome: &anyhow::Result<()>) -> Self {
        match outcome {
            Ok(()) => Self::Done,
            Err(error) if is_machines(error) => Self::Trouble,
            Err(error) if error.is::<Shortfall>() => Self::Shortfall,
            Err(_) => Self::Refused,
        }
    }
}

impl From<Ending> for ExitCode {
    /// 2 is what clap ends with, 75 what `sysexits.h` calls `EX_TEMPFAIL`.
    fn from(ending: Ending) -> Self {
        Self::from(match ending {
            Ending::Done => 0,
            Ending::Shortfall => 1,
            Ending::Refused => 2,
            Ending::Trouble => 75,
        })
    }
}

fn is_machines(error: &anyhow::Error) -> bool {
    #[cfg(feature = "viewer")]
    if error.is::<viewer::WindowError>() {
        return true;
    }
    error.is::<Trouble>() || is_trouble(error.as_ref())
}

#[cfg(test)]
mod tests {
    use anyhow::{Context, anyhow};
    use metaball_core::gpu::{GpuError, RenderError};
    use std::io::{Error as IoError, ErrorKind};

    use super::*;

    #[test]
    fn endings_follow_from_errors_and_their_causes() {
        let of = |error: anyhow::Error| Ending::of(&Err(error));
        assert_eq!(Ending::of(&Ok(())), Ending::Done);
        assert_eq!(of(anyhow!("--hits: needed one scene, found two")), Ending::Refused);
        assert_eq!(of(Shortfall("no certificate".to_owned()).into()), Ending::Shortfall);
        assert_eq!(of(Trouble("a frame".to_owned()).into()), Ending::Trouble);
        let choice = metaball_core::gpu::AdapterChoice::Hardware;
        assert_eq!(of(GpuError::NoAdapter { choice, found: Vec::new() }.into()), Ending::Trouble);
        let lost = Err::<(), _>(RenderError::DeviceLost { text: String::new() });
        assert_eq!(Ending::of(&lost.context("scene molecule")), Ending::Trouble);
        let read = |kind: ErrorKind| Err::<(), _>(IoError::from(kind)).context("cannot read a");
        assert_eq!(Ending::of(&read(ErrorKind::StorageFull)), Ending::Trouble);
        assert_eq!(Ending::of(&read(ErrorKind::NotFound)), Ending::Refused);
    }
}
