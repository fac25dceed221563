//! Our numbers beside the paper's, and why they differ where they do.

use serde::{Deserialize, Serialize};

use super::paper::{COUNTED, Counts, PRINTED, Printed, Rate};
use super::paper_scene::PaperScene;
use super::plan::{scaled_molecule, support_factors};
use super::run::TreeRun;
use super::tree_variant::TreeVariant;
use crate::extent::Extent;
use harness::numbers::decimal;

/// A factor beyond which a difference to the paper is explained.
pub const NOTABLE: f64 = 1.5;

/// One of the paper's tables of frame rates, with what was measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// How the paper calls it.
    pub name: String,
    /// What it is about.
    pub title: String,
    /// Its rows.
    pub rows: Vec<Row>,
}

/// A row of [`Table`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The scene, as it was loaded.
    pub scene: String,
    /// The structure.
    #[serde(rename = "setting")]
    pub variant: String,
    /// Frames a second in the paper: the mean.
    pub paper_fps: f64,
    /// Least and most of them, where printed.
    pub paper_fps_extremes: Option<(f64, f64)>,
    /// Milliseconds of building in the paper, where printed.
    pub paper_build_ms: Option<f64>,
    /// How many times as fast as the scene's first row in the paper; `null` in that row.
    pub paper_ratio: Option<f64>,
    /// The same as measured; `null` also when either failed.
    pub ratio: Option<f64>,
    /// Why the two ratios differ, where they do notably.
    pub why: Option<String>,
}

/// Table 3: work a ray.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WorkRow {
    /// The scene, as it was loaded.
    pub scene: String,
    /// The structure.
    #[serde(rename = "setting")]
    pub variant: String,
    /// The paper's traversals, intersection tests and balls.
    pub paper: [f64; 3],
    /// Ours.
    pub measured: Option<[f64; 3]>,
    /// Why ours differ, where their ratio to the first row does notably.
    pub why: Option<String>,
}

/// Not in the paper: what table 1's gain on the molecule depends on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Density {
    /// How many times as fast the Fitted BVH is in the paper.
    pub paper_ratio: f64,
    /// The molecule with its supports scaled, the sparsest first.
    pub rows: Vec<DensityRow>,
    /// What follows from them.
    pub why: Option<String>,
}

/// A row of [`Density`]: the modified BVH over the Fitted BVH.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DensityRow {
    /// The scene, as it was loaded.
    pub scene: String,
    /// The factor on its supports.
    pub supports: f32,
    /// Ratio of frame times; `null`, as the others, when either failed.
    pub time: Option<f64>,
    /// Ratio of kernels a ray.
    pub kernels: Option<f64>,
    /// Ratio of nodes a ray.
    pub nodes: Option<f64>,
}

/// The run of a variant on a scene.
pub fn find<'a>(runs: &'a [TreeRun], scene: &str, variant: &str) -> Option<&'a TreeRun> {
    runs.iter().find(|run| run.scene == scene && run.variant == variant)
}

/// All tables of frame rates.
pub fn tables(extent: Extent, runs: &[TreeRun]) -> Vec<Table> {
    let table = |printed: &Printed| Table {
        name: printed.name.to_owned(),
        title: printed.title.to_owned(),
        rows: printed.rows.iter().map(|rate| row(extent, runs, printed, rate)).collect(),
    };
    PRINTED.iter().map(table).collect()
}

fn row(extent: Extent, runs: &[TreeRun], table: &Printed, rate: &Rate) -> Row {
    let scene = rate.scene.spec(extent);
    let first = table.rows.iter().find(|other| other.scene == rate.scene);
    let first = first.filter(|first| first.variant != rate.variant);
    let paper_ratio = first.map(|first| rate.fps / first.fps);
    let pair = first.and_then(|first| {
        let slow = find(runs, scene, &first.variant.name())?;
        Some((slow, find(runs, scene, &rate.variant.name())?))
    });
    let ratio = pair.map(|(slow, fast)| slow.mean_ms() / fast.mean_ms());
    let why = pair.zip(paper_ratio).and_then(|((slow, fast), paper)| explain(slow, fast, paper));
    Row {
        scene: scene.to_owned(),
        variant: rate.variant.name(),
        paper_fps: rate.fps,
        paper_fps_extremes: rate.extremes,
        paper_build_ms: rate.build_ms,
        paper_ratio,
        ratio,
        why,
    }
}

/// Table 3, with what was counted.
pub fn work_table(extent: Extent, runs: &[TreeRun]) -> Vec<WorkRow> {
    let scene = PaperScene::Tornado4k.spec(extent);
    let counted = |row: &Counts| {
        let work = find(runs, scene, &row.variant.name())?.work;
        Some([work.nodes_per_ray, work.leaf_tests_per_ray, work.balls_per_ray])
    };
    let printed = |row: &Counts| [row.nodes, row.leaf_tests, row.balls];
    let row = |row: &Counts| WorkRow {
        scene: scene.to_owned(),
        variant: row.variant.name(),
        paper: printed(row),
        measured: counted(row),
        why: counted(&COUNTED[0]).zip(counted(row)).and_then(|(first, here)| {
            explain_work(first, here, printed(&COUNTED[0]), printed(row))
        }),
    };
    COUNTED.iter().map(row).collect()
}

/// The molecule sparser and denser.
pub fn density(extent: Extent, runs: &[TreeRun]) -> Density {
    let row = |&factor: &f32| {
        let scene = scaled_molecule(factor);
        let run = |variant: TreeVariant| find(runs, &scene, &variant.name());
        let pair = run(TreeVariant::Modified).zip(run(TreeVariant::Fitted));
        let ratio = |of: fn(&TreeRun) -> f64| pair.map(|(slow, fast)| of(slow) / of(fast));
        DensityRow {
            supports: factor,
            time: ratio(TreeRun::mean_ms),
            kernels: ratio(TreeRun::kernels_per_ray),
            nodes: ratio(|run| run.work.nodes_per_ray),
            scene,
        }
    };
    let rows: Vec<_> = support_factors(extent).iter().map(row).collect();
    let rate = |variant| {
        let rows = || PRINTED.iter().flat_map(|table| table.rows);
        let row = rows().find(|row| row.scene == PaperScene::Molecule && row.variant == variant);
        row.map_or(f64::NAN, |row| row.fps)
    };
    let paper_ratio = rate(TreeVariant::Fitted) / rate(TreeVariant::Modified);
    let why = rows.first().zip(rows.last()).and_then(|ends| explain_density(ends, paper_ratio));
    Density { paper_ratio, rows, why }
}

fn explain_density(
    (sparse, dense): (&DensityRow, &DensityRow),
    paper_ratio: f64,
) -> Option<String> {
    let range = |of: fn(&DensityRow) -> Option<f64>| {
        Some(format!("{} to {}", decimal(of(sparse)?), decimal(of(dense)?)))
    };
    let within = sparse.time? <= paper_ratio && paper_ratio <= dense.time?;
    Some(format!(
        "The gain goes with the kernels that are saved, and these with how many supports overlap, \
         which the paper does not print: from supports × {} to × {}, kernels a ray fall by {} and \
         frames are {} times as fast, {} the paper's {}; nodes a ray fall by {}, and what both \
         trees share keeps the gain below the kernels saved.",
        sparse.supports,
        dense.supports,
        range(|row| row.kernels)?,
        range(|row| row.time)?,
        if within { "among them" } else { "not among them" },
        decimal(paper_ratio),
        range(|row| row.nodes)?,
    ))
}

/// Which of the three counters fall by another factor than in the paper.
fn explain_work(
    first: [f64; 3],
    here: [f64; 3],
    paper_first: [f64; 3],
    paper: [f64; 3],
) -> Option<String> {
    let names = ["traversals", "tests", "balls"];
    let differing: Vec<_> = (0..3)
        .filter_map(|counter| {
            let ratio = first[counter] / here[counter];
            let printed = paper_first[counter] / paper[counter];
            notable(ratio, printed).then(|| {
                let name = names[counter];
                format!(
                    "{name} fall by {} where the paper has {}",
                    decimal(ratio),
                    decimal(printed)
                )
            })
        })
        .collect();
    (!differing.is_empty()).then(|| {
        format!(
            "A ray's {}: it tests {} leaves of {} balls here, {} of {} in the paper.",
            differing.join(", "),
            decimal(here[1]),
            decimal(here[2] / here[1]),
            decimal(paper[1]),
            decimal(paper[2] / paper[1])
        )
    })
}

/// Whether two ratios differ by more than [`NOTABLE`].
fn notable(one: f64, other: f64) -> bool {
    !(one / other <= NOTABLE && other / one <= NOTABLE)
}

/// What the work counters say of a ratio of frame times that is notably not the paper's.
fn explain(slow: &TreeRun, fast: &TreeRun, paper: f64) -> Option<String> {
    let time = slow.mean_ms() / fast.mean_ms();
    if !notable(time, paper) {
        return None;
    }
    let pair = |of: fn(&TreeRun) -> f64| format!("{} to {}", decimal(of(slow)), decimal(of(fast)));
    let work = slow.kernels_per_ray() / fast.kernels_per_ray();
    let counted = format!("{} kernels a ray (÷ {})", pair(TreeRun::kernels_per_ray), decimal(work));
    let lists = pair(|run| run.work.balls_per_ray);
    Some(if time > paper && work >= time / NOTABLE {
        let [slow, fast] = &COUNTED;
        format!(
            "More gained, since more work is saved: from {counted}, with lists of {lists} balls a \
             ray; of the paper's work only table 3 is printed, where these go from {} to {}.",
            slow.balls, fast.balls
        )
    } else if time > paper {
        let waiting = pair(|run| 100.0 * resumed(run));
        format!(
            "More gained than work explains, from {counted}: the share of the passes that resume \
             rays goes from {waiting} %."
        )
    } else if work > time * NOTABLE {
        let nodes = pair(|run| run.work.nodes_per_ray);
        format!(
            "Less gained than work is saved, from {counted}: nodes a ray only go from {nodes}, and \
             what every frame costs does not shrink with the lists."
        )
    } else {
        format!(
            "Less gained, since less work is saved: from {counted}, with lists of {lists} balls a \
             ray."
        )
    })
}

/// The part of the passes' time that goes to resumed rays.
fn resumed(run: &TreeRun) -> f64 {
    let total: f64 = run.passes.values().sum();
    run.passes.get("resume").map_or(0.0, |resumed| resumed / total.max(f64::MIN_POSITIVE))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::tables::gourmel::run::TreeSize;
    use harness::record::{Samples, WorkPerRay};

    fn run(variant: &str, frame_ms: f64, evaluations_per_ray: f64) -> TreeRun {
        TreeRun {
            scene: "pool-10k".to_owned(),
            balls: 10_000,
            variant: variant.to_owned(),
            build_ms: Samples::new(vec![1.0]),
            frame_ms: Samples::new(vec![0.5 * frame_ms, 1.5 * frame_ms]),
            passes: BTreeMap::from([("trace".to_owned(), 3.0), ("resume".to_owned(), 1.0)]),
            tree: TreeSize {
                nodes: 1,
                leaves: 2,
                list_entries: 3,
                bytes: 4,
                depth: 1,
                own_per_leaf: 1.0,
                split_per_leaf: 0.5,
            },
            work: WorkPerRay {
                nodes_per_ray: 10.0,
                leaf_tests_per_ray: 2.0,
                balls_per_ray: 20.0,
                evaluations_per_ray,
            },
        }
    }

    #[test]
    fn ratios_stand_beside_the_papers() {
        let runs = [run("bvh", 40.0, 4000.0), run("fbvh", 10.0, 1000.0)];
        assert_eq!((runs[0].mean_ms(), runs[0].extremes_ms()), (40.0, (20.0, 60.0)));
        let tables = tables(Extent::Whole, &runs);
        let pool: Vec<_> = tables[0].rows.iter().filter(|row| row.scene == "pool-10k").collect();
        assert_eq!((pool[0].ratio, pool[0].paper_ratio), (None, None));
        assert_eq!((pool[1].ratio, pool[1].paper_ratio), (Some(4.0), Some(7.1 / 1.9)));
        assert_eq!(pool[1].why, None);
        assert!(tables[0].rows.iter().all(|row| row.scene == "pool-10k" || row.ratio.is_none()));
    }

    #[test]
    fn differences_are_explained_by_what_was_counted() {
        let why = |frame_ms, evaluations| {
            explain(&run("bvh", frame_ms, evaluations), &run("fbvh", 10.0, 100.0), 3.0)
        };
        assert_eq!(why(30.0, 900.0), None);
        let cases = [
            (100.0, 1000.0, "More gained, since"),
            (100.0, 100.0, "More gained than"),
            (10.0, 1000.0, "Less gained than"),
            (10.0, 100.0, "Less gained, since"),
        ];
        for (frame_ms, evaluations, start) in cases {
            let why = why(frame_ms, evaluations).expect("a difference");
            assert!(why.starts_with(start), "{why}");
        }
        assert!(why(100.0, 100.0).expect("a difference").contains("25.0 to 25.0 %"));
    }
}
