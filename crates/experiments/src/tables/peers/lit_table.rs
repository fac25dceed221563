//! The table of lit pictures.

use super::lamp_truth::WrongLight;
use super::lit::{LitPair, LitRun};
use super::run::Measured;
use crate::table::{Column, Table};
use crate::tables::scene_result::SceneResult;
use harness::numbers::{decimal, grouped};

/// Two rows a scene and effect: ours and the peer's. Scenes without a result are in the other table.
pub(super) fn table(scenes: &[SceneResult<Measured>]) -> Table {
    let columns = [
        Column::text("scene"),
        Column::number("balls"),
        Column::text("effects"),
        Column::text("tracer"),
        Column::number("process").of("ms"),
        Column::number("its own clock").of("ms"),
        Column::number("times as fast"),
        Column::number("by the clock"),
        Column::number("occlusion rays"),
        Column::number("differs").of("% of pixels"),
        Column::number("lit").of("in shadow"),
        Column::number("dark").of("in light"),
        Column::number("of pixels").of("(unclear)"),
    ];
    let rows_of_scene = |scene: &SceneResult<Measured>| {
        let Ok(measured) = &scene.result else { return Vec::new() };
        let balls = grouped(measured.balls);
        let pairs = measured.lit.iter();
        pairs.flat_map(|pair| rows_of([&scene.scene, &balls], pair)).collect()
    };
    let rows = scenes.iter().flat_map(rows_of_scene).collect();
    Table { title: "Lit pictures on the CPU".to_owned(), columns: columns.into(), rows }
}

fn rows_of(scene: [&String; 2], pair: &LitPair) -> [Vec<String>; 2] {
    let head = |tracer: &str| {
        let [name, balls] = scene.map(String::clone);
        vec![name, balls, pair.effect.clone(), tracer.to_owned()]
    };
    let mut ours = head("fbvh-certified");
    let shares = [
        pair.times_as_fast(),
        pair.times_as_fast_as_work(),
        pair.differing.map(|share| 100.0 * share),
    ];
    ours.extend(cells(&pair.ours, shares));
    let peer = match &pair.peer {
        Ok(run) => {
            let mut row = head(&pair.peer_effect);
            row.extend(cells(run, [None; 3]));
            row
        }
        Err(reason) => head(&format!("{}: {reason}", pair.peer_effect)),
    };
    [ours, peer]
}

/// The numbers of a tracer: its own, and between them how it compares.
fn cells(run: &LitRun, compared: [Option<f64>; 3]) -> [String; 9] {
    let dash = || "–".to_owned();
    let wrong = |cell: fn(WrongLight) -> String| run.wrong.map_or_else(dash, cell);
    let [process, work, differing] =
        compared.map(|number| number.map_or_else(String::new, decimal));
    [
        decimal(run.process_ms.median),
        run.work_ms.as_ref().map_or_else(String::new, |work| decimal(work.median)),
        process,
        work,
        if run.occlusion_rays > 0 { grouped(run.occlusion_rays as usize) } else { dash() },
        differing,
        wrong(|wrong| grouped(wrong.lit)),
        wrong(|wrong| grouped(wrong.dark)),
        wrong(|wrong| format!("{} ({})", grouped(wrong.pixels), grouped(wrong.unclear))),
    ]
}
