//! Packages of Debian and Ubuntu.

use std::process::Command;

use crate::run::{say, succeeds, to_the_end};

/// Installs packages with apt-get where there is one and this user may; says so, and why. Returns whether
/// it did.
pub(crate) fn install(why: &str, packages: &[&str]) -> Result<bool, String> {
    let Some(mut rights) = install_rights() else { return Ok(false) };
    say(&format!("{why}: installing {} with apt-get.", packages.join(", ")));
    to_the_end(rights.args(["apt-get", "update", "-qq"]))?;
    let mut install = install_rights().unwrap_or(rights);
    install.args(["apt-get", "install", "-y", "-qq", "--no-install-recommends"]);
    to_the_end(install.args(packages))?;
    Ok(true)
}

/// A command prefix that may install packages here, if there is one: `env` for root, `sudo -n` for
/// a user who needs no password. Only on systems with apt-get.
fn install_rights() -> Option<Command> {
    if !succeeds("apt-get", &["--version"]) {
        return None;
    }
    let user = Command::new("id").arg("-u").output().ok()?;
    let mut rights = if user.stdout.trim_ascii() == b"0" {
        Command::new("env")
    } else if succeeds("sudo", &["-n", "true"]) {
        let mut sudo = Command::new("sudo");
        sudo.args(["-n", "env"]);
        sudo
    } else {
        return None;
    };
    rights.arg("DEBIAN_FRONTEND=noninteractive");
    Some(rights)
}
