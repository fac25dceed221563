//! Running other programs, and speaking to the person who runs this one.

use std::process::Command;

/// Tells the person something.
#[allow(clippy::print_stdout, reason = "this is where the front speaks to its user")]
pub(crate) fn say(text: &str) {
    println!("{}", text.trim_end());
}

/// Tells the person what went wrong.
pub(crate) fn complain(text: &str) {
    eprintln!("xtask: {text}");
}

/// The cargo that runs us, or the one on the path.
pub(crate) fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// The binary `metaball`, in release mode, with these arguments.
pub(crate) fn metaball(arguments: &[String]) -> Result<(), String> {
    let mut command = cargo();
    quieten(&mut command);
    command.args(["run", "--release", "--package", "metaball-cli", "--bin", "metaball", "--"]);
    let status = command.args(arguments).status();
    match status.map_err(|error| format!("cargo could not be started: {error}"))?.code() {
        Some(0) => Ok(()),
        // It has said why already.
        Some(code) => std::process::exit(code),
        None => Err("metaball was ended by a signal".to_owned()),
    }
}

/// Mesa complains at every adapter it opens where nobody has named a folder for its sockets, which
/// nothing here uses.
pub(crate) fn quieten(command: &mut Command) {
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        command.env("XDG_RUNTIME_DIR", std::env::temp_dir());
    }
}

/// Runs a program to its end; its output goes to ours.
pub(crate) fn to_the_end(command: &mut Command) -> Result<(), String> {
    let name = format!("{command:?}").replace('"', "");
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{name}: {status}")),
        Err(error) => Err(format!("{name} could not be started: {error}")),
    }
}

/// Whether a program runs and ends well; its output is thrown away.
pub(crate) fn succeeds(program: &str, arguments: &[&str]) -> bool {
    Command::new(program).args(arguments).output().is_ok_and(|output| output.status.success())
}
