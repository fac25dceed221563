//! `cargo xtask device`: measures a graphics processor, here or, from an archive, on another machine.

mod archive;
mod glibc;

use std::fs;
use std::path::Path;

use crate::adapter;
use crate::run::{cargo, say, to_the_end};

/// The program without its window: it needs libc, and Vulkan's loader once it runs.
const PROGRAM: [&str; 6] =
    ["--package", "metaball-cli", "--no-default-features", "--bin", "metaball", "--profile"];

/// Measures here, or packs what measures elsewhere.
pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    match arguments {
        [only] if only == "--pack" => pack(),
        _ if arguments.iter().any(|argument| argument == "--pack") => {
            Err("device --pack: needed no other argument".to_owned())
        }
        _ => measure(arguments),
    }
}

fn measure(arguments: &[String]) -> Result<(), String> {
    adapter::ensure()?;
    let mut command = cargo();
    crate::run::quieten(&mut command);
    command.arg("run").args(PROGRAM).args(["release", "--", "device"]).args(arguments);
    to_the_end(&mut command)
}

/// Builds the program without symbols, and packs it with the loader of this machine and a script.
fn pack() -> Result<(), String> {
    let root = root();
    let target = root.join("target");
    let mut build = cargo();
    build.env("METABALL_COMMIT", commit()).arg("build").args(PROGRAM).arg("packed");
    to_the_end(build.arg("--target-dir").arg(&target))?;
    let program = target.join("packed").join("metaball");
    let loader = adapter::loader();
    let archive = archive::write(&program, loader.as_deref(), &root.join("out"))?;
    say(&format!(
        "{}: {:.1} MB; needs {}{}.\nUnpacked elsewhere: metaball-device/run",
        archive.path.display(),
        archive.bytes as f64 / 1e6,
        glibc::needed(&read(&program)?),
        match loader {
            Some(_) => "; brings Vulkan's loader where there is none",
            None => " and Vulkan's loader, of which this machine has none to bring",
        },
    ));
    Ok(())
}

fn read(file: &Path) -> Result<Vec<u8>, String> {
    fs::read(file).map_err(|error| format!("{}: {error}", file.display()))
}

/// The folder of the workspace.
fn root() -> &'static Path {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().unwrap_or(own)
}

/// The commit of the sources, which git cannot say where the program runs.
fn commit() -> String {
    let arguments = ["describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"];
    let output = std::process::Command::new("git").args(arguments).current_dir(root()).output();
    let text = output.ok().filter(|output| output.status.success());
    let text = text.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    text.unwrap_or_else(|| "unknown".to_owned())
}
