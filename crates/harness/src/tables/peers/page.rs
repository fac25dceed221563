//! `peers.html`: the table for a person to read.

use super::{HEADINGS, Measurements, rows};
use crate::html::{escape, fill, section};
use crate::report::{STYLE, fact, provenance, remark_paragraphs};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let peer = measurements.peer.as_deref().unwrap_or("not installed");
    let facts = provenance(&measurements.provenance)
        + &fact("Peer", &escape(peer))
        + &fact("Threads", &measurements.threads.to_string());
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
    let row = |cells: Vec<String>| {
        let missing = HEADINGS.len() - cells.len();
        let last = cells.len() - 1;
        let cell = |(index, text): (usize, &String)| match index {
            // What is said takes the place of all that is not there.
            _ if missing > 0 && index == last => {
                format!("<td class=\"reason\" colspan=\"{}\">{}</td>", missing + 1, escape(text))
            }
            0 | 2 => format!("<td class=\"text\">{}</td>", escape(text)),
            _ => format!("<td>{}</td>", escape(text)),
        };
        format!("<tr>{}</tr>\n", cells.iter().enumerate().map(cell).collect::<String>())
    };
    let body: String = rows(&measurements.scenes).into_iter().map(row).collect();
    section("Tracing on the CPU", &headings, &body)
}
