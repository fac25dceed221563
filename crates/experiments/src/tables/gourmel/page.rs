//! `gourmel.html`: the tables for a person to read.

use super::compare::{Density, Row, Table, WorkRow, find};
use super::run::TreeRun;
use super::{Line, Measurements, Point, density_table};
use crate::html::{escape, section};
use crate::page;
use crate::plot::line_plot;
use harness::numbers::{decimal, grouped};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let tables: String =
        measurements.tables.iter().map(|table| rates(table, measurements)).collect();
    let series: String = measurements.series.iter().map(|line| plot(line, measurements)).collect();
    let parts = [
        ("facts", measurements.heading.facts()),
        ("remarks", measurements.heading.heading.remark_paragraphs()),
        (
            "tables",
            tables + &work(&measurements.work_table) + &density(&measurements.density) + &series,
        ),
    ];
    page::page(
        "The tables of Gourmel et al. 2010, measured anew",
        include_str!("page.html"),
        &parts,
    )
}

const RUN_HEADINGS: &str = "<th>Build<small>ms</small></th>\
     <th>Frame<small>ms: mean (least–most)</small></th>\
     <th>List entries<small>a ball</small></th>\
     <th>Split<small>a leaf</small></th>\
     <th>Work<small>a ray: nodes, leaves, balls, kernels</small></th>";

fn run_cells(run: Option<&TreeRun>) -> String {
    let Some(run) = run else {
        return "<td class=\"reason\" colspan=\"5\">no result</td>".to_owned();
    };
    let (least, most) = run.extremes_ms();
    let work = &run.work;
    let cells = [
        decimal(run.build_ms.median),
        format!("{} ({}–{})", decimal(run.mean_ms()), decimal(least), decimal(most)),
        decimal(run.tree.list_entries as f64 / run.balls.max(1) as f64),
        decimal(run.tree.split_per_leaf),
        [work.nodes_per_ray, work.leaf_tests_per_ray, work.balls_per_ray, run.kernels_per_ray()]
            .map(decimal)
            .join(", "),
    ];
    cells.iter().map(|cell| format!("<td>{cell}</td>")).collect()
}

fn rates(table: &Table, measurements: &Measurements) -> String {
    let row = |row: &Row| {
        let run = find(&measurements.runs, &row.scene, &row.variant);
        let balls = run.map_or_else(String::new, |run| grouped(run.balls));
        let class = if row.paper_ratio.is_none() { " class=\"first\"" } else { "" };
        let ratio = row.paper_ratio.map_or_else(String::new, |paper| {
            let ours = row.ratio.map_or_else(|| "–".to_owned(), decimal);
            format!("<b>{ours}</b> ({})", decimal(paper))
        });
        let extremes = row
            .paper_fps_extremes
            .map_or_else(String::new, |(least, most)| format!(" ({least}–{most})"));
        let paper_build = row.paper_build_ms.map_or_else(String::new, decimal);
        format!(
            "<tr{class}><td class=\"text\">{}</td><td>{balls}</td><td class=\"text\">{}</td>{}\
             <td>{ratio}</td><td>{paper_build}</td><td>{}{extremes}</td>\
             <td class=\"reason\">{}</td></tr>\n",
            escape(&row.scene),
            escape(&row.variant),
            run_cells(run),
            row.paper_fps,
            escape(row.why.as_deref().unwrap_or(""))
        )
    };
    let headings = format!(
        "<th class=\"text\">Scene</th><th>Balls</th><th class=\"text\">Structure</th>{RUN_HEADINGS}\
         <th>Times as fast<small>ours (paper)</small></th><th>Paper: build<small>ms</small></th>\
         <th>Paper: frames<small>a second</small></th><th class=\"text\">Why they differ</th>"
    );
    let rows: String = table.rows.iter().map(row).collect();
    section(&format!("{}: {}", table.name, table.title), &headings, &rows)
}

fn work(table: &[WorkRow]) -> String {
    let row = |row: &WorkRow| {
        let cells = (0..3).map(|counter| {
            let ours = row.measured.map_or_else(|| "–".to_owned(), |ours| decimal(ours[counter]));
            format!("<td><b>{ours}</b> ({})</td>", row.paper[counter])
        });
        format!(
            "<tr><td class=\"text\">{}</td><td class=\"text\">{}</td>{}<td class=\"reason\">{}</td>\
             </tr>\n",
            escape(&row.scene),
            escape(&row.variant),
            cells.collect::<String>(),
            escape(row.why.as_deref().unwrap_or(""))
        )
    };
    let headings = "<th class=\"text\">Scene</th><th class=\"text\">Structure</th>\
         <th>Traversals<small>ours (paper)</small></th><th>Tests<small>ours (paper)</small></th>\
         <th>Balls<small>ours (paper)</small></th><th class=\"text\">Why they differ</th>";
    let rows: String = table.iter().map(row).collect();
    section("Table 3: work a ray on the tornado", headings, &rows)
}

fn density(density: &Density) -> String {
    let why = density.why.as_deref().map(escape).unwrap_or_default();
    density_table(density).html() + &format!("<p>{why}</p>\n")
}

fn plot(line: &Line, measurements: &Measurements) -> String {
    let row = |point: &Point| {
        let run = find(&measurements.runs, &point.scene, &point.variant);
        let (x, scene) = (decimal(point.x), escape(&point.scene));
        format!("<tr><td>{x}</td><td class=\"text\">{scene}</td>{}</tr>\n", run_cells(run))
    };
    let headings =
        format!("<th>{}</th><th class=\"text\">Scene</th>{RUN_HEADINGS}", escape(&line.axis));
    let rows: String = line.points.iter().map(row).collect();
    let points: Vec<_> = line.points.iter().map(|point| (point.x, point.frame_ms)).collect();
    let drawn = line_plot(&points, &line.axis, "ms a frame");
    section(&format!("Plot: {}", line.title), &headings, &rows) + &drawn
}
