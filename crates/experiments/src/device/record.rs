//! `device.json`: all that a run has found out, in one file.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use harness::machine::Provenance;
use harness::record::Adapter;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use super::nvidia::{DeviceUse, Span};
use super::part::Part;
use super::process::{Ended, Job, LOG, OUTPUT, records};
use super::vulkan::Vulkan;
use super::{Options, nvidia};
use crate::unfinished;

/// Name and version of the format of [`DeviceRecord`].
pub const SCHEMA: &str = "metaball-device/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DeviceRecord {
    /// Where it comes from; its format is [`SCHEMA`].
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What draws; `null` where there is no adapter, and the CPU measures what it can.
    pub adapter: Option<Adapter>,
    /// What of Vulkan the machine has, and what it lacks.
    pub vulkan: Vulkan,
    /// What `nvidia-smi` says of the devices; `null` without it.
    pub nvidia: Option<String>,
    /// Seconds that it was given.
    pub allowed_seconds: f64,
    /// Seconds that it has taken so far.
    pub seconds: f64,
    /// The parts that are over.
    pub parts: Vec<PartRecord>,
}

/// A part that is over, however.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PartRecord {
    /// Its name.
    pub name: String,
    /// What it was to find out.
    pub about: String,
    /// Whether it had to fail.
    pub is_canary: bool,
    /// The arguments of this program.
    pub arguments: Vec<String>,
    /// Variables of its environment besides those of the run.
    pub environment: BTreeMap<String, String>,
    /// How it ended.
    pub outcome: Outcome,
    /// Why it ended otherwise than done.
    pub reason: Option<String>,
    /// Seconds that it was given.
    pub allowed_seconds: f64,
    /// Seconds that it took.
    pub seconds: f64,
    /// Most main memory of its process; `null` where the system does not say.
    pub host_peak_bytes: Option<u64>,
    /// What the device had and did meanwhile.
    pub device: Option<DeviceUse>,
    /// What it printed as its result.
    pub output: String,
    /// The end of what it printed about how it went.
    pub log: String,
    /// Its files of records, by name; those of a part that was cut short are as far as it came.
    pub records: BTreeMap<String, Value>,
}

/// How a part ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// By itself, well.
    Done,
    /// With an error or a signal.
    Failed,
    /// At the end of its time.
    CutShort,
    /// It needs what there is not.
    NotBegun,
}

impl Outcome {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Failed => "failed",
            Self::CutShort => "cut short",
            Self::NotBegun => "not begun",
        }
    }
}

impl DeviceRecord {
    pub(super) fn begin(options: &Options, vulkan: Vulkan) -> Self {
        Self {
            provenance: Provenance::here(SCHEMA),
            adapter: vulkan.adapter.clone(),
            vulkan,
            nvidia: nvidia::describe(),
            allowed_seconds: options.time.as_secs_f64(),
            seconds: 0.0,
            parts: Vec::new(),
        }
    }

    /// What is wrong with the run: parts that failed, and canaries that did not. A part that was cut short
    /// or not begun has a reason in the record, and is no fault.
    pub fn troubles(&self) -> Vec<String> {
        let trouble = |part: &PartRecord| match (part.is_canary, part.outcome) {
            (true, Outcome::Done | Outcome::NotBegun) => {
                Some(format!("{}: needed to fail, and is {}", part.name, part.outcome.words()))
            }
            (false, Outcome::Failed) => {
                Some(format!("{}: {}", part.name, part.reason.as_deref().unwrap_or("failed")))
            }
            _ => None,
        };
        self.parts.iter().filter_map(trouble).collect()
    }
}

/// The most of a log that is kept, bytes of its end.
const LOG_BYTES: usize = 8192;

impl PartRecord {
    /// A part whose process has ended, with all that it has left in its folder.
    pub(super) fn of(part: &Part, job: &Job, ended: Ended, folder: &Path) -> Self {
        let text = |name: &str| fs::read_to_string(folder.join(name)).unwrap_or_default();
        Self {
            arguments: job.arguments.clone(),
            outcome: ended.outcome,
            reason: ended.reason,
            allowed_seconds: job.allowed.as_secs_f64(),
            seconds: ended.seconds,
            host_peak_bytes: ended.host_peak_bytes,
            device: ended.device,
            output: text(OUTPUT),
            log: end_of(&text(LOG)).to_owned(),
            records: records_in(folder),
            ..Self::unmeasured(part)
        }
    }

    /// A part without a process.
    pub(super) fn not_begun(part: &Part, reason: &str) -> Self {
        Self { reason: Some(reason.to_owned()), ..Self::unmeasured(part) }
    }

    fn unmeasured(part: &Part) -> Self {
        Self {
            name: part.name.to_owned(),
            about: part.about.to_owned(),
            is_canary: part.is_canary,
            arguments: Vec::new(),
            environment: part.environment.clone(),
            outcome: Outcome::NotBegun,
            reason: None,
            allowed_seconds: 0.0,
            seconds: 0.0,
            host_peak_bytes: None,
            device: None,
            output: String::new(),
            log: String::new(),
            records: BTreeMap::new(),
        }
    }
}

fn end_of(log: &str) -> &str {
    &log[log.ceil_char_boundary(log.len().saturating_sub(LOG_BYTES))..]
}

/// What is in the files of records, by name.
fn records_in(folder: &Path) -> BTreeMap<String, Value> {
    let named = |path: PathBuf| {
        let name = path.file_name()?.to_str()?.to_owned();
        Some((name, unfinished::read(&path)?))
    };
    records(folder).filter_map(named).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::part::{Scale, plan};

    fn record_of(outcomes: [(bool, Outcome); 2]) -> DeviceRecord {
        let options = Options {
            scale: Scale::Rehearsal,
            time: std::time::Duration::from_secs(1),
            adapter: metaball_core::gpu::AdapterChoice::Environment,
            out: "unused".into(),
        };
        let mut record = DeviceRecord::begin(&options, Vulkan::default());
        let part = &plan(Scale::Rehearsal, true)[0];
        record.parts = outcomes
            .map(|(is_canary, outcome)| PartRecord {
                is_canary,
                outcome,
                ..PartRecord::not_begun(part, "why")
            })
            .into();
        record
    }

    #[test]
    fn a_part_must_not_fail_and_a_canary_must() {
        let good = record_of([(false, Outcome::Done), (true, Outcome::Failed)]);
        assert_eq!(good.troubles(), Vec::<String>::new());
        let cut = record_of([(false, Outcome::CutShort), (true, Outcome::CutShort)]);
        assert_eq!(cut.troubles(), Vec::<String>::new());
        let bad = record_of([(false, Outcome::Failed), (true, Outcome::Done)]);
        assert_eq!(bad.troubles(), ["panic: why", "panic: needed to fail, and is done"]);
        assert_eq!(crate::testing::read_back(&bad), bad);
    }

    #[test]
    fn of_a_log_the_end_is_kept() {
        assert_eq!(end_of("short"), "short");
        let long = "é".repeat(LOG_BYTES);
        assert_eq!(end_of(&long).len(), LOG_BYTES);
        let odd = format!("{long}x");
        assert_eq!(end_of(&odd).len(), LOG_BYTES - 1);
    }
}
