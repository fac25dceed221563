//! Parts that must be seen to fail: a rehearsal in which they do not has seen nothing.

use std::time::Duration;

/// Ends the process as a fault of this program would.
pub(super) fn panic() -> anyhow::Result<()> {
    panic!("the canary of a rehearsal");
}

/// Does not end.
pub(super) fn hang() -> anyhow::Result<()> {
    loop {
        std::thread::sleep(Duration::from_secs(1));
    }
}
