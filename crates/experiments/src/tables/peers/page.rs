//! `peers.html`: the tables for a person to read.

use super::{Measurements, lit_table, table};
use crate::html::escape;
use crate::page::{self, fact};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let versions = match &measurements.versions[..] {
        [] => "none installed".to_owned(),
        versions => versions.join("; "),
    };
    let facts = measurements.heading.facts()
        + &fact("Peers", &escape(&versions))
        + &fact("Threads", &measurements.threads.to_string());
    let parts = [
        ("facts", facts),
        ("remarks", measurements.heading.remark_paragraphs()),
        ("table", table(&measurements.scenes).html()),
        ("lit", lit_table::table(&measurements.scenes).html()),
    ];
    page::page("What one would take instead", include_str!("page.html"), &parts)
}
