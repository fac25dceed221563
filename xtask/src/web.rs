//! The page: the viewer as WebAssembly with the page around it, in one folder.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::packages::install;
use crate::run::{cargo, say, succeeds, to_the_end};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// What is compiled for, with the vectors that all browsers have had since 2023.
const TARGET: &str = "wasm32-unknown-unknown";
const VECTORS: (&str, &str) =
    ("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", "-Ctarget-feature=+simd128");

/// The folder that is made, the page's own files, and the molecule that it begins with.
const FOLDER: &str = "out/web";
const SITE: &str = "crates/page/site";
const MOLECULE: &str = "bench-scenes/data/md_1u19.pdb.gz";

/// Makes the folder; with `--test` a browser opens it too.
pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    let tests = match arguments {
        [] => false,
        [test] if test == "--test" => true,
        _ => return Err(format!("web: needed nothing or --test, found {}", arguments.join(" "))),
    };
    ensure_target()?;
    let folder = Path::new(ROOT).join(FOLDER);
    make(&folder)?;
    say(&format!(
        "{FOLDER}: {:.1} MB. Any web server shows it: python3 -m http.server --directory {FOLDER}",
        bytes_in(&folder)? as f64 / 1e6
    ));
    if tests { test(&folder) } else { Ok(()) }
}

/// Adds the target, by rustup or from the packages of Debian's own Rust.
fn ensure_target() -> Result<(), String> {
    if has_target() {
        return Ok(());
    }
    if succeeds("rustup", &["--version"]) {
        to_the_end(Command::new("rustup").args(["target", "add", TARGET]))?;
    } else {
        install(&format!("Rust has no target {TARGET}"), &["libstd-rust-dev-wasm32"])?;
    }
    if has_target() {
        return Ok(());
    }
    Err(format!(
        "web: needed Rust's target {TARGET}, found none; rustup target add {TARGET} brings it, or the package \
         libstd-rust-dev-wasm32 where Rust is Debian's own. The window (view) needs none."
    ))
}

/// Whether there is a standard library for it.
fn has_target() -> bool {
    let mut rustc = Command::new("rustc");
    let asked = rustc.args(["--print", "target-libdir", "--target", TARGET]).output();
    asked.is_ok_and(|answer| {
        let folder = String::from_utf8_lossy(&answer.stdout);
        answer.status.success() && Path::new(folder.trim()).is_dir()
    })
}

fn make(folder: &Path) -> Result<(), String> {
    let mut compile = cargo();
    compile.current_dir(ROOT).args(["build", "--release", "--package", "page", "--lib"]);
    compile.args(["--target", TARGET]).env("CARGO_PROFILE_RELEASE_DEBUG", "false");
    to_the_end(compile.envs([VECTORS]))?;

    // Not what an earlier page had and this one has not.
    let _ = fs::remove_dir_all(folder);
    fs::create_dir_all(folder).map_err(of(folder))?;
    let wasm = Path::new(ROOT).join("target").join(TARGET).join("release/page.wasm");
    let mut bind = cargo();
    bind.args(["run", "--quiet", "--package", "wasm-bind", "--"]);
    to_the_end(bind.current_dir(ROOT).arg(wasm).arg(folder))?;

    let site = Path::new(ROOT).join(SITE);
    for entry in fs::read_dir(&site).map_err(of(&site))?.flatten() {
        copy(&entry.path(), &folder.join(entry.file_name()))?;
    }
    copy(&Path::new(ROOT).join(MOLECULE), &folder.join("molecule.pdb.gz"))
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    fs::copy(from, to).map(|_| ()).map_err(of(from))
}

fn of(path: &Path) -> impl Fn(std::io::Error) -> String {
    move |error| format!("{}: {error}", path.display())
}

/// Bytes of all files in a folder and those below it.
fn bytes_in(folder: &Path) -> Result<u64, String> {
    let mut bytes = 0;
    for entry in fs::read_dir(folder).map_err(of(folder))?.flatten() {
        let path = entry.path();
        bytes += if path.is_dir() {
            bytes_in(&path)?
        } else {
            entry.metadata().map_err(of(&path))?.len()
        };
    }
    Ok(bytes)
}

/// Opens the page in a browser without a display, and holds its pictures against the library's.
fn test(folder: &Path) -> Result<(), String> {
    let has_browser =
        || succeeds("chromium", &["--version"]) && succeeds("chromedriver", &["--version"]);
    if !has_browser() {
        install("No Chromium was found", &["chromium", "chromium-driver"])?;
    }
    if !has_browser() {
        return Err(
            "web --test: needed chromium and chromedriver, found none; they are in the packages \
            chromium and chromium-driver (Debian) and chromium (Fedora, Arch)"
                .to_owned(),
        );
    }
    let mut test = cargo();
    test.current_dir(ROOT).args(["test", "--package", "page", "--test", "browser"]);
    to_the_end(test.args(["--", "--ignored"]).env("PAGE_FOLDER", folder))
}
