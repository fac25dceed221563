//! The Python package: built as a wheel by maturin, then passed through pytest and mypy, in an environment
//! of its own below `target`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use crate::run::{say, succeeds, to_the_end};

const CRATE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../crates/metaball-python");
const TARGET: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../target");

/// What Python needs so that an environment can be made: of a version that the wheel is for, with `venv` and
/// `ensurepip`.
const IS_FIT: &str = "import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 10))";

/// Builds the wheel and tests it; says so where there is no Python for it.
pub(crate) fn test() -> Result<(), String> {
    let title = "── the Python package";
    let Some(python) = python() else {
        say(&format!("{title}: not run (it needs Python 3.10 or later with venv and pip)"));
        return Ok(());
    };
    let environment = Environment::in_folder(Path::new(TARGET).join("python"));
    if !environment.is_ready(python)? {
        say(&format!("{title}: not run (pip cannot install what its requirements.txt names)"));
        return Ok(());
    }
    say(title);
    let wheels = Path::new(TARGET).join("wheels");
    // Of another version a wheel would be left beside the new one.
    let _ = fs::remove_dir_all(&wheels);
    let build = ["build", "--profile", "dev", "--compatibility", "off", "--out"];
    to_the_end(environment.run("maturin").args(build).arg(&wheels))?;
    let mut install = environment.run("python");
    install.args(["-m", "pip", "install", "--quiet", "--no-deps", "--force-reinstall"]);
    to_the_end(install.arg(wheel_in(&wheels)?))?;
    let mut pytest = environment.run("pytest");
    // The jobs of docs/many-frames call the command, where it is built.
    let command =
        Path::new(TARGET).join("debug/metaball").with_extension(env::consts::EXE_EXTENSION);
    if command.is_file() {
        pytest.env("METABALL", command);
    }
    to_the_end(pytest.arg("--quiet"))?;
    to_the_end(&mut environment.run("mypy"))
}

/// The name of a Python that is fit.
fn python() -> Option<&'static str> {
    ["python3", "python"].into_iter().find(|python| succeeds(python, &["-c", IS_FIT]))
}

/// The only wheel in a folder.
fn wheel_in(folder: &Path) -> Result<PathBuf, String> {
    let files = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut wheels = files.flatten().map(|file| file.path());
    wheels
        .find(|path| path.extension().is_some_and(|ending| ending == "whl"))
        .ok_or_else(|| format!("{}: needed a wheel, found none", folder.display()))
}

/// A virtual environment.
struct Environment {
    folder: PathBuf,
}

impl Environment {
    fn in_folder(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// Makes it, and installs what the requirements name, unless that is done already. Whether it is done.
    fn is_ready(&self, python: &str) -> Result<bool, String> {
        let requirements = Path::new(CRATE).join("requirements.txt");
        let wanted = fs::read(&requirements)
            .map_err(|error| format!("{}: {error}", requirements.display()))?;
        let installed = self.folder.join("requirements.txt");
        if fs::read(&installed).is_ok_and(|found| found == wanted) {
            return Ok(true);
        }
        to_the_end(Command::new(python).args(["-m", "venv", "--clear"]).arg(&self.folder))?;
        let mut install = self.run("python");
        install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
        if to_the_end(install.arg("--requirement").arg(&requirements)).is_err() {
            return Ok(false);
        }
        fs::write(&installed, wanted)
            .map_err(|error| format!("{}: {error}", installed.display()))?;
        Ok(true)
    }

    /// One of its programs, to be run in the crate's folder.
    fn run(&self, program: &str) -> Command {
        let programs = self.folder.join(if cfg!(windows) { "Scripts" } else { "bin" });
        let mut command = Command::new(programs.join(program));
        command.current_dir(CRATE).env("VIRTUAL_ENV", &self.folder);
        command.env("CARGO_TARGET_DIR", TARGET).env("PIP_DISABLE_PIP_VERSION_CHECK", "1");
        command
    }
}
