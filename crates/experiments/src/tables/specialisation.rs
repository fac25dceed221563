//! The command `tables specialisation`: what it saves that shaders are made for a scene, each part
//! alone and all of them.

mod page;
pub mod run;

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use self::run::{Measured, PlannedScene, SceneForms};
use crate::console::{ProgressBar, open_adapter};
use crate::extent::Extent;
use crate::page::cpu_remark;
use crate::shortfall::Shortfall;
use crate::table::{Column, Table};
use crate::tables::heading::Heading;
use crate::tables::report::{Report, publish};
use crate::tables::{Options, named_or};
use harness::methods::{HEADLINERS, Method, find};
use harness::numbers::{decimal, grouped};

/// Name and version of the format of `specialisation.json`.
pub const SCHEMA: &str = "metaball-tables-specialisation/1";

/// Every scene with every published method and the certified tree.
fn plan(options: &Options, scenes: &[String]) -> Vec<PlannedScene> {
    let (own, size, rounds): (&[&str], _, _) = match options.extent {
        Extent::Quick => (&["scattered:300"], (32, 24), 2),
        Extent::Whole => (&["scattered-30k", "tornado-4k", "dam-break", "molecule"], (160, 120), 9),
    };
    let size = options.size.unwrap_or(size);
    let methods: Vec<_> = with_shaders().collect();
    let of_scene = |spec: String| {
        let planned = move |&method| PlannedScene { spec: spec.clone(), method, size, rounds };
        methods.iter().map(planned).collect::<Vec<_>>()
    };
    named_or(scenes, own).into_iter().flat_map(of_scene).collect()
}

/// The headliners that have shaders.
fn with_shaders() -> impl Iterator<Item = &'static Method> {
    HEADLINERS.iter().filter_map(|name| find(name)).filter(|method| method.needs_adapter())
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Its format is [`SCHEMA`].
    #[serde(flatten)]
    pub heading: Heading,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Scenes and methods, in the order measured.
    #[serde(rename = "outcomes")]
    pub scenes: Vec<SceneForms>,
}

/// Measures, prints the table, and writes `specialisation.html` and `specialisation.json`. Scenes are
/// what [`bench_scenes::load`] takes; without any there are four.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(options: &Options, scenes: &[String]) -> anyhow::Result<()> {
    let gpu = open_adapter(&options.adapter)?;
    publish(&options.out, scenes, || measure(&gpu, &plan(options, scenes)))
}

impl Report for Measurements {
    const NAME: &'static str = "specialisation";

    fn text(&self) -> String {
        self.heading.text_with_remarks(&table(&self.scenes))
    }

    fn page(&self) -> String {
        page::page(self)
    }

    fn is_empty(&self) -> bool {
        self.scenes.is_empty()
    }
}

fn measure(gpu: &Gpu, plan: &[PlannedScene]) -> anyhow::Result<Measurements> {
    let progress = ProgressBar::new(plan.iter().map(PlannedScene::steps).sum());
    let mut remarks: Vec<_> = cpu_remark(Some(gpu)).into_iter().collect();
    let mut scenes = Vec::new();
    for planned in plan {
        match planned.measure(gpu, &progress) {
            Ok(measured) => scenes.push(measured),
            Err(error) => {
                remarks.push(format!("{}, {}: {error:#}.", planned.spec, planned.method.name));
            }
        }
    }
    drop(progress);
    if scenes.is_empty() {
        return Err(Shortfall(format!("nothing could be measured: {}", remarks.join(" "))).into());
    }
    Ok(Measurements {
        heading: Heading::new(SCHEMA, Some(gpu), remarks),
        size: plan.first().map_or((0, 0), |planned| planned.size),
        scenes,
    })
}

/// A row for each form of each scene and method.
fn table(scenes: &[SceneForms]) -> Table {
    let columns = [
        Column::text("scene"),
        Column::text("method"),
        Column::text("shaders"),
        Column::number("frame").of("ms"),
        Column::number("times"),
        Column::number("quartiles"),
        Column::number("adapter").of("KiB"),
        Column::number("code"),
        Column::number("other pixels"),
    ];
    let rows_of = |scene: &SceneForms| {
        let row = |row: &run::Row| {
            let mut cells = vec![scene.scene.clone(), scene.method.clone(), row.form.clone()];
            match &row.result {
                Ok(measured) => cells.extend(numbers(measured)),
                Err(reason) => cells.push(reason.clone()),
            }
            cells
        };
        scene.rows.iter().map(row).collect::<Vec<_>>()
    };
    let rows = scenes.iter().flat_map(rows_of).collect();
    let title = "What each part of the specialisation saves".to_owned();
    Table { title, columns: columns.into(), rows }
}

fn numbers(measured: &Measured) -> [String; 6] {
    let times = &measured.times;
    [
        decimal(measured.frame_ms.median),
        format!("{:.2}", times.median),
        format!("{:.2}–{:.2}", times.p25, times.p75),
        grouped(measured.device_bytes.div_ceil(1024) as usize),
        grouped(measured.code as usize),
        measured.differing_pixels.to_string(),
    ]
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use metaball_core::gpu::AdapterChoice;
    use metaball_core::{Kernel, Metaball, Scene};

    use super::run::FORMS;
    use super::*;
    use crate::testing::{assert_stands_alone, read_back};

    fn quick() -> Vec<PlannedScene> {
        let (extent, adapter) = (Extent::Quick, AdapterChoice::Environment);
        plan(&Options { extent, size: None, adapter, out: PathBuf::new() }, &[])
    }

    /// No form takes less memory than the specialised one; all of them together take more, and other code:
    /// more, but where the certified tree's polynomial tests are left out.
    #[test]
    fn a_quick_run_fills_every_row() {
        let Some(gpu) = Gpu::for_test() else { return };
        let measurements = measure(&gpu, &quick()).expect("measured");
        assert_eq!(measurements.scenes.len(), with_shaders().count());
        for scene in &measurements.scenes {
            let measured: Vec<_> =
                scene.rows.iter().map(|row| row.result.as_ref().expect("measured")).collect();
            assert_eq!(measured.len(), FORMS.len());
            let (least, most) = (measured[0], measured[FORMS.len() - 1]);
            assert_eq!((least.times.median, least.differing_pixels), (1.0, 0));
            for form in &measured[1..] {
                assert!(form.device_bytes >= least.device_bytes, "{scene:?}");
                assert!(form.device_bytes <= most.device_bytes, "{scene:?}");
                assert_eq!(form.frame_ms.samples.len(), 2);
            }
            assert!(most.code != least.code && most.device_bytes > least.device_bytes);
        }
        let back = read_back(&measurements);
        assert_eq!(
            (back.heading.provenance.schema.as_str(), back.scenes.len()),
            (SCHEMA, with_shaders().count())
        );
        let page = page::page(&measurements);
        assert_stands_alone(&page, &["/tmp"]);
        assert!(page.contains("a radius each"));
    }

    /// What a scene needs cannot be saved, and the reason says so.
    #[test]
    fn what_a_scene_needs_is_no_form() {
        let balls = [1.0, 2.0].map(|radius| Metaball::new([radius, 0.0, 0.0].into(), radius));
        let scene = Scene::new(balls, Kernel::Wyvill, 0.5).expect("legal");
        let reason = |name| {
            let form = FORMS.iter().find(|form| form.name == name).expect("listed");
            form.scene(&scene).err()
        };
        assert_eq!(reason("a radius each").as_deref(), Some("radii vary"));
        assert_eq!(reason("any exponent").as_deref(), Some("the kernel has no exponent"));
        for form in ["specialised", "any kernel", "a strength each", "work counted"] {
            assert_eq!(reason(form), None, "{form}");
        }
    }

    #[test]
    fn a_scene_that_fails_is_named() {
        let Some(gpu) = Gpu::for_test() else { return };
        let planned = PlannedScene { spec: "nosuch".to_owned(), ..quick().remove(0) };
        let error = measure(&gpu, &[planned]).expect_err("no such scene").to_string();
        assert!(error.contains("nosuch"), "{error}");
    }
}
