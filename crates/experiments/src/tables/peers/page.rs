//! `peers.html`: the table for a person to read.

use super::{HEADINGS, Measurements, rows};
use crate::html::{escape, table};
use crate::page::{self, fact, remark_paragraphs, run_facts};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let peer = measurements.peer.as_deref().unwrap_or("not installed");
    let facts = run_facts(&measurements.provenance, None)
        + &fact("Peer", &escape(peer))
        + &fact("Threads", &measurements.threads.to_string());
    let parts = [
        ("facts", facts),
        ("remarks", remark_paragraphs(&measurements.remarks)),
        ("table", table("Tracing on the CPU", &HEADINGS, &[0, 2], &rows(&measurements.scenes))),
    ];
    page::page("What one would take instead", include_str!("page.html"), &parts)
}
