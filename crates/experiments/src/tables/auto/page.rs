//! `auto.html`: the table for a person to read.

use super::run::{Drawn, Measured};
use super::{Measurements, table};
use crate::html::{escape, section};
use crate::page;
use crate::tables::scene_result::SceneResult;
use harness::numbers::{decimal, grouped, small};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let parts = [
        ("facts", measurements.heading.facts()),
        ("remarks", measurements.heading.remark_paragraphs()),
        ("table", table(&measurements.scenes).html()),
        ("all", measurements.scenes.iter().map(candidates).collect()),
    ];
    page::page("No more than a scene needs", include_str!("page.html"), &parts)
}

/// Every candidate on a scene.
fn candidates(scene: &SceneResult<Measured>) -> String {
    let Ok(measured) = &scene.result else { return String::new() };
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
    let (width, height) = scene.size;
    let title = format!("{}, {} balls, {width} × {height}", scene.scene, grouped(measured.balls));
    section(&title, headings, &rows)
}
