//! `cargo xtask test`: everything that must hold before a change is taken.

use std::path::{Path, PathBuf};
use std::time::Instant;
use std::{env, fs};

use crate::adapter::{self, Adapter};
use crate::display;
use crate::python;
use crate::run::{cargo, quieten, say, succeeds, to_the_end};

/// What users may take from the registry. Before the first release they pack only together: each
/// is found by the next as a freshly packed archive.
const PUBLISHED: [&str; 3] = ["metaball-shaders", "metaball-core", "fbvh"];

/// One thing to check: what it is called, cargo's arguments, and environment variables.
struct Step {
    title: &'static str,
    arguments: Vec<&'static str>,
    environment: Vec<(&'static str, &'static str)>,
}

/// Runs all steps, the quick ones first, and stops at the first that fails. Arguments go to
/// `cargo test`, which then is the only step.
pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    let adapter = adapter::ensure()?;
    display::ensure()?;
    // Tests that need an adapter fail without one when this is set, and show as ignored otherwise.
    let environment = (adapter == Adapter::Found).then_some(("REQUIRE_GPU", "1"));
    if !arguments.is_empty() {
        let mut command = cargo();
        command.arg("test").args(arguments).envs(environment);
        quieten(&mut command);
        return to_the_end(&mut command);
    }

    forget_packed();
    let lock = concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.lock");
    fs::copy(lock, Path::new(OWN_METHOD).with_file_name("Cargo.lock"))
        .map_err(|error| format!("Cargo.lock: cannot be copied to tests/own-method: {error}"))?;
    for step in steps(environment) {
        say(&format!("── {}", step.title));
        let mut command = cargo();
        command.args(&step.arguments).envs(step.environment);
        quieten(&mut command);
        timed(|| to_the_end(&mut command))?;
    }
    timed(python::test)?;
    if succeeds("cargo", &["deny", "--version"]) {
        say("── licences, bans and sources");
        to_the_end(cargo().args(["deny", "check", "licenses", "bans", "sources"]))?;
    } else {
        say("── licences, bans and sources: not checked (cargo install cargo-deny)");
    }

    match adapter {
        Adapter::Found => Ok(()),
        Adapter::Missing => Err("no adapter: the tests shown as ignored did not run, \
            so they have not passed; install one as said above"
            .to_owned()),
    }
}

/// Says how long a step took, so that whoever waits sees for what.
fn timed(step: impl FnOnce() -> Result<(), String>) -> Result<(), String> {
    let start = Instant::now();
    let result = step();
    say(&format!("   {:.0} s", start.elapsed().as_secs_f64()));
    result
}

/// A method in a crate of its own, outside of the workspace. It takes the workspace's versions of
/// dependencies and its target folder, so that little is built twice.
const OWN_METHOD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/own-method/Cargo.toml");
const OWN_FORMATTING: [&str; 4] = ["fmt", "--manifest-path", OWN_METHOD, "--check"];
const TARGET: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../target");

/// Where packing checks its packages: a folder of its own, new each time.
const PACKAGES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../target/packages");

/// Removes what is left of an earlier packing, here and where cargo unpacked it: cargo takes a version
/// for unchanging, and would check today's fbvh against yesterday's metaball-core. What cannot be
/// removed is left; then the packing says what is wrong.
fn forget_packed() {
    let _ = fs::remove_dir_all(PACKAGES);
    let home = env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(env::home_dir()?.join(".cargo")));
    // Registries without a host's name are folders of archives, as the one that packing makes.
    let local = |path: &PathBuf| {
        path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"-"))
    };
    let entries = |folder: PathBuf| fs::read_dir(folder).into_iter().flatten().flatten();
    let Some(home) = home else { return };
    for registry in entries(home.join("registry/src")).map(|entry| entry.path()).filter(local) {
        for unpacked in entries(registry) {
            let name = unpacked.file_name();
            if PUBLISHED.iter().any(|ours| name.to_string_lossy().starts_with(ours)) {
                let _ = fs::remove_dir_all(unpacked.path());
            }
        }
    }
}

fn steps(gpu: Option<(&'static str, &'static str)>) -> Vec<Step> {
    let mut package = vec!["package", "--quiet", "--allow-dirty", "--target-dir", PACKAGES];
    package.extend(PUBLISHED.into_iter().flat_map(|name| ["--package", name]));
    // A program of one call, which the page is made with, and a minute of other people's code.
    let tests = ["test", "--workspace", "--exclude=wasm-bind", "--all-features", "--no-fail-fast"];
    let mut own =
        vec!["test", "--quiet", "--manifest-path", OWN_METHOD, "--target-dir", TARGET, "--"];
    own.extend(gpu.map(|_| "--include-ignored"));
    let step = |title, arguments: &[&'static str], environment: &[_]| Step {
        title,
        arguments: arguments.to_vec(),
        environment: environment.to_vec(),
    };
    vec![
        step("formatting", &["fmt", "--all", "--check"], &[]),
        step("formatting of a method of one's own", &OWN_FORMATTING, &[]),
        step(
            "lints",
            &["clippy", "--workspace", "--all-targets", "--all-features", "--", "-Dwarnings"],
            &[],
        ),
        step("tests", &tests, gpu.as_slice()),
        step("a method of one's own", &own, gpu.as_slice()),
        step(
            "documentation",
            &["doc", "--workspace", "--all-features", "--no-deps"],
            &[("RUSTDOCFLAGS", "-Dwarnings")],
        ),
        // They are compiled, and nothing of them is run.
        step("packages", &package, &[("CARGO_PROFILE_DEV_OPT_LEVEL", "0")]),
    ]
}
