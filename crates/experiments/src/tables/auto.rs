//! The command `tables auto`: what `auto` chooses, and in what time, beside the quickest of all that it
//! could have chosen, and its error along rays on which nothing was chosen.

mod page;
pub mod study;

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use self::study::{Outcome, Study, Verdict};
use crate::console::{self, ProgressBar};
use crate::tables::{Extent, Order, named_or};
use harness::auto::MAX_ERROR;
use harness::configuration::Configuration;
use harness::configuration::sweeps::candidates;
use harness::machine::Provenance;
use harness::numbers::{decimal, grouped, small};
use harness::output::write_json;
use harness::record::Adapter;
use picture_files::write_atomically;

/// Name and version of the format of `auto.json`.
pub const SCHEMA: &str = "metaball-tables-auto/1";

/// Errors that are asked for, mean support radii: the default of `auto`, and one that cubics may keep.
const ERRORS: [f64; 2] = [MAX_ERROR, 0.05];

/// `scenes`, or the extent's own where there are none.
fn studies(order: &Order, scenes: &[String]) -> Vec<Study> {
    let (own, size): (&[&str], _) = match order.extent {
        Extent::Quick => (&["random-200", "two-merging"], (48, 36)),
        Extent::Whole => (
            &[
                "molecule",
                "scattered-30k",
                "tornado-4k",
                "dam-break",
                "random-1k",
                "fountain:20000",
                "two-merging",
                "pool:3000",
            ],
            (320, 240),
        ),
    };
    let size = order.size.unwrap_or(size);
    let study = |spec| Study { spec, size, errors: &ERRORS };
    named_or(scenes, own).into_iter().map(study).collect()
}

/// Who can be chosen.
fn configurations(extent: Extent) -> Vec<Configuration> {
    const FEW: [&str; 4] = ["fbvh-certified", "illes", "illes, array 24", "illes-exact"];
    let takes_part = |configuration: &Configuration| {
        extent == Extent::Whole || FEW.contains(&configuration.name.as_str())
    };
    candidates().into_iter().filter(takes_part).collect()
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Where it comes from; its format is [`SCHEMA`].
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What drew.
    pub adapter: Adapter,
    /// What a reader should know.
    pub remarks: Vec<String>,
    /// The scenes, in the order measured.
    pub scenes: Vec<Outcome>,
}

/// Measures, prints the table, and writes `auto.html` and `auto.json`. Scenes are what
/// [`bench_scenes::load`] takes; without any there are eight.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(order: &Order, scenes: &[String]) -> anyhow::Result<()> {
    let gpu = Gpu::new(&order.adapter)?;
    console::note(&gpu.report().to_string());
    let measurements = measure(&gpu, &studies(order, scenes), &configurations(order.extent));
    console::line(&console::table(&HEADINGS, &rows(&measurements.scenes)));
    for remark in &measurements.remarks {
        console::line(remark);
    }
    let page = order.out.join("auto.html");
    write_json(&order.out.join("auto.json"), &measurements)?;
    write_atomically(&page, page::page(&measurements).as_bytes())?;
    console::line(&format!("\n{}", page.display()));
    let measured = measurements.scenes.iter().any(|scene| scene.result.is_ok());
    anyhow::ensure!(measured, "nothing could be measured; see the page");
    Ok(())
}

fn measure(gpu: &Gpu, studies: &[Study], configurations: &[Configuration]) -> Measurements {
    let progress = ProgressBar::new(studies.iter().map(|study| study.steps(configurations)).sum());
    let outcome = |study: &Study| {
        let result = study.make(gpu, configurations, &progress);
        Outcome {
            scene: study.spec.clone(),
            size: study.size,
            result: result.map_err(|error| format!("{error:#}")),
        }
    };
    let scenes: Vec<_> = studies.iter().map(outcome).collect();
    Measurements {
        provenance: Provenance::here(SCHEMA),
        adapter: gpu.report().into(),
        remarks: remarks(&scenes),
        scenes,
    }
}

/// A choice may take this many times as long as the best.
const NEAR: f64 = 1.2;

/// In how many cases `auto` did what it is for.
fn remarks(scenes: &[Outcome]) -> Vec<String> {
    let verdicts: Vec<_> = scenes.iter().flat_map(Outcome::verdicts).collect();
    let near = verdicts.iter().filter(|verdict| verdict.ratio().is_some_and(|it| it <= NEAR));
    let kept = verdicts.iter().filter(|verdict| verdict.is_kept() == Some(true));
    let worst = verdicts.iter().filter_map(|verdict| verdict.ratio()).fold(0.0, f64::max);
    vec![format!(
        "In {} of {} cases the choice takes at most {NEAR} times as long as the best, {} times at \
         worst; in {} it keeps the error along rays on which nothing was chosen.",
        near.count(),
        verdicts.len(),
        decimal(worst),
        kept.count()
    )]
}

/// Columns of the table.
const HEADINGS: [&str; 10] = [
    "scene",
    "error",
    "chosen",
    "ms",
    "best",
    "ms",
    "ratio",
    "99 % within",
    "wrong rays",
    "chosen in s",
];

/// A row for each scene and error, or one with a reason.
fn rows(scenes: &[Outcome]) -> Vec<Vec<String>> {
    let rows_of = |outcome: &Outcome| match &outcome.result {
        Ok(measured) => {
            measured.verdicts.iter().map(|verdict| row(&outcome.scene, verdict)).collect()
        }
        Err(reason) => {
            let mut row = vec![String::new(); HEADINGS.len()];
            row[0].clone_from(&outcome.scene);
            row[2].clone_from(reason);
            vec![row]
        }
    };
    scenes.iter().flat_map(rows_of).collect()
}

fn row(scene: &str, verdict: &Verdict) -> Vec<String> {
    let ms = |ms: Option<f64>| ms.map_or_else(|| "–".to_owned(), decimal);
    let chosen = match &verdict.choice {
        Ok(choice) => choice.configuration.clone(),
        Err(_) => "nobody".to_owned(),
    };
    let drawn = verdict.drawn.as_ref();
    let best = verdict.best.as_ref();
    vec![
        scene.to_owned(),
        small(verdict.max_error),
        chosen,
        ms(drawn.map(|drawn| drawn.frame_ms)),
        best.map_or_else(|| "nobody".to_owned(), |best| best.0.clone()),
        ms(best.map(|best| best.1)),
        ms(verdict.ratio()),
        drawn.map_or_else(|| "–".to_owned(), |drawn| small(drawn.errors.p99)),
        drawn.map_or_else(
            || "–".to_owned(),
            |drawn| format!("{} of {}", grouped(drawn.errors.wrong), grouped(drawn.errors.rays)),
        ),
        decimal(verdict.seconds),
    ]
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use metaball_core::gpu::AdapterChoice;

    use super::*;

    fn order(extent: Extent) -> Order {
        Order { extent, size: None, adapter: AdapterChoice::Environment, out: PathBuf::new() }
    }

    #[test]
    fn all_scenes_load_and_candidates_are_known() {
        for study in studies(&order(Extent::Quick), &[]) {
            study.load().expect("loads");
        }
        assert!(studies(&order(Extent::Whole), &[]).len() >= 6);
        assert_eq!(configurations(Extent::Whole).len(), candidates().len());
        assert_eq!(configurations(Extent::Quick).len(), 4);
    }

    #[test]
    fn a_quick_study_is_whole() {
        let Some(gpu) = Gpu::for_test() else { return };
        let scenes = ["random-200", "nowhere.toml"].map(str::to_owned);
        let studies = studies(&order(Extent::Quick), &scenes);
        let measurements = measure(&gpu, &studies, &configurations(Extent::Quick));
        let [studied, missing] = &measurements.scenes[..] else { panic!("two scenes") };
        assert!(missing.result.is_err());
        let measured = studied.result.as_ref().expect("measured");
        assert_eq!(measured.all.len(), 4);
        assert_eq!(measured.verdicts.len(), ERRORS.len());
        for verdict in &measured.verdicts {
            let choice = verdict.choice.as_ref().expect("somebody will do");
            assert!(choice.errors.keep(verdict.max_error));
            let drawn = verdict.drawn.expect("chosen from all");
            let ratio = verdict.ratio().expect("both drew");
            // Nobody who keeps the error is quicker than the quickest of all who do.
            assert!(ratio >= 1.0 || !drawn.errors.keep(verdict.max_error), "{verdict:?}");
        }
        assert_eq!(measured.verdicts[0].is_kept(), Some(true));
        // The cubic is out where a thousandth of a radius is asked for.
        let strict = measured.verdicts[0].choice.as_ref().expect("somebody will do");
        assert!(strict.left_out.iter().any(|(name, _)| name == "illes"), "{strict:?}");

        let text = serde_json::to_string(&measurements).expect("JSON");
        let back: Measurements = serde_json::from_str(&text).expect("as written");
        assert_eq!(back.scenes.len(), 2);
        let page = page::page(&measurements);
        for forbidden in ["<script", "http", "url(", "{{", "NaN"] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        assert!(page.contains("nowhere.toml") && page.ends_with("</html>\n"));
    }
}
