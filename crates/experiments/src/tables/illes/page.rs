//! `illes.html`: the tables for a person to read.

use super::Measurements;
use super::run::VARIANTS;
use super::tables::{Annotated, tables};
use crate::html::escape;
use crate::page::{self, fact};
use crate::plot::line_plot;

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let (width, height) = measurements.size;
    let facts = measurements.heading.facts()
        + &fact("Picture of table 1", &format!("{width} × {height} pixels"));
    let [phases, others @ ..] = tables(measurements);
    let others: String = others.iter().map(html).collect();
    let parts = [
        ("facts", facts),
        ("remarks", measurements.heading.remark_paragraphs()),
        ("tables", html(&phases) + &plots(measurements) + &others),
    ];
    page::page("Table 1 of Illés and Szécsi, measured anew", include_str!("page.html"), &parts)
}

fn html(annotated: &Annotated) -> String {
    let note = |note: &String| format!("<p>{}</p>\n", escape(note));
    annotated.table.html() + &annotated.notes.iter().map(note).collect::<String>()
}

fn plots(measurements: &Measurements) -> String {
    let plot = |(name, ..): &(&str, _, _)| {
        let runs = measurements.table.iter().filter_map(|row| row.run.as_ref());
        let points: Vec<_> = runs
            .filter(|run| run.variant == *name)
            .map(|run| (run.balls as f64, run.phases.cast))
            .collect();
        format!("<h3>Cast, {}</h3>\n{}", escape(name), line_plot(&points, "particles", "ms"))
    };
    VARIANTS.iter().map(plot).collect()
}
