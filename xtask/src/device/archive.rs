//! The archive that is taken to another machine.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::run::to_the_end;

/// What it may hold at most: what travels to a machine that is lent for minutes.
const MOST_BYTES: u64 = 60_000_000;

/// The folder in it.
const FOLDER: &str = "metaball-device";

/// Starts the program beside it. Scenes are in the program.
const SCRIPT: &str = "\
#!/bin/sh
# Measures this machine's graphics processor: eight minutes, or as arguments say (run --help).
# Results are in out/device, or where --out says: device.json has all of it, summary.txt says it in short.
exec \"${0%/*}/metaball\" device \"$@\"
";

/// An archive that was written.
pub(super) struct Archive {
    pub(super) path: PathBuf,
    pub(super) bytes: u64,
}

/// Writes it below a folder: the program, the script, and the loader if there is one.
pub(super) fn write(program: &Path, loader: Option<&Path>, out: &Path) -> Result<Archive, String> {
    let folder = out.join(FOLDER);
    let failed = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|error| failed(&folder, error))?;
    }
    let copy = |from: &Path, to: PathBuf| {
        fs::copy(from, &to).map(|_| ()).map_err(|error| failed(&to, error))
    };
    fs::create_dir_all(folder.join("lib")).map_err(|error| failed(&folder, error))?;
    copy(program, folder.join("metaball"))?;
    if let Some(loader) = loader {
        copy(loader, folder.join("lib/libvulkan.so.1"))?;
    }
    let script = folder.join("run");
    fs::write(&script, SCRIPT).map_err(|error| failed(&script, error))?;
    make_executable(&script).map_err(|error| failed(&script, error))?;

    let path = out.join(format!("{FOLDER}.tar.gz"));
    let mut tar = Command::new("tar");
    to_the_end(tar.arg("-czf").arg(&path).arg("-C").arg(out).arg(FOLDER))?;
    let bytes = fs::metadata(&path).map_err(|error| failed(&path, error))?.len();
    if bytes > MOST_BYTES {
        let path = path.display();
        return Err(format!("{path}: needed at most {MOST_BYTES} bytes, found {bytes}"));
    }
    Ok(Archive { path, bytes })
}

#[cfg(unix)]
fn make_executable(file: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(file, fs::Permissions::from_mode(0o755))
}

/// Elsewhere there is no such permission.
#[cfg(not(unix))]
fn make_executable(_: &Path) -> std::io::Result<()> {
    Ok(())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn it_holds_what_starts_without_anything_else() {
        let out = std::env::temp_dir().join(format!("metaball-archive-{}", std::process::id()));
        fs::create_dir_all(&out).expect("a folder");
        let program = out.join("program");
        fs::write(&program, "#!/bin/sh\necho \"$@\"\n").expect("written");
        make_executable(&program).expect("its own");
        let archive = write(&program, Some(&program), &out).expect("packed");
        assert!(archive.bytes > 100);

        let elsewhere = out.join("elsewhere");
        fs::create_dir_all(&elsewhere).expect("a folder");
        let mut tar = Command::new("tar");
        to_the_end(tar.arg("-xzf").arg(&archive.path).arg("-C").arg(&elsewhere)).expect("unpacked");
        let run = elsewhere.join(FOLDER).join("run");
        let output = Command::new(run).arg("--rehearse").env("PATH", "/usr/bin:/bin").output();
        assert_eq!(output.expect("started").stdout, b"device --rehearse\n");
        assert!(elsewhere.join(FOLDER).join("lib/libvulkan.so.1").exists());
        fs::remove_dir_all(&out).expect("its own folder");
    }
}
