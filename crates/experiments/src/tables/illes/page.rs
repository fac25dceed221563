//! `illes.html`: the tables for a person to read.

use super::growth::Growth;
use super::kernels::{KernelRow, Outcome};
use super::run::{Phases, Run, SETTINGS};
use super::text::mebibytes;
use super::{Measurements, Row, SMALL_ADAPTER};
use crate::html::{escape, section};
use crate::page::{self, fact, remark_paragraphs, run_facts};
use crate::plot::line_plot;
use harness::numbers::{decimal, grouped, small};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let (width, height) = measurements.size;
    let facts = run_facts(&measurements.provenance, Some(&measurements.adapter))
        + &fact("Picture of table 1", &format!("{width} × {height} pixels"));
    let tables = [
        phases(&measurements.table),
        plots(measurements),
        lists(&measurements.table),
        growth(&measurements.growth),
        views(&measurements.views),
        memory(&measurements.memory),
        kernels(measurements),
    ];
    let parts = [
        ("facts", facts),
        ("remarks", remark_paragraphs(&measurements.remarks)),
        ("tables", tables.concat()),
    ];
    page::page("Table 1 of Illés and Szécsi, measured anew", include_str!("page.html"), &parts)
}

const WHAT: &str = "<th class=\"text\">Scene</th><th class=\"text\">Setting</th>";

fn what(row: &Row) -> String {
    let cell = |text: &str| format!("<td class=\"text\">{}</td>", escape(text));
    cell(&row.scene) + &cell(&row.setting)
}

/// A row with one cell for each number, or with the reason why there are none.
fn body(rows: &[Row], columns: usize, cells: impl Fn(&Row, &Run) -> String) -> String {
    let row = |(place, row): (usize, &Row)| {
        let class = if place % SETTINGS.len() == 0 { " class=\"first\"" } else { "" };
        let rest = row.run.as_ref().map_or_else(
            || {
                let why = escape(row.why.as_deref().unwrap_or("not run"));
                format!("<td class=\"reason\" colspan=\"{columns}\">{why}</td>")
            },
            |run| cells(row, run),
        );
        format!("<tr{class}>{}{rest}</tr>\n", what(row))
    };
    rows.iter().enumerate().map(row).collect()
}

fn numbers(cells: &[String]) -> String {
    cells.iter().map(|cell| format!("<td>{cell}</td>")).collect()
}

fn phases(rows: &[Row]) -> String {
    let cells = |row: &Row, run: &Run| {
        let beside = |of: fn(&Phases) -> f64| {
            let paper = row.paper.map_or_else(String::new, |paper| format!(" ({})", of(&paper)));
            format!("<b>{}</b>{paper}", decimal(of(&run.phases)))
        };
        let cells = [
            beside(|phases| phases.total),
            beside(|phases| phases.sort),
            beside(|phases| phases.depth),
            beside(|phases| phases.gather),
            beside(|phases| phases.cast),
        ];
        let why = escape(row.why.as_deref().unwrap_or(""));
        format!("{}<td class=\"reason\">{why}</td>", numbers(&cells))
    };
    let headings = format!(
        "{WHAT}<th>Total<small>ms</small></th><th>Sort<small>ms</small></th>\
         <th>Depth<small>ms</small></th><th>Gather<small>ms</small></th>\
         <th>Cast<small>ms</small></th><th class=\"text\">Why they differ</th>"
    );
    section("Table 1: time of the phases", &headings, &body(rows, 6, cells))
}

fn plots(measurements: &Measurements) -> String {
    let plot = |(name, ..): &(&str, _, _)| {
        let runs = measurements.table.iter().filter_map(|row| row.run.as_ref());
        let points: Vec<_> = runs
            .filter(|run| run.setting == *name)
            .map(|run| (run.balls as f64, run.phases.cast))
            .collect();
        format!("<h3>Cast, {}</h3>\n{}", escape(name), line_plot(&points, "particles", "ms"))
    };
    SETTINGS.iter().map(plot).collect()
}

fn lists(rows: &[Row]) -> String {
    let cells = |_: &Row, run: &Run| {
        let lists = &run.lists;
        numbers(&[
            grouped(lists.nodes as usize),
            mebibytes(8 * lists.nodes),
            grouped(lists.pixels as usize),
            decimal(lists.mean),
            decimal(lists.median),
            decimal(lists.p90),
            decimal(lists.p99),
            decimal(lists.max),
            grouped(run.fallback_pixels as usize),
            mebibytes(run.memory.total()),
        ])
    };
    let headings = format!(
        "{WHAT}<th>Nodes</th><th>Pool<small>MiB</small></th><th>Pixels<small>with a list</small></th>\
         <th>Mean</th><th>Median</th><th>p90</th><th>p99</th><th>Longest</th>\
         <th>No room<small>pixels</small></th><th>All memory<small>MiB</small></th>"
    );
    section("Lists: balls that a ray meets before a core", &headings, &body(rows, 10, cells))
}

fn growth(fits: &[Growth]) -> String {
    let row = |growth: &Growth| {
        let exponents = growth.exponents;
        let cells = [
            format!("{}–{}", grouped(growth.particles.0), grouped(growth.particles.1)),
            decimal(exponents.total),
            decimal(exponents.sort),
            decimal(exponents.depth),
            decimal(exponents.gather),
            format!("<b>{}</b>", decimal(exponents.cast)),
            if growth.cast_grows_slower() { "yes" } else { "no" }.to_owned(),
        ];
        let setting = escape(&growth.setting);
        format!("<tr><td class=\"text\">{setting}</td>{}</tr>\n", numbers(&cells))
    };
    let headings = "<th class=\"text\">Setting</th><th>Particles</th><th>Total</th><th>Sort</th>\
         <th>Depth</th><th>Gather</th><th>Cast</th><th>Cast slower than N<small>the claim</small></th>";
    let rows: String = fits.iter().map(row).collect();
    section("Exponent e of time ~ Nᵉ", headings, &rows)
}

fn views(rows: &[Row]) -> String {
    let cells = |row: &Row, run: &Run| {
        let total = run.phases.total;
        let paper = row.paper_fps.map_or_else(String::new, |fps| format!(" ({fps})"));
        numbers(&[
            decimal(total),
            format!("<b>{}</b>{paper}", decimal(1e3 / total)),
            decimal(run.lists.mean),
            grouped(run.lists.pixels as usize),
        ])
    };
    let headings = format!(
        "{WHAT}<th>Frame<small>ms</small></th><th>Frames a second<small>ours (paper)</small></th>\
         <th>List<small>mean</small></th><th>Pixels<small>with a list</small></th>"
    );
    section("Figure 7: the mud, nearer and nearer", &headings, &body(rows, 4, cells))
}

fn memory(rows: &[Row]) -> String {
    let cells = |_: &Row, run: &Run| {
        let memory = run.memory;
        numbers(&[
            mebibytes(memory.scene_bytes),
            mebibytes(memory.frame_bytes),
            mebibytes(memory.target_bytes),
            format!("<b>{}</b>", mebibytes(memory.total())),
            if memory.total() <= SMALL_ADAPTER { "yes" } else { "no" }.to_owned(),
        ])
    };
    let headings = format!(
        "{WHAT}<th>Scene<small>MiB</small></th><th>Frame<small>MiB, lists included</small></th>\
         <th>Rays and hits<small>MiB</small></th><th>All<small>MiB</small></th><th>Within 2 GiB</th>"
    );
    section("Memory: the first view of figure 7", &headings, &body(rows, 5, cells))
}

fn kernels(measurements: &Measurements) -> String {
    let outcome = |outcome: &Outcome| match outcome {
        Outcome::Compared(accuracy) => {
            let error = accuracy.t_error_over_radius;
            let number = |of: Option<f64>| of.map_or_else(|| "–".to_owned(), small);
            numbers(&[
                number(error.map(|error| error.p50)),
                number(error.map(|error| error.p99)),
                number(accuracy.rel_rms_t),
                format!("{} of {}", accuracy.wrong_verdicts(), grouped(accuracy.rays)),
            ])
        }
        Outcome::Refused(reason) => {
            format!("<td class=\"reason\" colspan=\"4\">{}</td>", escape(reason))
        }
    };
    let row = |row: &KernelRow| {
        format!(
            "<tr><td class=\"text\">{}</td><td>{:+.4} to {:+.4}</td>{}{}</tr>\n",
            escape(&row.kernel),
            row.deviation.0,
            row.deviation.1,
            outcome(&row.cubic),
            outcome(&row.exact)
        )
    };
    let errors = |name: &str| {
        format!(
            "<th>{name}: p50<small>radii</small></th><th>p99<small>radii</small></th>\
             <th>RMS of t<small>relative</small></th><th>Wrong rays</th>"
        )
    };
    let headings = format!(
        "<th class=\"text\">Kernel</th><th>Kernel − cubic<small>parts of a ball</small></th>{}{}",
        errors("Cubic"),
        errors("Exact")
    );
    let (scene, (width, height)) = &measurements.kernel_scene;
    let rows: String = measurements.kernels.iter().map(row).collect();
    let title = format!("The cubic's own error: {scene} at {width} × {height}, every pixel");
    section(&title, &headings, &rows)
}
