//! What all tables share: they are printed, and written as a page and as numbers.

use std::path::Path;

use serde::Serialize;

use crate::console;
use crate::outputs::output_files;
use crate::shortfall::Shortfall;
use harness::output::write_json;
use picture_files::write_atomically;

/// What a command `tables` has measured.
pub(super) trait Report: Serialize {
    /// Name of its two files, without their endings.
    const NAME: &'static str;

    /// Its tables for the terminal.
    fn text(&self) -> String;

    /// Its tables as a page, which needs no other file and no network.
    fn page(&self) -> String;

    /// Whether nothing could be measured.
    fn is_empty(&self) -> bool;
}

/// Measures a report on scenes that the user named, if any, prints it, and writes it into a folder.
///
/// # Errors
/// When it cannot be measured, a file cannot be written or is an input, or nothing could be measured.
pub(super) fn publish<R: Report>(
    out: &Path,
    scenes: &[String],
    measure: impl FnOnce() -> anyhow::Result<R>,
) -> anyhow::Result<()> {
    let names = ["html", "json"].map(|ending| format!("{}.{ending}", R::NAME));
    let [page, json] = output_files(out, names.each_ref().map(String::as_str), scenes, &[])?;
    let report = measure()?;
    console::line(&report.text());
    write_json(&json, &report)?;
    write_atomically(&page, report.page().as_bytes())?;
    console::line(&format!("\n{}", page.display()));
    if report.is_empty() {
        return Err(Shortfall("nothing could be measured; see the page".to_owned()).into());
    }
    Ok(())
}
