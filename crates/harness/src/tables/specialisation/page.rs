//! `specialisation.html`: the table for a person to read.

use super::run::FORMS;
use super::{HEADINGS, Measurements, rows};
use crate::html::{escape, fill, section};
use crate::report::{STYLE, fact, provenance, remark_paragraphs};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let adapter = &measurements.adapter;
    let adapter = format!("{} ({}, {})", adapter.name, adapter.backend, adapter.driver);
    let (width, height) = measurements.size;
    let facts = provenance(&measurements.provenance)
        + &fact("Adapter", &escape(&adapter))
        + &fact("Picture", &format!("{width} × {height} pixels"));
    let parts = [
        ("style", STYLE.to_owned()),
        ("facts", facts),
        ("remarks", remark_paragraphs(&measurements.remarks)),
        ("table", table(measurements)),
    ];
    fill(include_str!("page.html"), &parts)
}

fn table(measurements: &Measurements) -> String {
    let headings: String = HEADINGS.iter().map(|name| format!("<th>{name}</th>")).collect();
    let row = |(place, cells): (usize, Vec<String>)| {
        let missing = HEADINGS.len() - cells.len();
        let last = cells.len() - 1;
        let cell = |(index, text): (usize, &String)| match index {
            // What is said takes the place of all that is not there.
            _ if missing > 0 && index == last => {
                format!("<td class=\"reason\" colspan=\"{}\">{}</td>", missing + 1, escape(text))
            }
            0..=2 => format!("<td class=\"text\">{}</td>", escape(text)),
            _ => format!("<td>{}</td>", escape(text)),
        };
        let class = if place % FORMS.len() == 0 { " class=\"first\"" } else { "" };
        format!("<tr{class}>{}</tr>\n", cells.iter().enumerate().map(cell).collect::<String>())
    };
    let body: String = rows(&measurements.outcomes).into_iter().enumerate().map(row).collect();
    section("What each part of the specialisation saves", &headings, &body)
}
