//! What every command's exit code says: done, no result, input that cannot be used, trouble of the machine.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const WATER: &str = "3\nwater\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n";

const DONE: i32 = 0;
const SHORTFALL: i32 = 1;
const REFUSED: i32 = 2;
const TROUBLE: i32 = 75;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("endings").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target folder is writable");
    fs::write(folder.join("b.xyz"), WATER).expect("writable");
    for number in 0..3 {
        fs::write(folder.join(format!("g-{number}.xyz")), WATER).expect("writable");
    }
    folder
}

fn run(folder: &Path, line: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_metaball"));
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    command.current_dir(folder).args(line.split_whitespace()).output().expect("started")
}

/// That commands end with these codes, and say why where that is not 0.
fn end(folder: &Path, endings: &[(&str, i32)]) {
    for (line, wanted) in endings {
        let output = run(folder, line);
        let complaint = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(*wanted), "{line}: {complaint}");
        assert!(*wanted == DONE || !complaint.is_empty(), "{line}");
    }
}

#[test]
fn what_is_done_ends_with_0() {
    let folder = folder("done");
    end(
        &folder,
        &[
            ("--help", DONE),
            ("--version", DONE),
            ("scenes", DONE),
            ("methods", DONE),
            ("render b.xyz --size 40x30 --cpu --hits h.npy", DONE),
            ("animate g-%d.xyz --size 40x30 --cpu", DONE),
            ("convert b.xyz b.csv", DONE),
            ("score b.xyz h.npy", DONE),
            ("compare b.xyz --size 40x30 --cpu --methods fbvh-certified-cpu --frames 1", DONE),
            ("diff out/compare/records.json out/compare/records.json", DONE),
            ("certify --cpu --rays 1000 --quick", DONE),
            ("stability --cpu --quick --cases grazing --methods fbvh-certified-cpu", DONE),
        ],
    );
}

#[test]
fn what_has_no_result_ends_with_1() {
    let folder = folder("shortfall");
    end(
        &folder,
        &[
            ("compare nosuch.xyz --cpu --size 40x30", SHORTFALL),
            ("stability --cpu --quick --methods fbvh", SHORTFALL),
        ],
    );
}

#[test]
fn input_that_cannot_be_used_ends_with_2() {
    let folder = folder("refused");
    fs::write(folder.join("bad.csv"), "x,y,z\n0,zero,0\n").expect("writable");
    fs::write(folder.join("g-1.xyz"), "two\n").expect("writable");
    fs::write(folder.join("hits.npy"), "no array").expect("writable");
    end(
        &folder,
        &[
            ("", REFUSED),
            ("nosuch", REFUSED),
            ("scenes --nosuch", REFUSED),
            ("methods --nosuch", REFUSED),
            ("render nosuch.xyz --cpu", REFUSED),
            ("render bad.csv --cpu", REFUSED),
            ("render b.xyz --cpu --size 0x0", REFUSED),
            ("render b.xyz --cpu --out b.gif", REFUSED),
            ("render b.xyz --cpu --method illes", REFUSED),
            ("render b.xyz --cpu --threshold 1e9 --fov 270", REFUSED),
            ("animate g-%d.xyz --cpu --size 40x30", REFUSED),
            ("animate b.xyz --cpu --size 40x30", REFUSED),
            ("animate g-%d.xyz --cpu --size 40x30 --frames 2..9", REFUSED),
            ("animate g-%d.xyz --cpu --force --skip-existing", REFUSED),
            ("convert nosuch.xyz b.csv", REFUSED),
            ("convert b.xyz b.doc", REFUSED),
            ("score b.xyz hits.npy", REFUSED),
            ("score b.xyz nosuch.npy", REFUSED),
            ("compare b.xyz --methods nosuch", REFUSED),
            ("diff b.xyz b.xyz", REFUSED),
            ("chart --methods nosuch", REFUSED),
            ("stability --cases nosuch", REFUSED),
            ("certify --rays 0", REFUSED),
            ("tables nosuch", REFUSED),
            ("tables gourmel --quick --nosuch", REFUSED),
        ],
    );
}

#[test]
fn an_adapter_that_is_not_there_ends_with_75() {
    let folder = folder("adapter");
    for line in [
        "render b.xyz --adapter Voodoo",
        "animate g-%d.xyz --adapter Voodoo",
        "compare b.xyz --adapter Voodoo",
        "chart --quick --adapter Voodoo",
        "stability --quick --adapter Voodoo",
        "certify --quick --adapter Voodoo",
        "tables gourmel --quick --adapter Voodoo",
        "tables specialisation --quick --adapter Voodoo",
    ] {
        end(&folder, &[(line, TROUBLE)]);
    }
}

/// A full disk, and files whose reading fails.
#[test]
#[cfg(target_os = "linux")]
fn a_device_that_fails_ends_with_75() {
    use std::os::unix::fs::symlink;

    let folder = folder("device");
    let link = |to: &str, name: &str| symlink(to, folder.join(name)).expect("linked");
    let (full, failing) = ("/dev/full", "/proc/self/mem");
    link(full, "full.png");
    link(full, "full-1.png");
    link(full, "full.csv");
    link(failing, "failing.xyz");
    link(failing, "failing.npy");
    link(failing, "failing.json");
    let lines = [
        "render b.xyz --cpu --size 40x30 --out full.png",
        "render failing.xyz --cpu --size 40x30",
        "animate g-%d.xyz --cpu --size 40x30 --frames 1..2 --out full-%d.png",
        "convert b.xyz full.csv",
        "convert failing.xyz b.csv",
        "score b.xyz failing.npy",
        "diff failing.json failing.json",
    ];
    end(&folder, &lines.map(|line| (line, TROUBLE)));
    assert!(!folder.join("out/image.png").exists());

    // One frame that cannot be read now, beside one that never can: the others are drawn.
    fs::remove_file(folder.join("g-1.xyz")).expect("there");
    link(failing, "g-1.xyz");
    fs::write(folder.join("g-2.xyz"), "two\n").expect("writable");
    fs::write(folder.join("g-3.xyz"), WATER).expect("writable");
    end(&folder, &[("animate g-%d.xyz --cpu --size 40x30 --out f-%d.png", TROUBLE)]);
    assert!(folder.join("f-0.png").is_file() && folder.join("f-3.png").is_file());
}

#[test]
#[cfg(all(feature = "viewer", unix, not(target_os = "macos")))]
fn a_window_without_a_display_ends_with_75() {
    end(&folder("window"), &[("view b.xyz", TROUBLE), ("view --size none", REFUSED)]);
}

#[test]
fn the_help_says_the_codes() {
    let folder = folder("help");
    for line in ["--help", "animate --help"] {
        let said = String::from_utf8(run(&folder, line).stdout).expect("text");
        assert!(said.contains("75   trouble of the machine"), "{said}");
    }
}
