//! Frames that many processes draw together: the same files whoever draws them, in whatever parts.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("frames").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target folder is writable");
    folder
}

/// `metaball animate` in a folder, on the CPU.
fn animate(folder: &Path, threads: u32, line: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_metaball"));
    let scene = "animate tornado:300 --cpu --size 48x36 --shadows --out f-%02d.png";
    command.current_dir(folder).args(scene.split(' ')).args(line.split(' '));
    let output = command.env("RAYON_NUM_THREADS", threads.to_string()).output().expect("started");
    assert!(output.status.success(), "{line}: {}", text(&output.stderr));
    output
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The pictures in a folder.
fn pictures(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = fs::read_dir(folder).expect("readable").map(|file| file.expect("readable").path());
    let name = |path: &Path| path.file_name().expect("a file").to_string_lossy().into_owned();
    files
        .filter(|path| path.extension().is_some_and(|ending| ending == "png"))
        .map(|path| (name(&path), fs::read(&path).expect("readable")))
        .collect()
}

#[test]
fn frames_are_the_same_however_they_are_spread() {
    let whole = folder("whole");
    animate(&whole, 1, "--frames 0..6");
    let wanted = pictures(&whole);
    assert_eq!(wanted.len(), 6);
    assert!(wanted["f-00.png"] != wanted["f-01.png"], "the scene moves");
    let spread = |name: &str, jobs: &[(u32, &str)]| {
        let folder = folder(name);
        jobs.iter().for_each(|(threads, line)| drop(animate(&folder, *threads, line)));
        assert!(pictures(&folder) == wanted, "{name}");
    };
    spread("threads", &[(3, "--frames 0..6")]);
    spread("halves", &[(2, "--frames 3..6"), (1, "--frames 0..3")]);
    spread("strides", &[(1, "--frames 1..6 --every 2"), (2, "--frames 0..6 --every 2 --in-turn")]);
}

#[test]
fn frames_that_are_there_are_left_and_counted() {
    let folder = folder("kept");
    animate(&folder, 1, "--frames 0..2 --samples 1");
    let before = pictures(&folder);
    let said = text(&animate(&folder, 1, "--frames 0..3 --skip-existing").stdout);
    assert!(said.contains("1 frames in ") && said.contains("; 2 were there already"), "{said}");
    let after = pictures(&folder);
    assert!(before.iter().all(|(name, bytes)| after[name] == *bytes) && after.len() == 3);
    // Drawn with other options, they are drawn anew unless that is said.
    let said = text(&animate(&folder, 1, "--frames 0..3").stdout);
    assert!(said.contains("2 frames in ") && said.contains("; 1 were there already"), "{said}");
    assert!(pictures(&folder)["f-00.png"] != before["f-00.png"]);
}

#[test]
fn a_log_has_a_line_for_each_frame() {
    let log = text(&animate(&folder("log"), 1, "--frames 2..5").stderr);
    let lines: Vec<_> = log.lines().filter(|line| line.contains(" of 3: frame ")).collect();
    assert_eq!(lines.len(), 3, "{log}");
    for (line, begins) in lines.iter().zip(["1 of 3: frame 2 ", "2 of 3: frame 3 ", "3 of 3: "]) {
        assert!(line.starts_with(begins), "{log}");
    }
}

/// Killed at any time, a run leaves whole pictures, and what another makes of them is one run's.
#[test]
#[cfg(unix)]
fn a_killed_run_is_finished_by_the_next() {
    use std::process::Stdio;
    use std::thread::sleep;
    use std::time::{Duration, Instant};

    let (whole, killed) = (folder("at-one-go"), folder("killed"));
    let scene = "animate tornado:300 --cpu --size 160x120 --shadows --samples 4 --frames 0..12 \
                 --out f-%02d.png";
    let command = |folder: &Path| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_metaball"));
        command.current_dir(folder).args(scene.split_whitespace()).stderr(Stdio::null());
        command.stdout(Stdio::null());
        command
    };
    assert!(command(&whole).status().expect("started").success());
    let wanted = pictures(&whole);
    let mut interruptions = 0;
    for frames in [2, 5, 8] {
        let mut run = command(&killed).spawn().expect("started");
        let start = Instant::now();
        while pictures(&killed).len() < frames && start.elapsed() < Duration::from_secs(60) {
            sleep(Duration::from_millis(5));
        }
        run.kill().expect("a process of ours");
        interruptions += u32::from(!run.wait().expect("ended").success());
        for (name, bytes) in pictures(&killed) {
            assert!(wanted[&name] == bytes, "{name} is half");
        }
    }
    assert!(interruptions > 0, "no run was killed in the middle");
    assert!(command(&killed).status().expect("started").success());
    assert!(pictures(&killed) == wanted);
}

/// The list of commands of docs/many-frames, run as its head says.
#[test]
#[cfg(target_os = "linux")]
fn a_list_of_commands_draws_all_frames() {
    use std::io::Write;
    use std::process::Stdio;

    let commands = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/many-frames/commands.sh");
    let programs = Path::new(env!("CARGO_BIN_EXE_metaball")).parent().expect("a folder");
    let path = std::env::var("PATH").unwrap_or_default();
    let path = format!("{}:{path}", programs.display());
    let (whole, folder) = (folder("in-one"), folder("in a 'list'"));
    animate(&whole, 2, "--frames 0..5");
    let arguments = "0 5 2 tornado:300 --size 48x36 --shadows --out";
    let out = folder.join("f-%02d.png");
    let list = Command::new("sh").arg(commands).args(arguments.split(' ')).arg(&out).output();
    let list = list.expect("a shell").stdout;
    assert_eq!(text(&list).lines().count(), 3, "{}", text(&list));
    let mut workers = Command::new("xargs")
        .args(["-d", "\\n", "-P", "2", "-n", "1", "sh", "-c"])
        .env("PATH", &path)
        .stdin(Stdio::piped())
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .expect("xargs");
    workers.stdin.take().expect("a pipe").write_all(&list).expect("read");
    assert!(workers.wait().expect("ended").success());
    assert!(pictures(&folder) == pictures(&whole));
}

/// What retries a command does so where it helps, and ends as the command's last run.
#[test]
#[cfg(unix)]
fn trouble_is_tried_again_and_bad_input_is_not() {
    let retry = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/many-frames/retry.sh");
    let folder = folder("retry");
    let runs = |script: &str| {
        let _ = fs::remove_file(folder.join("runs"));
        let counted = format!("echo run >> runs; n=$(wc -l < runs); {script}");
        let mut command = Command::new("sh");
        command.arg(retry).args(["sh", "-c", &counted]).current_dir(&folder).env("PAUSE", "0");
        let code = command.status().expect("a shell").code();
        (code, fs::read_to_string(folder.join("runs")).expect("written").lines().count())
    };
    assert_eq!(runs("exit 0"), (Some(0), 1));
    assert_eq!(runs("exit 2"), (Some(2), 1));
    assert_eq!(runs("exit 75"), (Some(75), 4));
    assert_eq!(runs("[ $n -gt 2 ] || exit 75"), (Some(0), 3));
    assert_eq!(runs("[ $n -gt 1 ] || kill -9 $$"), (Some(0), 2));
}
