//! The command `tables auto`: what `auto` chooses, and in what time, beside the quickest of all that it
//! could have chosen, and its error along rays on which nothing was chosen.

mod page;
pub mod run;

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use self::run::{JudgedChoice, Measured, PlannedScene};
use crate::console::{ProgressBar, open_adapter};
use crate::extent::Extent;
use crate::table::{Column, Table};
use crate::tables::heading::Heading;
use crate::tables::report::{Report, publish};
use crate::tables::scene_result::SceneResult;
use crate::tables::{Options, named_or};
use harness::auto::MAX_ERROR;
use harness::configuration::Configuration;
use harness::configuration::sweeps::candidates;
use harness::numbers::{decimal, grouped, small};

/// Name and version of the format of `auto.json`.
pub const SCHEMA: &str = "metaball-tables-auto/1";

/// Errors that are allowed, mean support radii: the default of `auto`, and one that cubics may keep.
const ERRORS: [f64; 2] = [MAX_ERROR, 0.05];

/// `scenes`, or the extent's own where there are none.
fn plan(options: &Options, scenes: &[String]) -> Vec<PlannedScene> {
    let (own, size): (&[&str], _) = match options.extent {
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
    let size = options.size.unwrap_or(size);
    let planned = |spec| PlannedScene { spec, size, errors: &ERRORS };
    named_or(scenes, own).into_iter().map(planned).collect()
}

/// Who can be chosen.
fn configurations(extent: Extent) -> Vec<Configuration> {
    const FEW: [&str; 4] =
        ["fbvh-certified", "illes-rebuilt", "illes-rebuilt, array 24", "illes-exact"];
    let takes_part = |configuration: &Configuration| {
        extent == Extent::Whole || FEW.contains(&configuration.name.as_str())
    };
    candidates().into_iter().filter(takes_part).collect()
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Its format is [`SCHEMA`].
    #[serde(flatten)]
    pub heading: Heading,
    /// The scenes, in the order measured.
    pub scenes: Vec<SceneResult<Measured>>,
}

/// Measures, prints the table, and writes `auto.html` and `auto.json`. Scenes are what
/// [`bench_scenes::load`] takes; without any there are eight.
///
/// # Errors
/// Without an adapter, when a file cannot be written, or when nothing could be measured.
pub fn tables(options: &Options, scenes: &[String]) -> anyhow::Result<()> {
    let gpu = open_adapter(&options.adapter)?;
    publish(&options.out, scenes, || {
        Ok(measure(&gpu, &plan(options, scenes), &configurations(options.extent)))
    })
}

fn measure(gpu: &Gpu, plan: &[PlannedScene], configurations: &[Configuration]) -> Measurements {
    let progress = ProgressBar::new(plan.iter().map(|scene| scene.steps(configurations)).sum());
    let measured = |planned: &PlannedScene| {
        let result = planned.measure(gpu, configurations, &progress);
        SceneResult::new(&planned.spec, planned.size, result)
    };
    let scenes: Vec<_> = plan.iter().map(measured).collect();
    Measurements { heading: Heading::new(SCHEMA, Some(gpu), remarks(&scenes)), scenes }
}

impl Report for Measurements {
    const NAME: &'static str = "auto";

    fn text(&self) -> String {
        self.heading.text_with_remarks(&table(&self.scenes))
    }

    fn page(&self) -> String {
        page::page(self)
    }

    fn is_empty(&self) -> bool {
        self.scenes.iter().all(|scene| scene.result.is_err())
    }
}

/// A choice may take this many times as long as the best.
const NEAR: f64 = 1.2;

/// In how many cases `auto` did what it is for.
fn remarks(scenes: &[SceneResult<Measured>]) -> Vec<String> {
    let measured = scenes.iter().filter_map(|scene| scene.result.as_ref().ok());
    let choices: Vec<_> = measured.flat_map(|measured| &measured.choices).collect();
    let near = choices.iter().filter(|choice| choice.ratio().is_some_and(|it| it <= NEAR));
    let kept = choices.iter().filter(|choice| choice.is_kept() == Some(true));
    let worst = choices.iter().filter_map(|choice| choice.ratio()).fold(0.0, f64::max);
    vec![format!(
        "In {} of {} cases the choice takes at most {NEAR} times as long as the best, {} times at \
         worst; in {} it keeps the error along rays on which nothing was chosen.",
        near.count(),
        choices.len(),
        decimal(worst),
        kept.count()
    )]
}

/// A row for each scene and error, or one with a reason.
fn table(scenes: &[SceneResult<Measured>]) -> Table {
    let columns = [
        Column::text("scene"),
        Column::number("error"),
        Column::text("chosen"),
        Column::number("ms"),
        Column::text("best"),
        Column::number("ms"),
        Column::number("ratio"),
        Column::number("99 % within"),
        Column::number("wrong rays"),
        Column::number("chosen in").of("s"),
    ];
    let rows_of = |scene: &SceneResult<Measured>| match &scene.result {
        Ok(measured) => measured.choices.iter().map(|choice| row(&scene.scene, choice)).collect(),
        Err(reason) => vec![vec![scene.scene.clone(), String::new(), reason.clone()]],
    };
    let rows = scenes.iter().flat_map(rows_of).collect();
    Table { title: "Chosen, and best".to_owned(), columns: columns.into(), rows }
}

fn row(scene: &str, judged: &JudgedChoice) -> Vec<String> {
    let ms = |ms: Option<f64>| ms.map_or_else(|| "–".to_owned(), decimal);
    let chosen = match &judged.choice {
        Ok(choice) => choice.configuration.clone(),
        Err(_) => "none".to_owned(),
    };
    let drawn = judged.drawn.as_ref();
    let best = judged.best.as_ref();
    vec![
        scene.to_owned(),
        small(judged.max_error),
        chosen,
        ms(drawn.map(|drawn| drawn.frame_ms)),
        best.map_or_else(|| "none".to_owned(), |best| best.0.clone()),
        ms(best.map(|best| best.1)),
        ms(judged.ratio()),
        drawn.map_or_else(|| "–".to_owned(), |drawn| small(drawn.errors.p99)),
        drawn.map_or_else(
            || "–".to_owned(),
            |drawn| format!("{} of {}", grouped(drawn.errors.wrong), grouped(drawn.errors.rays)),
        ),
        decimal(judged.seconds),
    ]
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use metaball_core::gpu::AdapterChoice;

    use super::*;
    use crate::testing::{assert_stands_alone, read_back};

    fn options(extent: Extent) -> Options {
        Options { extent, size: None, adapter: AdapterChoice::Environment, out: PathBuf::new() }
    }

    #[test]
    fn all_scenes_load_and_candidates_are_known() {
        for planned in plan(&options(Extent::Quick), &[]) {
            planned.load().expect("loads");
        }
        assert!(plan(&options(Extent::Whole), &[]).len() >= 6);
        assert_eq!(configurations(Extent::Whole).len(), candidates().len());
        assert_eq!(configurations(Extent::Quick).len(), 4);
    }

    #[test]
    fn a_quick_study_is_whole() {
        let Some(gpu) = Gpu::for_test() else { return };
        let scenes = ["random-200", "nowhere.toml"].map(str::to_owned);
        let plan = plan(&options(Extent::Quick), &scenes);
        let measurements = measure(&gpu, &plan, &configurations(Extent::Quick));
        let [found, missing] = &measurements.scenes[..] else { panic!("two scenes") };
        assert!(missing.result.is_err());
        let measured = found.result.as_ref().expect("measured");
        assert_eq!(measured.all.len(), 4);
        assert_eq!(measured.choices.len(), ERRORS.len());
        for judged in &measured.choices {
            let choice = judged.choice.as_ref().expect("one will do");
            assert!(choice.errors.keep(judged.max_error));
            let drawn = judged.drawn.expect("chosen from all");
            let ratio = judged.ratio().expect("both drew");
            // None that keeps the error is quicker than the quickest of all that do.
            assert!(ratio >= 1.0 || !drawn.errors.keep(judged.max_error), "{judged:?}");
        }
        assert_eq!(measured.choices[0].is_kept(), Some(true));
        // The cubic is out where a thousandth of a radius is allowed.
        let strict = measured.choices[0].choice.as_ref().expect("one will do");
        assert!(strict.left_out.iter().any(|(name, _)| name == "illes-rebuilt"), "{strict:?}");

        let back = read_back(&measurements);
        assert_eq!(back.scenes.len(), 2);
        let page = page::page(&measurements);
        assert_stands_alone(&page, &["NaN"]);
        assert!(page.contains("nowhere.toml"));
    }
}
