//! The command `device`: everything that a graphics processor is to be measured by, in a few minutes, by
//! one command and without a second try.
//!
//! A part is a command of this program, run as a process of its own for no longer than its share of the
//! time: what panics, hangs or loses the device ends its part and no other. After each part the whole
//! [`record`] is written, with what the part has measured so far in it, and a summary beside it. Where
//! [`vulkan`] has no graphics processor to show, the record says what is missing, and the CPU measures what
//! it can.

mod agreement;
mod canary;
mod effects;
mod nvidia;
mod part;
mod process;
pub mod record;
mod sizes;
mod summary;
mod twins;
pub mod vulkan;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Context;
use harness::output::write_json;
use metaball_core::gpu::AdapterChoice;
use picture_files::write_atomically;

pub use self::part::{OwnPart, Scale};
use self::part::{Part, plan};
use self::process::{Job, run_job};
use self::record::{DeviceRecord, PartRecord};
use self::vulkan::Vulkan;
use crate::console;
use crate::outputs::output_files;

/// What to measure.
#[derive(Debug, Clone)]
pub struct Options {
    /// How large.
    pub scale: Scale,
    /// For how long in all.
    pub time: Duration,
    /// What to draw with.
    pub adapter: AdapterChoice,
    /// Folder for `device.json`, `summary.txt`, and a folder for each part.
    pub out: PathBuf,
}

/// Runs all parts, and writes the record and the summary after each.
///
/// # Errors
/// When a file cannot be written; in the end, when a part has failed, or on a rehearsal a canary has not.
pub fn device(options: &Options) -> anyhow::Result<()> {
    let [json, summary] = output_files(&options.out, ["device.json", "summary.txt"], &[], &[])?;
    let start = Instant::now();
    let vulkan = Vulkan::open(&options.out, &options.adapter)?;
    vulkan.missing.iter().for_each(|missing| console::note(missing));
    let mut record = DeviceRecord::begin(options, vulkan);
    let write = |record: &DeviceRecord| -> anyhow::Result<()> {
        write_json(&json, record)?;
        Ok(write_atomically(&summary, summary::summary(record).as_bytes())?)
    };
    write(&record)?;

    let parts = plan(options.scale, record.adapter.is_some());
    let shares: f64 = parts.iter().map(|part| part.share).sum();
    let left = options.time.saturating_sub(start.elapsed()).as_secs_f64();
    // What a part leaves of its time is the next one's.
    let mut end = 0.0;
    let begin = Instant::now();
    for part in parts {
        end += left * part.share / shares;
        let allowed = (end - begin.elapsed().as_secs_f64()).clamp(0.0, part.most);
        record.parts.push(measure(&part, options, &record, Duration::from_secs_f64(allowed))?);
        record.seconds = start.elapsed().as_secs_f64();
        write(&record)?;
    }
    console::line(&summary::table(&record));
    console::line(&format!("\n{}\n{}", json.display(), summary.display()));
    let troubles = record.troubles();
    anyhow::ensure!(troubles.is_empty(), "{}", troubles.join("; "));
    Ok(())
}

/// Runs a part, if there is a command for it here, and takes in what it has written.
fn measure(
    part: &Part,
    options: &Options,
    record: &DeviceRecord,
    allowed: Duration,
) -> anyhow::Result<PartRecord> {
    console::note(&format!(
        "{}: {} ({:.0} s at most)",
        part.name,
        part.about,
        allowed.as_secs_f64()
    ));
    let Some(arguments) = &part.arguments else {
        return Ok(PartRecord::not_begun(part, "needed a graphics adapter, found none"));
    };
    let folder = options.out.join(part.name);
    let mut arguments = arguments.clone();
    if record.adapter.is_some() {
        arguments.extend(adapter_arguments(&options.adapter));
    }
    arguments.extend(["--out".to_owned(), folder.display().to_string()]);
    let mut environment = record.vulkan.environment.clone();
    environment.extend(part.environment.clone());
    let job = Job { arguments, environment, allowed };
    Ok(PartRecord::of(part, &job, run_job(&job, &folder)?, &folder))
}

/// The adapter as the commands of this program are told it.
fn adapter_arguments(choice: &AdapterChoice) -> Vec<String> {
    match choice {
        AdapterChoice::Named(name) => vec!["--adapter".to_owned(), name.clone()],
        AdapterChoice::Software => vec!["--software".to_owned()],
        AdapterChoice::Environment | AdapterChoice::Hardware => Vec::new(),
    }
}

/// Does, in this process, the work of a part that is no other command.
///
/// # Errors
/// As the part; always for one that needs an adapter where `adapter` is `None`.
pub fn run_part(
    part: OwnPart,
    scale: Scale,
    adapter: Option<&AdapterChoice>,
    out: &Path,
) -> anyhow::Result<()> {
    let gpu = adapter.map(console::open_adapter).transpose()?;
    let needed = || gpu.as_ref().context("needed a graphics adapter, found none");
    match part {
        OwnPart::Adapter => vulkan::write_adapter(needed()?, out),
        OwnPart::Agreement => agreement::measure(gpu.as_ref(), scale, out),
        OwnPart::Light => twins::measure(needed()?, scale, out),
        OwnPart::Sizes => sizes::measure(gpu.as_ref(), scale, out),
        OwnPart::Effects => effects::measure(needed()?, scale, out),
        OwnPart::Panic => canary::panic(),
        OwnPart::Hang => canary::hang(),
    }
}
