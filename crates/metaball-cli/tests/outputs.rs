//! What the binary writes, and refuses to, as people run it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const WATER: &str = "3\nwater\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n";

/// A new folder with water in it, and a scene file that names it.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target folder is writable");
    fs::write(folder.join("b.xyz"), WATER).expect("writable");
    fs::write(folder.join("scene.toml"), "particles = 'b.xyz'").expect("writable");
    folder
}

/// Runs the binary in a folder, on the CPU.
fn run(folder: &Path, line: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_metaball"));
    let arguments = line.split_whitespace().chain(["--size", "40x30", "--cpu"]);
    command.current_dir(folder).args(arguments).output().expect("started")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// What is said of a run that ends well.
fn drawn(folder: &Path, line: &str) -> String {
    let output = run(folder, line);
    assert!(output.status.success(), "{line}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// What is said of a run that is refused. It leaves the files that were there, and no other.
fn refused(folder: &Path, line: &str) -> String {
    let files = || {
        let entries = fs::read_dir(folder).expect("readable").map(|entry| entry.expect("readable"));
        let mut files: Vec<_> =
            entries.map(|entry| (entry.path(), fs::read(entry.path()).ok())).collect();
        files.sort();
        files
    };
    let before = files();
    let output = run(folder, line);
    assert!(!output.status.success(), "{line}");
    assert!(files() == before, "{line}");
    text(&output.stderr)
}

#[test]
fn an_input_is_never_written_over() {
    let folder = folder("inputs");
    fs::hard_link(folder.join("b.xyz"), folder.join("hard.png")).expect("linked");
    fs::write(folder.join("sky.exr"), "").expect("writable");
    for (line, what) in [
        ("render b.xyz --out b.xyz", "the scene b.xyz"),
        ("render b.xyz --out ../inputs/b.xyz", "the scene b.xyz"),
        ("render b.xyz --out hard.png", "the scene b.xyz"),
        ("render scene.toml --out hard.png", "the scene b.xyz"),
        ("render scene.toml --out scene.toml", "the scene scene.toml"),
        ("render b.xyz --environment sky.exr --light-out ./sky.exr", "the environment sky.exr"),
        ("render b.xyz --shadows --hits a.exr --light-out a.exr", "the file of hits a.exr"),
    ] {
        let error = refused(&folder, line);
        assert!(error.contains(&format!("found {what}; give another name")), "{line}: {error}");
    }
}

#[test]
fn results_replace_no_input() {
    let folder = folder("results");
    fs::write(folder.join("records.csv"), "x,y,z,radius\n0,0,0,1\n").expect("writable");
    let over = refused(&folder, "compare records.csv --out .");
    assert!(over.contains("for the results, found the scene records.csv"), "{over}");
    assert!(refused(&folder, "compare b.xyz --out b.xyz").contains("b.xyz"));
}

#[test]
#[cfg(unix)]
fn links_stay_and_their_files_are_replaced() {
    use std::os::unix::fs::symlink;

    let folder = folder("links");
    symlink("b.xyz", folder.join("scene.png")).expect("linked");
    assert!(refused(&folder, "render b.xyz --out scene.png").contains("the scene b.xyz"));
    symlink("real.png", folder.join("link.png")).expect("linked");
    drawn(&folder, "render b.xyz --out link.png");
    assert!(folder.join("link.png").is_symlink());
    assert!(fs::read(folder.join("real.png")).expect("written").starts_with(b"\x89PNG"));
}

#[test]
#[cfg(target_os = "linux")]
fn standard_output_takes_the_picture_alone() {
    let folder = folder("stdout");
    let output = run(&folder, "render b.xyz --out /dev/stdout");
    assert!(output.status.success());
    assert!(output.stdout.starts_with(b"\x89PNG") && output.stdout.ends_with(b"IEND\xaeB`\x82"));
    assert!(text(&output.stderr).contains("rays "));
    assert!(drawn(&folder, "render b.xyz --out /dev/null").contains("rays "));
}

#[test]
fn endings_say_the_format_or_are_refused() {
    let folder = folder("endings");
    drawn(&folder, "render b.xyz --out a.jpg");
    assert!(fs::read(folder.join("a.jpg")).expect("written").starts_with(&[0xff, 0xd8, 0xff]));
    for (line, needed) in [
        ("--out a.gif", "needed a picture, .png, .jpg or .jpeg, found .gif"),
        ("--out a", "needed a picture, .png, .jpg or .jpeg, found no ending"),
        ("--out c.png --hits a.png", "needed a file of hits, .exr or .npy, found .png"),
        ("--out c.png --shadows --light-out a.hdr", "needed a file of light, .exr, found .hdr"),
        ("--out a.png/", "needed the path of a file"),
    ] {
        let error = refused(&folder, &format!("render b.xyz {line}"));
        assert!(error.contains(needed), "{line}: {error}");
    }
}

#[test]
fn a_view_from_above_needs_no_up() {
    let folder = folder("above");
    let from_above = "render b.xyz --eye 0,10,0 --look-at 0,0,0";
    drawn(&folder, &format!("{from_above} --out a.png"));
    drawn(&folder, &format!("{from_above} --up 0,0,1 --out b.png"));
    drawn(&folder, &format!("{from_above} --up 1,0,0 --out c.png"));
    let bytes = |name: &str| fs::read(folder.join(name)).expect("written");
    assert!(bytes("a.png") == bytes("b.png") && bytes("a.png") != bytes("c.png"));
    let error = refused(&folder, &format!("{from_above} --up 0,1,0 --out d.png"));
    assert!(error.contains("--up: needed a direction that is not along the view's"), "{error}");
}

#[test]
fn frames_that_are_asked_for_and_not_there_are_an_error_at_the_end() {
    let folder = folder("absent");
    for number in [1, 2, 3, 5] {
        fs::write(folder.join(format!("g-{number}.xyz")), WATER).expect("writable");
    }
    let output = run(&folder, "animate g-%d.xyz --frames 1..9 --out f-%d.png");
    let (says, complaint) = (text(&output.stdout), text(&output.stderr));
    assert!(!output.status.success());
    let wanted = "--frames 1..9: needed frames that are there, found none for 4, 6 to 8";
    assert!(complaint.contains(wanted), "{complaint}");
    assert!(says.contains("4 frames in ") && folder.join("f-5.png").is_file(), "{says}");

    let all = drawn(&folder, "animate g-%d.xyz --out f-%d.png");
    assert!(
        all.contains("0 frames in ") && all.contains("4 were there already; none for 4"),
        "{all}"
    );
    drawn(&folder, "animate g-%d.xyz --frames 1..6 --every 2 --out f-%d.png");
    let over = refused(&folder, "animate g-%d.xyz --out g-%d.xyz");
    assert!(over.contains("found the scene g-1.xyz"), "{over}");
    let sheet = refused(&folder, "animate g-%d.xyz --out f-%d.png --sheet f-2.png");
    assert!(sheet.contains("for the sheet, found the frame f-2.png"), "{sheet}");
}

/// Where an adapter is looked for, Mesa's layer is not heard.
#[test]
fn success_is_not_called_an_error() {
    let folder = folder("quiet");
    let mut command = Command::new(env!("CARGO_BIN_EXE_metaball"));
    let line = "render b.xyz --size 40x30 --out a.png";
    let command = command.current_dir(&folder).args(line.split_whitespace());
    let output = command.env_remove("XDG_RUNTIME_DIR").output().expect("started");
    let complaint = text(&output.stderr);
    assert!(output.status.success() && !complaint.contains("error"), "{complaint}");
    assert!(text(&output.stdout).contains("drawn by"));
}
