//! `gourmel-light.html`: the tables for a person to read.

use super::compare::CostRow;
use super::run::{PassKind, Run};
use super::{
    COST_HEADINGS, COSTS_TITLE, GAIN_HEADINGS, GAINS_TITLE, Measurements, cost_rows, gain_rows,
};
use crate::html::{escape, table};
use crate::page::{self, remark_paragraphs};
use harness::numbers::decimal;

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let gains = table(GAINS_TITLE, &GAIN_HEADINGS, &[0, 1], &gain_rows(&measurements.gains));
    let parts = [
        ("facts", measurements.heading.facts()),
        ("remarks", remark_paragraphs(&measurements.heading.remarks)),
        ("tables", costs(&measurements.costs) + &gains + &runs(&measurements.runs)),
    ];
    page::page(
        "The effects of Gourmel et al. 2010, measured anew",
        include_str!("page.html"),
        &parts,
    )
}

fn costs(rows: &[CostRow]) -> String {
    let why = |row: &CostRow| {
        let why = row.why.as_deref()?;
        Some(format!("<p>{}, {}: {}</p>\n", escape(&row.scene), escape(&row.effect), escape(why)))
    };
    let reasons: String = rows.iter().filter_map(why).collect();
    table(COSTS_TITLE, &COST_HEADINGS, &[0, 1], &cost_rows(rows)) + &reasons
}

fn runs(runs: &[Run]) -> String {
    let kinds = PassKind::ALL.map(PassKind::name);
    let headings = ["scene", "structure", "effects", "frame ms"].into_iter().chain(kinds);
    let headings: Vec<_> = headings.chain(["undecided rays"]).collect();
    let row = |run: &Run| {
        let frame = &run.frame_ms;
        let frame =
            format!("{} ({}–{})", decimal(frame.median), decimal(frame.p25), decimal(frame.p75));
        let texts = [run.scene.clone(), run.method.clone(), run.effect.clone(), frame];
        let passes = PassKind::ALL.map(|kind| decimal(run.pass_ms(kind)));
        texts.into_iter().chain(passes).chain([run.doubts.to_string()]).collect()
    };
    let rows: Vec<_> = runs.iter().map(row).collect();
    table("Where the time goes, ms", &headings, &[0, 1, 2], &rows)
}
