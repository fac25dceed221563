//! `specialisation.html`: the table for a person to read.

use super::{Measurements, table};
use crate::page::{self, fact};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let (width, height) = measurements.size;
    let facts =
        measurements.heading.facts() + &fact("Picture", &format!("{width} × {height} pixels"));
    let parts = [
        ("facts", facts),
        ("remarks", measurements.heading.remark_paragraphs()),
        ("table", table(&measurements.scenes).html()),
    ];
    page::page("What specialised shaders save", include_str!("page.html"), &parts)
}
