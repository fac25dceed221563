//! What all tables share: they are printed, and written as a page and as numbers.

use std::path::Path;

use serde::Serialize;

use crate::console;
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

/// Prints a report, and writes it into a folder.
///
/// # Errors
/// When a file cannot be written, or nothing could be measured.
pub(super) fn publish<R: Report>(report: &R, out: &Path) -> anyhow::Result<()> {
    console::line(&report.text());
    let page = out.join(format!("{}.html", R::NAME));
    write_json(&out.join(format!("{}.json", R::NAME)), report)?;
    write_atomically(&page, report.page().as_bytes())?;
    console::line(&format!("\n{}", page.display()));
    anyhow::ensure!(!report.is_empty(), "nothing could be measured; see the page");
    Ok(())
}
