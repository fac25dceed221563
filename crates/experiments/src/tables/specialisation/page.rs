//! `specialisation.html`: the table for a person to read.

use super::{HEADINGS, Measurements, rows};
use crate::html::table;
use crate::page::{self, fact, remark_paragraphs, run_facts};

const TITLE: &str = "What each part of the specialisation saves";

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let (width, height) = measurements.size;
    let facts = run_facts(&measurements.provenance, Some(&measurements.adapter))
        + &fact("Picture", &format!("{width} × {height} pixels"));
    let parts = [
        ("facts", facts),
        ("remarks", remark_paragraphs(&measurements.remarks)),
        ("table", table(TITLE, &HEADINGS, &[0, 1, 2], &rows(&measurements.outcomes))),
    ];
    page::page("What specialised shaders save", include_str!("page.html"), &parts)
}
