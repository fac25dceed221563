//! The tables, for the terminal and the page alike.

use super::growth::Growth;
use super::kernels::{KernelRow, Picture};
use super::run::{ListRun, Phases};
use super::{Measurements, Row, SMALL_ADAPTER};
use crate::table::{Column, Table};
use harness::numbers::{decimal, grouped, small};

/// A table with notes on some of its rows.
pub(super) struct Annotated {
    pub(super) table: Table,
    pub(super) notes: Vec<String>,
}

impl From<Table> for Annotated {
    fn from(table: Table) -> Self {
        Self { table, notes: Vec::new() }
    }
}

/// All tables, in order.
pub(super) fn tables(measurements: &Measurements) -> [Annotated; 6] {
    [
        phases(measurements),
        lists(&measurements.table).into(),
        growth(&measurements.growth).into(),
        views(&measurements.views).into(),
        memory(&measurements.memory).into(),
        kernels(measurements),
    ]
}

const SCENE: Column = Column::text("scene");
const VARIANT: Column = Column::text("variant");

fn phases(measurements: &Measurements) -> Annotated {
    let ms = |name| Column::number(name).of("ms");
    let columns =
        vec![SCENE, VARIANT, ms("total"), ms("sort"), ms("depth"), ms("gather"), ms("cast")];
    let row = |row: &Row| {
        let beside = |ours: f64, paper: Option<f64>| match paper {
            Some(paper) => format!("{} ({paper})", decimal(ours)),
            None => decimal(ours),
        };
        let cells = row.run.as_ref().map_or_else(
            || vec!["–".to_owned()],
            |run| {
                let cell =
                    |of: fn(&Phases) -> f64| beside(of(&run.phases), row.paper.as_ref().map(of));
                vec![
                    cell(|phases| phases.total),
                    cell(|phases| phases.sort),
                    cell(|phases| phases.depth),
                    cell(|phases| phases.gather),
                    cell(|phases| phases.cast),
                ]
            },
        );
        [vec![row.scene.clone(), row.variant.clone()], cells].concat()
    };
    let note = |row: &Row| {
        let why = row.why.as_ref()?;
        Some(format!("{}, {}: {why}", row.scene, row.variant))
    };
    let (width, height) = measurements.size;
    let title = format!("Table 1: the phases at {width} × {height}, the paper's in brackets");
    let rows = measurements.table.iter().map(row).collect();
    let notes = measurements.table.iter().filter_map(note).collect();
    Annotated { table: Table { title, columns, rows }, notes }
}

/// A table of what was run, a row for each.
fn of_runs(
    title: &str,
    columns: &[Column],
    rows: &[Row],
    cells: impl Fn(&Row, &ListRun) -> Vec<String>,
) -> Table {
    let row = |row: &Row| {
        let cells = cells(row, row.run.as_ref()?);
        Some([vec![row.scene.clone(), row.variant.clone()], cells].concat())
    };
    let columns = [&[SCENE, VARIANT], columns].concat();
    Table { title: title.to_owned(), columns, rows: rows.iter().filter_map(row).collect() }
}

fn lists(rows: &[Row]) -> Table {
    let columns = [
        Column::number("nodes"),
        Column::number("pool").of("MiB"),
        Column::number("pixels").of("with a list"),
        Column::number("mean"),
        Column::number("median"),
        Column::number("p90"),
        Column::number("p99"),
        Column::number("longest"),
        Column::number("overflow").of("pixels"),
        Column::number("all memory").of("MiB"),
    ];
    of_runs("Lists: balls that a ray meets before a core", &columns, rows, |_, run| {
        let lists = &run.lists;
        vec![
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
        ]
    })
}

fn growth(fits: &[Growth]) -> Table {
    let columns = [
        VARIANT,
        Column::number("particles"),
        Column::number("total"),
        Column::number("sort"),
        Column::number("depth"),
        Column::number("gather"),
        Column::number("cast"),
        Column::number("cast slower than N"),
    ];
    let row = |growth: &Growth| {
        let exponents = growth.exponents;
        vec![
            growth.variant.clone(),
            format!("{}–{}", grouped(growth.particles.0), grouped(growth.particles.1)),
            decimal(exponents.total),
            decimal(exponents.sort),
            decimal(exponents.depth),
            decimal(exponents.gather),
            decimal(exponents.cast),
            yes_or_no(growth.cast_grows_slower()),
        ]
    };
    let title = "Exponent e of time ~ Nᵉ, N particles".to_owned();
    Table { title, columns: columns.into(), rows: fits.iter().map(row).collect() }
}

fn views(rows: &[Row]) -> Table {
    let columns = [
        Column::number("frame").of("ms"),
        Column::number("frames").of("a second"),
        Column::number("paper"),
        Column::number("list").of("mean"),
        Column::number("pixels").of("with a list"),
    ];
    of_runs("Figure 7: the mud, nearer and nearer", &columns, rows, |row, run| {
        let total = run.phases.total;
        vec![
            decimal(total),
            decimal(1e3 / total),
            row.paper_fps.map_or_else(String::new, |fps| fps.to_string()),
            decimal(run.lists.mean),
            grouped(run.lists.pixels as usize),
        ]
    })
}

fn memory(rows: &[Row]) -> Table {
    let columns = [
        Column::number("scene").of("MiB"),
        Column::number("frame, lists included,").of("MiB"),
        Column::number("rays and hits").of("MiB"),
        Column::number("all").of("MiB"),
        Column::number("within 2 GiB"),
    ];
    of_runs("Memory: the first view of figure 7", &columns, rows, |_, run| {
        let memory = run.memory;
        vec![
            mebibytes(memory.scene_bytes),
            mebibytes(memory.frame_bytes),
            mebibytes(memory.target_bytes),
            mebibytes(memory.total()),
            yes_or_no(memory.total() <= SMALL_ADAPTER),
        ]
    })
}

fn kernels(measurements: &Measurements) -> Annotated {
    let columns = [
        Column::text("kernel"),
        Column::number("kernel − cubic"),
        Column::number("cubic: p50").of("radii"),
        Column::number("p99").of("radii"),
        Column::number("rms t"),
        Column::number("wrong rays"),
        Column::number("exact: p50").of("radii"),
        Column::number("p99").of("radii"),
        Column::number("rms t"),
        Column::number("wrong rays"),
    ];
    let cells = |picture: &Picture| match picture {
        Picture::Compared(accuracy) => {
            let error = accuracy.t_error_over_radius;
            let number = |of: Option<f64>| of.map_or_else(|| "–".to_owned(), small);
            vec![
                number(error.map(|error| error.p50)),
                number(error.map(|error| error.p99)),
                number(accuracy.rel_rms_t),
                format!("{} of {}", accuracy.wrong_verdicts(), grouped(accuracy.rays)),
            ]
        }
        Picture::Refused(_) => vec!["–".to_owned(); 4],
    };
    let row = |row: &KernelRow| {
        let deviation = format!("{:+.4} to {:+.4}", row.deviation.0, row.deviation.1);
        [vec![row.kernel.clone(), deviation], cells(&row.cubic), cells(&row.exact)].concat()
    };
    let refusal = |row: &KernelRow| match &row.exact {
        Picture::Refused(reason) => Some(format!("{}: {reason}", row.kernel)),
        Picture::Compared(_) => None,
    };
    let (scene, (width, height)) = &measurements.kernel_scene;
    let title =
        format!("The cubic's own error against the reference: {scene} at {width} × {height}");
    let rows = measurements.kernels.iter().map(row).collect();
    let notes = measurements.kernels.iter().filter_map(refusal).collect();
    Annotated { table: Table { title, columns: columns.into(), rows }, notes }
}

/// Bytes as MiB.
fn mebibytes(bytes: u64) -> String {
    decimal(bytes as f64 / f64::from(1 << 20))
}

fn yes_or_no(holds: bool) -> String {
    if holds { "yes" } else { "no" }.to_owned()
}
