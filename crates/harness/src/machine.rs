//! Where and from what a number comes: machine, commit and command.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde::{Deserialize, Serialize};

/// The head of a file of numbers: its format, and where its numbers come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Name and version of the file's format.
    pub schema: String,
    /// The command that made the file.
    pub command: String,
    /// The commit that it was built from, or `unknown`.
    pub commit: String,
    /// The computer it ran on.
    pub machine: Machine,
}

impl Provenance {
    /// Of a file in that format, made by this process.
    pub fn here(schema: &str) -> Self {
        Self {
            schema: schema.to_owned(),
            command: command(),
            commit: commit(),
            machine: Machine::here(),
        }
    }

    /// Whether both are of one format, command and machine, up to the program.
    pub fn is_like(&self, other: &Self) -> bool {
        *self == Self { commit: self.commit.clone(), ..other.clone() }
    }
}

/// The computer, as far as the system reports it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Model of the processor.
    pub cpu: String,
    /// Cores that this process may use.
    pub cores: usize,
    /// Bytes of main memory; `null` where the system does not say.
    pub memory_bytes: Option<u64>,
    /// Operating system and, on Linux, its kernel.
    pub os: String,
}

impl Machine {
    /// This machine.
    pub fn here() -> Self {
        let read = |path| fs::read_to_string(path).unwrap_or_default();
        Self {
            cpu: cpu(&read("/proc/cpuinfo")),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            memory_bytes: memory_bytes(&read("/proc/meminfo")),
            os: os(&read("/etc/os-release"), read("/proc/sys/kernel/osrelease").trim()),
        }
    }
}

/// The commit this program was built from, with `-dirty` when the tree had changes: as the variable
/// `METABALL_COMMIT` said when it was built, or else as git says now; `unknown` where the sources or git
/// are gone.
pub fn commit() -> String {
    option_env!("METABALL_COMMIT").map_or_else(commit_of_sources, str::to_owned)
}

fn commit_of_sources() -> String {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR"));
    Command::new("git")
        .args(["describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"])
        .current_dir(if sources.is_dir() { sources } else { Path::new(".") })
        .output()
        .ok()
        .filter(|output| output.status.success())
        .and_then(|output| String::from_utf8(output.stdout).ok())
        .map(|text| text.trim().to_owned())
        .filter(|text| !text.is_empty())
        .unwrap_or_else(|| "unknown".to_owned())
}

/// The command line as one would type it, with `metaball` instead of the program's path.
fn command() -> String {
    let words = std::env::args().skip(1).map(|word| quoted(&word));
    std::iter::once("metaball".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Whether an adapter of that name is a chip for computing that has next to no raster hardware:
/// NVIDIA's from the A100 on, AMD's Instinct.
pub fn has_little_raster(adapter: &str) -> bool {
    const CHIPS: [&str; 9] =
        ["A100", "A800", "H100", "H200", "H800", "GH200", "B100", "B200", "Instinct"];
    CHIPS.iter().any(|chip| adapter.contains(chip))
}

/// A word as a POSIX shell reads it back.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,=+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

fn cpu(cpuinfo: &str) -> String {
    field(cpuinfo, "model name", ':')
        .or_else(|| std::env::var("PROCESSOR_IDENTIFIER").ok())
        .unwrap_or_else(|| format!("unknown {}", std::env::consts::ARCH))
}

fn memory_bytes(meminfo: &str) -> Option<u64> {
    let kibibytes: u64 =
        field(meminfo, "MemTotal", ':')?.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}

fn os(os_release: &str, kernel: &str) -> String {
    let name =
        field(os_release, "PRETTY_NAME", '=').unwrap_or_else(|| std::env::consts::OS.to_owned());
    if kernel.is_empty() { name } else { format!("{name}, kernel {kernel}") }
}

/// The value after `key` and the separator on a line of its own, without quotes around it.
fn field(text: &str, key: &str, separator: char) -> Option<String> {
    text.lines().find_map(|line| {
        let (name, value) = line.split_once(separator)?;
        (name.trim() == key).then(|| value.trim().trim_matches('"').to_owned())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linux_files_are_understood() {
        assert_eq!(cpu("processor\t: 0\nmodel name\t: Quick 9000\n"), "Quick 9000");
        assert_eq!(memory_bytes("MemTotal:       16 kB\n"), Some(16_384));
        assert_eq!(memory_bytes(""), None);
        assert_eq!(os("ID=x\nPRETTY_NAME=\"X 1\"\n", "6.1"), "X 1, kernel 6.1");
        assert_eq!(os("", ""), std::env::consts::OS);
    }

    #[test]
    fn words_are_quoted_when_they_must_be() {
        assert_eq!(quoted("--size"), "--size");
        assert_eq!(quoted("scattered:50000"), "scattered:50000");
        assert_eq!(quoted("my file's"), r"'my file'\''s'");
        assert_eq!(quoted(""), "''");
    }
}
