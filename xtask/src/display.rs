//! What tests of the window need beyond Rust: a display that shows nothing to anybody, and OpenGL on it.

use crate::packages::install;
use crate::run::{say, succeeds};

/// The display, Mesa's OpenGL in software, and the libraries that windows are opened with.
const PACKAGES: [&str; 9] = [
    "xvfb",
    "libgl1-mesa-dri",
    "libgl1",
    "libegl1",
    "libx11-xcb1",
    "libxkbcommon-x11-0",
    "libxi6",
    "libxcursor1",
    "libxrandr2",
];

/// Looks for Xvfb on Linux; installs it where that is possible and allowed. Without it the tests that need
/// it show as ignored.
pub(crate) fn ensure() -> Result<(), String> {
    if cfg!(not(target_os = "linux")) || succeeds("Xvfb", &["-help"]) {
        return Ok(());
    }
    if !install("No Xvfb was found", &PACKAGES)? {
        say(
            "No Xvfb was found: the window is tested without a display. It is in the packages xvfb (Debian, \
             Ubuntu), xorg-x11-server-Xvfb (Fedora, openSUSE) and xorg-server-xvfb (Arch).",
        );
    }
    Ok(())
}
