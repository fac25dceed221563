//! Our numbers beside the paper's.

use serde::{Deserialize, Serialize};

use super::effect::Effect;
use super::paper::{COST_EFFECTS, COSTS, Costs, GAINS, Gain};
use super::run::{EffectRun, PassKind, Wanted};
use crate::extent::Extent;
use harness::numbers::decimal;

/// The paper's structures, and the one beside them.
pub const METHODS: [&str; 3] = ["bvh", FITTED, "fbvh-certified"];

const FITTED: &str = "fbvh";

/// A row of table 2: what an effect costs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CostRow {
    /// The scene, as it was loaded.
    pub scene: String,
    /// Name of the effect.
    pub effect: String,
    /// How many times as long a frame takes as one that is only ray cast, in the paper.
    pub paper: f64,
    /// The same with the Fitted BVH here; `null`, as the next, when a run failed.
    pub fitted: Option<f64>,
    /// And with the certified tree.
    pub certified: Option<f64>,
    /// Where the Fitted BVH's time goes, where it costs more than in the paper.
    pub why: Option<String>,
}

/// A row of table 1: what the Fitted BVH gains under the scene's own effects.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GainRow {
    /// The scene, as it was loaded.
    pub scene: String,
    /// Name of its effect.
    pub effect: String,
    /// How many times as fast as the modified BVH, in the paper.
    pub paper: f64,
    /// The same here; `null`, as the next, when a run failed.
    pub fitted: Option<f64>,
    /// The certified tree, times as fast as the modified BVH.
    pub certified: Option<f64>,
}

/// The run of a method with an effect.
pub fn find<'a>(
    runs: &'a [EffectRun],
    scene: &str,
    method: &str,
    effect: &str,
) -> Option<&'a EffectRun> {
    runs.iter().find(|run| run.scene == scene && run.method == method && run.effect == effect)
}

/// Everything that the tables need, each once, by scene in the order of the paper.
pub fn measurements(extent: Extent) -> Vec<(&'static str, Vec<Wanted>)> {
    let costs = COSTS.iter().flat_map(|row| {
        let methods = &METHODS[1..];
        COST_EFFECTS.iter().flat_map(move |&effect| {
            methods.iter().map(move |&method| (row.scene, Wanted { method, effect }))
        })
    });
    let gains = GAINS.iter().flat_map(|row| {
        METHODS.iter().map(|&method| (row.scene, Wanted { method, effect: row.effect }))
    });
    let mut measurements: Vec<(&str, Vec<Wanted>)> = Vec::new();
    for (scene, wanted) in costs.chain(gains) {
        let spec = scene.spec(extent);
        match measurements.iter_mut().find(|(of, _)| *of == spec) {
            Some((_, all)) if all.contains(&wanted) => {}
            Some((_, all)) => all.push(wanted),
            None => measurements.push((spec, vec![wanted])),
        }
    }
    measurements
}

/// Table 2.
pub fn costs(extent: Extent, runs: &[EffectRun]) -> Vec<CostRow> {
    let rows = |printed: &Costs| {
        let scene = printed.scene.spec(extent);
        let row = |(&effect, fps): (&Effect, &f64)| {
            let pair = |method| {
                let run = |effect: Effect| find(runs, scene, method, &effect.name());
                run(effect).zip(run(Effect::Cast))
            };
            let cost = |method| pair(method).and_then(|(run, cast)| run.times_as_long_as(cast));
            let (paper, fitted) = (printed.fps[0] / fps, cost(FITTED));
            let is_dearer = fitted.is_some_and(|fitted| fitted > paper);
            let why = pair(FITTED).filter(|_| is_dearer).map(|(run, cast)| explain(run, cast));
            CostRow {
                scene: scene.to_owned(),
                effect: effect.name(),
                paper,
                fitted,
                certified: cost(METHODS[2]),
                why,
            }
        };
        // The first is what the others are compared with.
        COST_EFFECTS.iter().zip(&printed.fps).skip(1).map(row).collect::<Vec<_>>()
    };
    COSTS.iter().flat_map(rows).collect()
}

/// Table 1.
pub fn gains(extent: Extent, runs: &[EffectRun]) -> Vec<GainRow> {
    let row = |printed: &Gain| {
        let (scene, effect) = (printed.scene.spec(extent), printed.effect.name());
        let modified = find(runs, scene, METHODS[0], &effect);
        let gain = |method| {
            modified.and_then(|slow| slow.times_as_long_as(find(runs, scene, method, &effect)?))
        };
        GainRow {
            scene: scene.to_owned(),
            fitted: gain(FITTED),
            certified: gain(METHODS[2]),
            effect,
            paper: printed.fitted / printed.modified,
        }
    };
    GAINS.iter().map(row).collect()
}

/// Where the time goes, in shares of a frame that is only ray cast.
fn explain(run: &EffectRun, cast: &EffectRun) -> String {
    let whole = cast.frame_ms.median.max(f64::MIN_POSITIVE);
    let share = |kind: PassKind| {
        format!("{} {}", kind.name(), decimal((run.pass_ms(kind) - cast.pass_ms(kind)) / whole))
    };
    let shares = PassKind::ALL.map(share).join(", ");
    format!("Added to a ray cast of 1: {shares}.")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::tables::gourmel::paper_scene::PaperScene;
    use harness::record::Samples;

    fn run(method: &str, effect: Effect, ms: f64) -> EffectRun {
        EffectRun {
            scene: "molecule".to_owned(),
            balls: 5547,
            method: method.to_owned(),
            effect: effect.name(),
            frame_ms: Samples::new(vec![0.5 * ms, ms, 3.0 * ms]),
            passes: BTreeMap::from([("first hits".to_owned(), 8.0), ("any hits".to_owned(), ms)]),
            undecided: 0,
        }
    }

    #[test]
    fn each_pair_is_drawn_once() {
        for extent in [Extent::Whole, Extent::Quick] {
            let measurements = measurements(extent);
            assert_eq!(measurements.len(), 4);
            let pairs: usize = measurements.iter().map(|(_, wanted)| wanted.len()).sum();
            // Two tables of 16 and 15, two of which are in both: the molecule's hard shadows.
            assert_eq!(pairs, 16 + 15 - 2);
        }
        assert!(GAINS.iter().any(|gain| gain.scene == PaperScene::Pool));
    }

    #[test]
    fn costs_and_gains_stand_beside_the_papers() {
        let runs = [
            run("bvh", Effect::Shadows, 60.0),
            run("fbvh", Effect::Cast, 10.0),
            run("fbvh", Effect::Shadows, 15.0),
            run("fbvh", Effect::ShadowedMirrors(1), 12.0),
        ];
        let costs = costs(Extent::Whole, &runs);
        let molecule: Vec<_> = costs.iter().filter(|row| row.scene == "molecule").collect();
        assert_eq!((costs.len(), molecule.len()), (6, 3));
        assert_eq!((molecule[0].fitted, molecule[0].certified), (Some(1.5), None));
        assert_eq!(molecule[0].paper, 22.3 / 17.7);
        let why = molecule[0].why.as_deref().expect("dearer");
        assert!(why.contains("first hits 0.00") && why.contains("any hits 0.50"), "{why}");
        assert!(molecule[1].fitted == Some(1.2) && molecule[1].why.is_none());
        let gains = gains(Extent::Whole, &runs);
        let shadows = gains.iter().find(|row| row.effect == "hard shadows").expect("printed");
        assert_eq!((shadows.fitted, shadows.paper), (Some(4.0), 17.7 / 5.8));
    }
}
