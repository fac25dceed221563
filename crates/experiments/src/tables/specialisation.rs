//! The command `tables specialisation`: what it saves that shaders are made for a scene, each part
//! alone and all of them.

mod page;
pub mod run;

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use self::run::{Bout, Measured, Outcome};
use crate::console::{self, ProgressBar};
use crate::tables::{Extent, Order, named_or};
use harness::machine::Provenance;
use harness::methods::{HEADLINERS, Method, find};
use harness::numbers::{decimal, grouped};
use harness::output::write_json;
use harness::record::Adapter;
use picture_files::write_atomically;

/// Name and version of the format of `specialisation.json`.
pub const SCHEMA: &str = "metaball-tables-specialisation/1";

/// Every scene with every published method and the certified tree.
fn bouts(order: &Order, scenes: &[String]) -> Vec<Bout> {
    let (own, size, rounds): (&[&str], _, _) = match order.extent {
        Extent::Quick => (&["scattered:300"], (32, 24), 2),
        Extent::Whole => (&["scattered-30k", "tornado-4k", "dam-break", "molecule"], (160, 120), 9),
    };
    let size = order.size.unwrap_or(size);
    let methods: Vec<&Method> = HEADLINERS.iter().filter_map(|name| find(name)).collect();
    let of_scene = |spec: String| {
        let bout = move |&method| Bout { spec: spec.clone(), method, size, rounds };
        methods.iter().map(bout).collect::<Vec<_>>()
    };
    named_or(scenes, own).into_iter().flat_map(of_scene).collect()
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Where it comes from; its format is [`SCHEMA`].
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What drew.
    pub adapter: Adapter,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// What a reader should know.
    pub remarks: Vec<String>,
    /// Scenes and methods, in the order measured.
    pub outcomes: Vec<Outcome>,
}

/// Measures, prints the table, and writes `specialisation.html` and `specialisation.json`. Scenes are
/// what [`bench_scenes::load`] takes; without any there are four.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(order: &Order, scenes: &[String]) -> anyhow::Result<()> {
    let gpu = Gpu::new(&order.adapter)?;
    console::note(&gpu.report().to_string());
    let measurements = measure(&gpu, &bouts(order, scenes))?;
    console::line(&console::table(&HEADINGS, &rows(&measurements.outcomes)));
    for remark in &measurements.remarks {
        console::line(&format!("  {remark}"));
    }
    let page = order.out.join("specialisation.html");
    write_json(&order.out.join("specialisation.json"), &measurements)?;
    write_atomically(&page, page::page(&measurements).as_bytes())?;
    console::line(&format!("\n{}", page.display()));
    Ok(())
}

fn measure(gpu: &Gpu, bouts: &[Bout]) -> anyhow::Result<Measurements> {
    let progress = ProgressBar::new(bouts.iter().map(Bout::steps).sum());
    let mut remarks = Vec::new();
    if gpu.report().is_software() {
        remarks.push("Drawn on the CPU: these times say nothing of a GPU.".to_owned());
    }
    let mut outcomes = Vec::new();
    for bout in bouts {
        match bout.measure(gpu, &progress) {
            Ok(outcome) => outcomes.push(outcome),
            Err(error) => {
                remarks.push(format!("{}, {}: {error:#}.", bout.spec, bout.method.name));
            }
        }
    }
    drop(progress);
    anyhow::ensure!(!outcomes.is_empty(), "nothing could be measured: {}", remarks.join(" "));
    Ok(Measurements {
        provenance: Provenance::here(SCHEMA),
        adapter: Adapter::from(gpu.report()),
        size: bouts.first().map_or((0, 0), |bout| bout.size),
        remarks,
        outcomes,
    })
}

/// Columns of the table.
const HEADINGS: [&str; 9] = [
    "scene",
    "method",
    "shaders",
    "frame ms",
    "times",
    "quartiles",
    "device KiB",
    "code",
    "other pixels",
];

/// A row for each form of each scene and method.
fn rows(outcomes: &[Outcome]) -> Vec<Vec<String>> {
    let of_outcome = |outcome: &Outcome| {
        let row = |row: &run::Row| {
            let mut cells = vec![outcome.scene.clone(), outcome.method.clone(), row.form.clone()];
            match &row.result {
                Ok(measured) => cells.extend(numbers(measured)),
                Err(reason) => cells.push(reason.clone()),
            }
            cells
        };
        outcome.rows.iter().map(row).collect::<Vec<_>>()
    };
    outcomes.iter().flat_map(of_outcome).collect()
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

    fn quick() -> Vec<Bout> {
        let (extent, adapter) = (Extent::Quick, AdapterChoice::Environment);
        bouts(&Order { extent, size: None, adapter, out: PathBuf::new() }, &[])
    }

    /// No form takes less memory than the specialised one; all of them together take more, and other code:
    /// more, but where the certified tree's looks at quartics are left out.
    #[test]
    fn a_quick_run_fills_every_row() {
        let Some(gpu) = Gpu::for_test() else { return };
        let measurements = measure(&gpu, &quick()).expect("measured");
        assert_eq!(measurements.outcomes.len(), HEADLINERS.len());
        for outcome in &measurements.outcomes {
            let measured: Vec<_> =
                outcome.rows.iter().map(|row| row.result.as_ref().expect("measured")).collect();
            assert_eq!(measured.len(), FORMS.len());
            let (least, most) = (measured[0], measured[FORMS.len() - 1]);
            assert_eq!((least.times.median, least.differing_pixels), (1.0, 0));
            for form in &measured[1..] {
                assert!(form.device_bytes >= least.device_bytes, "{outcome:?}");
                assert!(form.device_bytes <= most.device_bytes, "{outcome:?}");
                assert_eq!(form.frame_ms.samples.len(), 2);
            }
            assert!(most.code != least.code && most.device_bytes > least.device_bytes);
        }
        let text = serde_json::to_string(&measurements).expect("JSON");
        let back: Measurements = serde_json::from_str(&text).expect("as written");
        assert_eq!(
            (back.provenance.schema.as_str(), back.outcomes.len()),
            (SCHEMA, HEADLINERS.len())
        );
        let page = page::page(&measurements);
        for forbidden in ["<script", "http", "url(", "{{", "/tmp"] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        assert!(page.contains("a radius each") && page.ends_with("</html>\n"));
    }

    /// What a scene needs cannot be saved, and is said to be needed.
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
        let bout = Bout { spec: "nosuch".to_owned(), ..quick().remove(0) };
        let error = measure(&gpu, &[bout]).expect_err("no such scene").to_string();
        assert!(error.contains("nosuch"), "{error}");
    }
}
