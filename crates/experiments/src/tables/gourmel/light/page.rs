//! `gourmel-light.html`: the tables for a person to read.

use super::compare::CostRow;
use super::run::{EffectRun, PassKind};
use super::{Measurements, cost_table, gain_table};
use crate::html::escape;
use crate::page;
use crate::table::{Column, Table};
use harness::numbers::decimal;

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let gains = gain_table(&measurements.gains).html();
    let parts = [
        ("facts", measurements.heading.facts()),
        ("remarks", measurements.heading.heading.remark_paragraphs()),
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
    cost_table(rows).html() + &reasons
}

fn runs(runs: &[EffectRun]) -> String {
    let texts = ["scene", "structure", "effects"].map(Column::text).into_iter();
    let passes = PassKind::ALL.map(|kind| Column::number(kind.name()).of("ms"));
    let frame = [Column::number("frame").of("ms")];
    let columns = texts.chain(frame).chain(passes).chain([Column::number("undecided rays")]);
    let row = |run: &EffectRun| {
        let frame = &run.frame_ms;
        let frame =
            format!("{} ({}–{})", decimal(frame.median), decimal(frame.p25), decimal(frame.p75));
        let texts = [run.scene.clone(), run.method.clone(), run.effect.clone(), frame];
        let passes = PassKind::ALL.map(|kind| decimal(run.pass_ms(kind)));
        texts.into_iter().chain(passes).chain([run.undecided.to_string()]).collect()
    };
    let title = "Where the time goes".to_owned();
    Table { title, columns: columns.collect(), rows: runs.iter().map(row).collect() }.html()
}
