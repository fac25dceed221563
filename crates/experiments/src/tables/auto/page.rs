//! `auto.html`: the table for a person to read.

use super::study::{Drawn, Outcome};
use super::{HEADINGS, Measurements, rows};
use crate::html::{escape, section, table};
use crate::page::{self, remark_paragraphs, run_facts};
use harness::numbers::{decimal, grouped, small};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let facts = run_facts(&measurements.provenance, Some(&measurements.adapter));
    let parts = [
        ("facts", facts),
        ("remarks", remark_paragraphs(&measurements.remarks)),
        ("table", table("Chosen, and best", &HEADINGS, &[0, 2, 4], &rows(&measurements.scenes))),
        ("all", measurements.scenes.iter().map(candidates).collect()),
    ];
    page::page("No more than a scene needs", include_str!("page.html"), &parts)
}

/// Every candidate on a scene.
fn candidates(outcome: &Outcome) -> String {
    let Ok(measured) = &outcome.result else { return String::new() };
    let row = |(name, drawn): &(String, Result<Drawn, String>)| {
        let cells = match drawn {
            Ok(Drawn { errors, frame_ms }) => format!(
                "<td>{}</td><td>{}</td><td>{} of {}</td>",
                decimal(*frame_ms),
                small(errors.p99),
                grouped(errors.wrong),
                grouped(errors.rays)
            ),
            Err(reason) => format!("<td class=\"reason\" colspan=\"3\">{}</td>", escape(reason)),
        };
        format!("<tr><td class=\"text\">{}</td>{cells}</tr>\n", escape(name))
    };
    let rows: String = measured.all.iter().map(row).collect();
    let headings = "<th class=\"text\">Candidate</th><th>ms</th><th>99 % within</th><th>Wrong \
                    rays</th>";
    let (width, height) = outcome.size;
    let title = format!("{}, {} balls, {width} × {height}", outcome.scene, grouped(measured.balls));
    section(&title, headings, &rows)
}
