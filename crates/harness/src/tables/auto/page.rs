//! `auto.html`: the table for a person to read.

use super::study::{Drawn, Outcome};
use super::{HEADINGS, Measurements, rows};
use crate::html::{escape, fill, section};
use crate::numbers::{decimal, grouped, small};
use crate::report::{STYLE, fact, provenance, remark_paragraphs};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let adapter = &measurements.adapter;
    let adapter = format!("{} ({}, {})", adapter.name, adapter.backend, adapter.driver);
    let facts = provenance(&measurements.provenance) + &fact("Adapter", &escape(&adapter));
    let parts = [
        ("style", STYLE.to_owned()),
        ("facts", facts),
        ("remarks", remark_paragraphs(&measurements.remarks)),
        ("table", choices(measurements)),
        ("all", measurements.scenes.iter().map(candidates).collect()),
    ];
    fill(include_str!("page.html"), &parts)
}

fn choices(measurements: &Measurements) -> String {
    let headings: String = HEADINGS.iter().map(|name| format!("<th>{name}</th>")).collect();
    let row = |cells: Vec<String>| {
        let cell = |(index, text): (usize, &String)| {
            let class = if matches!(index, 0 | 2 | 4) { " class=\"text\"" } else { "" };
            format!("<td{class}>{}</td>", escape(text))
        };
        format!("<tr>{}</tr>\n", cells.iter().enumerate().map(cell).collect::<String>())
    };
    let body: String = rows(&measurements.scenes).into_iter().map(row).collect();
    section("Chosen, and best", &headings, &body)
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
