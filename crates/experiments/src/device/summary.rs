//! `summary.txt`: the run at a glance, and what each part printed.

use harness::numbers::decimal;

use super::record::{DeviceRecord, Outcome, PartRecord, Span};
use crate::console;

/// All of it, in the marks of Markdown.
pub(super) fn summary(record: &DeviceRecord) -> String {
    let mut text = format!("# {}\n\n{}\n", title(record), facts(record));
    for missing in &record.vulkan.missing {
        text += &format!("- missing: {missing}\n");
    }
    text += &format!("\n```text\n{}\n```\n", table(record));
    for part in &record.parts {
        text += &section(part);
    }
    text
}

/// A line for each part.
pub(super) fn table(record: &DeviceRecord) -> String {
    let headings =
        ["part", "outcome", "seconds", "of", "host MiB", "device MiB", "clock MHz", "°C", "W"];
    let row = |part: &PartRecord| {
        let device = part.device.as_ref();
        let outcome = match part.is_canary {
            true => format!("{} (canary)", part.outcome.words()),
            false => part.outcome.words().to_owned(),
        };
        let mebibytes = part.host_peak_bytes.map(|bytes| (bytes >> 20).to_string());
        vec![
            part.name.clone(),
            outcome,
            decimal(part.seconds),
            decimal(part.allowed_seconds),
            mebibytes.unwrap_or_else(dash),
            device.and_then(|device| device.memory_mib).map_or_else(dash, most),
            device.and_then(|device| device.clock_mhz).map_or_else(dash, span),
            device.and_then(|device| device.celsius).map_or_else(dash, most),
            device.and_then(|device| device.watts).map_or_else(dash, most),
        ]
    };
    console::table(&headings, &record.parts.iter().map(row).collect::<Vec<_>>())
}

fn title(record: &DeviceRecord) -> String {
    match &record.adapter {
        Some(adapter) => format!("Measured on {adapter}"),
        None => "Measured without a graphics adapter".to_owned(),
    }
}

fn facts(record: &DeviceRecord) -> String {
    let machine = &record.provenance.machine;
    let memory = machine.memory_bytes.map_or_else(dash, |bytes| (bytes >> 30).to_string());
    let mut lines = vec![
        format!(
            "- machine: {}, {} cores, {memory} GiB, {}",
            machine.cpu, machine.cores, machine.os
        ),
        format!("- commit {}, `{}`", record.provenance.commit, record.provenance.command),
        format!(
            "- {} of {} s, {} parts over",
            decimal(record.seconds),
            decimal(record.allowed_seconds),
            record.parts.len()
        ),
    ];
    if let Some(nvidia) = &record.nvidia {
        lines.push(format!("- nvidia-smi: {nvidia}"));
    }
    for (variable, value) in &record.vulkan.environment {
        lines.push(format!("- with {variable}={value}"));
    }
    lines.join("\n")
}

fn section(part: &PartRecord) -> String {
    let mut text = format!("\n## {}: {}\n\n{}", part.name, part.about, part.outcome.words());
    if let Some(reason) = &part.reason {
        text += &format!(": {reason}");
    }
    if !part.arguments.is_empty() {
        let set: String =
            part.environment.iter().map(|(name, value)| format!("{name}={value} ")).collect();
        text += &format!("\n\n`{set}metaball {}`", part.arguments.join(" "));
    }
    if !part.output.trim().is_empty() {
        text += &format!("\n\n```text\n{}\n```", part.output.trim_end());
    }
    if part.outcome == Outcome::Failed {
        text += &format!("\n\nIts log ends:\n\n```text\n{}\n```", part.log.trim_end());
    }
    text + "\n"
}

fn dash() -> String {
    "–".to_owned()
}

fn most(span: Span) -> String {
    decimal(span.most)
}

fn span(span: Span) -> String {
    format!("{}–{}", decimal(span.least), decimal(span.most))
}
