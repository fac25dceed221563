//! A part as a process of its own, watched and ended in time.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use anyhow::Context;

use super::nvidia::{DeviceUse, Watch};
use super::record::Outcome;

/// A command of this program.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Job {
    pub(super) arguments: Vec<String>,
    /// Variables besides those of this process.
    pub(super) environment: BTreeMap<String, String>,
    /// It is ended after that.
    pub(super) allowed: Duration,
}

/// How it went.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ended {
    pub(super) outcome: Outcome,
    pub(super) reason: Option<String>,
    pub(super) seconds: f64,
    pub(super) host_peak_bytes: Option<u64>,
    pub(super) device: Option<DeviceUse>,
}

/// Files of a part's folder that hold what its process printed.
pub(super) const OUTPUT: &str = "output.txt";
/// See [`OUTPUT`].
pub(super) const LOG: &str = "log.txt";

/// How often a process is looked at.
const INTERVAL: Duration = Duration::from_millis(20);

/// How long one that was killed may take to end: longer where a driver does not let go of it.
const LAST_BREATH: Duration = Duration::from_secs(5);

/// Runs it to its end or that of its time; what it prints goes into the folder.
///
/// # Errors
/// When the folder cannot be written, or this program not be started.
pub(super) fn run_job(job: &Job, folder: &Path) -> anyhow::Result<Ended> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    forget(folder)?;
    let file = |name: &str| {
        let path = folder.join(name);
        File::create(&path).with_context(|| path.display().to_string())
    };
    let watch = Watch::begin();
    let start = Instant::now();
    let mut child = Command::new(std::env::current_exe()?)
        .args(&job.arguments)
        .envs(&job.environment)
        .stdin(Stdio::null())
        .stdout(file(OUTPUT)?)
        .stderr(file(LOG)?)
        .spawn()
        .context("this program could not be started anew")?;
    let mut peak = None;
    let status = loop {
        peak = peak_bytes(child.id()).or(peak);
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if start.elapsed() >= job.allowed {
            break None;
        }
        std::thread::sleep(INTERVAL);
    };
    let (outcome, reason) = match status {
        Some(status) if status.success() => (Outcome::Done, None),
        Some(status) => (Outcome::Failed, Some(why(status, folder))),
        None => (Outcome::CutShort, Some(cut_short(&mut child, job.allowed)?)),
    };
    Ok(Ended {
        outcome,
        reason,
        seconds: start.elapsed().as_secs_f64(),
        host_peak_bytes: peak,
        device: watch.end(),
    })
}

/// Removes the records of an earlier run: what is there afterwards is of this one.
fn forget(folder: &Path) -> anyhow::Result<()> {
    for file in records(folder) {
        fs::remove_file(&file).with_context(|| file.display().to_string())?;
    }
    Ok(())
}

/// The files of JSON in a folder.
pub(super) fn records(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    entries.filter(|path| path.extension().is_some_and(|ending| ending == "json"))
}

fn cut_short(child: &mut Child, allowed: Duration) -> anyhow::Result<String> {
    child.kill()?;
    let killed = Instant::now();
    while child.try_wait()?.is_none() {
        if killed.elapsed() >= LAST_BREATH {
            let allowed = allowed.as_secs_f64();
            return Ok(format!("needed to end within {allowed:.0} s, did not, nor when killed"));
        }
        std::thread::sleep(INTERVAL);
    }
    Ok(format!("needed more than {:.0} s", allowed.as_secs_f64()))
}

/// The last line that it wrote to its log, behind how it ended.
fn why(status: ExitStatus, folder: &Path) -> String {
    let log = fs::read_to_string(folder.join(LOG)).unwrap_or_default();
    let is_word = |line: &&str| !line.trim().is_empty() && !line.starts_with("note: run with");
    let said = log.lines().rev().find(is_word).unwrap_or("it said nothing");
    format!("{status}: {said}")
}

/// The most main memory that a process has had, on Linux.
fn peak_bytes(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(1024 * kibibytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn a_process_has_memory_and_none_that_is_not_there() {
        assert!(peak_bytes(std::process::id()).is_some_and(|bytes| bytes > 1 << 16));
        assert_eq!(peak_bytes(u32::MAX), None);
    }
}
