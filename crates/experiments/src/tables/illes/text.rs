//! The tables for the terminal.

use super::kernels::Outcome;
use super::{Measurements, Row, SMALL_ADAPTER};
use crate::console::table;
use harness::numbers::{decimal, grouped, small};

/// Bytes as MiB.
pub(super) fn mebibytes(bytes: u64) -> String {
    decimal(bytes as f64 / f64::from(1 << 20))
}

/// All tables.
pub(super) fn text(measurements: &Measurements) -> String {
    let (width, height) = measurements.size;
    let mut parts = vec![
        format!("\nTable 1: milliseconds at {width} × {height}, the paper's in brackets"),
        phases(&measurements.table),
        "\nLists: balls a ray meets before a core, over pixels that have any".to_owned(),
        lists(&measurements.table),
        "\nExponent of time over the number of particles".to_owned(),
        growth(measurements),
        "\nFigure 7: the mud in three views".to_owned(),
        views(&measurements.views),
        "\nMemory: particles of figure 7, first view, MiB of buffers and textures".to_owned(),
        memory(&measurements.memory),
    ];
    let (scene, (width, height)) = &measurements.kernel_scene;
    parts.push(format!(
        "\nThe cubic's error against the reference: {scene} at {width} × {height}, distance in radii"
    ));
    parts.push(kernels(measurements));
    parts.join("\n")
}

fn phases(rows: &[Row]) -> String {
    let row = |row: &Row| {
        let mut cells = vec![row.scene.clone(), row.setting.clone()];
        match &row.run {
            Some(run) => {
                let (ours, paper) = (run.phases, row.paper);
                let beside = |ours: f64, paper: Option<f64>| match paper {
                    Some(paper) => format!("{} ({paper})", decimal(ours)),
                    None => decimal(ours),
                };
                cells.push(beside(ours.total, paper.map(|paper| paper.total)));
                cells.push(beside(ours.sort, paper.map(|paper| paper.sort)));
                cells.push(beside(ours.depth, paper.map(|paper| paper.depth)));
                cells.push(beside(ours.gather, paper.map(|paper| paper.gather)));
                cells.push(beside(ours.cast, paper.map(|paper| paper.cast)));
            }
            None => cells.push("–".to_owned()),
        }
        cells
    };
    let headings = ["scene", "setting", "total", "sort", "depth", "gather", "cast"];
    let reasons = rows.iter().filter_map(|row| Some((row, row.why.as_ref()?)));
    let reasons: Vec<_> =
        reasons.map(|(row, why)| format!("  {}, {}: {why}", row.scene, row.setting)).collect();
    let body: Vec<_> = rows.iter().map(row).collect();
    [vec![table(&headings, &body)], reasons].concat().join("\n")
}

fn lists(rows: &[Row]) -> String {
    let runs = rows.iter().filter_map(|row| row.run.as_ref());
    let body: Vec<_> = runs
        .map(|run| {
            let lists = &run.lists;
            vec![
                run.scene.clone(),
                run.setting.clone(),
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
        .collect();
    let headings = [
        "scene", "setting", "nodes", "MiB", "pixels", "mean", "median", "p90", "p99", "max",
        "no room", "all MiB",
    ];
    table(&headings, &body)
}

fn growth(measurements: &Measurements) -> String {
    let body: Vec<_> = measurements
        .growth
        .iter()
        .map(|growth| {
            let exponents = growth.exponents;
            vec![
                growth.setting.clone(),
                format!("{}–{}", grouped(growth.particles.0), grouped(growth.particles.1)),
                decimal(exponents.total),
                decimal(exponents.sort),
                decimal(exponents.depth),
                decimal(exponents.gather),
                decimal(exponents.cast),
                if growth.cast_grows_slower() { "yes" } else { "no" }.to_owned(),
            ]
        })
        .collect();
    let headings =
        ["", "particles", "total", "sort", "depth", "gather", "cast", "cast slower than N"];
    table(&headings, &body)
}

fn views(rows: &[Row]) -> String {
    let body: Vec<_> = rows
        .iter()
        .map(|row| {
            let ms = row.run.as_ref().map(|run| run.phases.total);
            vec![
                row.setting.clone(),
                ms.map_or_else(|| "–".to_owned(), decimal),
                ms.map_or_else(String::new, |ms| decimal(1e3 / ms)),
                row.paper_fps.map_or_else(String::new, |fps| fps.to_string()),
            ]
        })
        .collect();
    table(&["setting", "ms", "frames a second", "paper"], &body)
}

fn memory(rows: &[Row]) -> String {
    let runs = rows.iter().filter_map(|row| row.run.as_ref());
    let body: Vec<_> = runs
        .map(|run| {
            let memory = run.memory;
            vec![
                run.scene.clone(),
                run.setting.clone(),
                mebibytes(memory.scene_bytes),
                mebibytes(memory.frame_bytes),
                mebibytes(memory.target_bytes),
                mebibytes(memory.total()),
                if memory.total() <= SMALL_ADAPTER { "yes" } else { "no" }.to_owned(),
            ]
        })
        .collect();
    let headings = ["scene", "setting", "scene", "frame", "targets", "all", "within 2 GiB"];
    table(&headings, &body)
}

fn kernels(measurements: &Measurements) -> String {
    let outcome = |outcome: &Outcome| match outcome {
        Outcome::Compared(accuracy) => {
            let error = accuracy.t_error_over_radius;
            let number = |of: Option<f64>| of.map_or_else(|| "–".to_owned(), small);
            vec![
                number(error.map(|error| error.p50)),
                number(error.map(|error| error.p99)),
                number(accuracy.rel_rms_t),
                accuracy.wrong_verdicts().to_string(),
            ]
        }
        Outcome::Refused(_) => vec!["–".to_owned(); 4],
    };
    let body: Vec<_> = measurements
        .kernels
        .iter()
        .map(|row| {
            let deviation = format!("{:+.4} to {:+.4}", row.deviation.0, row.deviation.1);
            [vec![row.kernel.clone(), deviation], outcome(&row.cubic), outcome(&row.exact)].concat()
        })
        .collect();
    let headings = [
        "kernel",
        "kernel − cubic",
        "cubic p50",
        "p99",
        "rms t",
        "wrong",
        "exact p50",
        "p99",
        "rms t",
        "wrong",
    ];
    let refusals = measurements.kernels.iter().filter_map(|row| match &row.exact {
        Outcome::Refused(reason) => Some(format!("  {}: {reason}", row.kernel)),
        Outcome::Compared(_) => None,
    });
    std::iter::once(table(&headings, &body)).chain(refusals).collect::<Vec<_>>().join("\n")
}
