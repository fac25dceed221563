//! Lit pictures by both tracers, each as a whole process, in turns.

mod ours;

use std::time::Instant;

use anyhow::Context;
use glam::Vec3;
use metaball_light::cpu::{Rays, Rows};
use rayon::ThreadPool;
use serde::{Deserialize, Serialize};

use super::effect::LitEffect;
use super::lamp_truth::{LampTruth, WrongLight};
use super::povray::Povray;
use super::povray::lit::{LitCost, LitPicture};
use super::run::{PlannedScene, THREADS};
use crate::console::ProgressBar;
use harness::measure::milliseconds;
use harness::record::Samples;

/// Light that differs by more in any channel is another: two steps of eight bits.
const SAME: f32 = 2.0 / 255.0;

/// Both tracers' pictures in one light.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LitPair {
    /// Name of the effect.
    pub effect: String,
    /// How the peer does it.
    pub peer_effect: String,
    /// The certified tree and the path tracer on the CPU.
    pub ours: LitRun,
    /// POV-Ray, or why there is nothing of it.
    pub peer: Result<LitRun, String>,
    /// Share of pixels whose linear light, 0 to 1, differs by more than two steps of eight bits in any
    /// channel; `null` without the peer, and where the two do not draw the same.
    pub differing: Option<f64>,
}

/// A tracer's pictures in one light.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LitRun {
    /// Milliseconds of the whole, each round, by the wall's clock. Ours loads or generates the scene,
    /// builds, traces, develops and encodes a PNG; the peer is a process that parses its file, traces,
    /// and writes a PNG.
    pub process_ms: Samples,
    /// Milliseconds of these that the peer's own clock gives for parsing and tracing, each round;
    /// `null` for ours.
    pub work_ms: Option<Samples>,
    /// Occlusion rays of a picture.
    pub occlusion_rays: u64,
    /// Comparison with the oracle; of hard shadows alone.
    pub wrong: Option<WrongLight>,
}

impl LitPair {
    /// The peer's whole process over ours; medians.
    pub fn times_as_fast(&self) -> Option<f64> {
        let peer = self.peer.as_ref().ok()?;
        Some(peer.process_ms.median / self.ours.process_ms.median)
    }

    /// What the peer's own clock gives over the whole of ours; medians.
    pub fn times_as_fast_as_work(&self) -> Option<f64> {
        let work = self.peer.as_ref().ok()?.work_ms.as_ref()?;
        Some(work.median / self.ours.process_ms.median)
    }
}

/// Steps of progress that [`measure`] makes: the rounds of each effect, and the oracle.
pub(super) fn steps(planned: &PlannedScene) -> u64 {
    (planned.lit_rounds * LitEffect::ALL.len()) as u64 + 1
}

/// Draws a scene in every light with both, on the pool's threads.
///
/// # Errors
/// When the scene does not load or no tree of it can be built. What goes wrong with the peer is in
/// the result.
pub(super) fn measure(
    planned: &PlannedScene,
    peer: Option<&Povray>,
    pool: &ThreadPool,
    progress: &ProgressBar,
) -> anyhow::Result<Vec<LitPair>> {
    let (scene, view) = ours::load(planned)?;
    progress.stage(format!("{}: the lamp's oracle", planned.spec));
    let lamps = LitEffect::Shadows.effects(view.camera())?.lamps;
    let truth = pool.install(|| LampTruth::new(&scene, &view, &lamps[0]));
    progress.advance(1);
    let pair = |effect| {
        let picture = peer.context("not installed");
        let picture = picture.and_then(|_| LitPicture::new(&scene, &view, effect, THREADS));
        let rounds = Rounds::draw(planned, effect, picture, pool, progress)?;
        Ok(rounds.pair(effect, &truth))
    };
    LitEffect::ALL.into_iter().map(pair).collect()
}

/// Milliseconds and costs of all rounds, and the last pictures.
struct Rounds {
    ours: (Vec<f64>, Rows),
    peer: Result<(Vec<LitCost>, Vec<Vec3>), String>,
}

impl Rounds {
    /// Both in turns.
    fn draw(
        planned: &PlannedScene,
        effect: LitEffect,
        picture: anyhow::Result<LitPicture>,
        pool: &ThreadPool,
        progress: &ProgressBar,
    ) -> anyhow::Result<Self> {
        let PlannedScene { spec, lit_rounds, .. } = planned;
        let mut ours = (Vec::new(), Rows { light: Vec::new(), rays: Rays::default() });
        let mut peer = picture.map(|picture| (picture, Vec::new()));
        for round in 1..=*lit_rounds {
            progress.stage(format!("{spec}: {}, round {round} of {lit_rounds}", effect.name()));
            let start = Instant::now();
            ours.1 = pool.install(|| ours::draw(planned, effect))?;
            ours.0.push(milliseconds(start.elapsed()));
            peer = peer.and_then(|(picture, mut costs)| {
                costs.push(picture.draw()?);
                Ok((picture, costs))
            });
            progress.advance(1);
        }
        let peer = peer.and_then(|(picture, costs)| Ok((costs, picture.light()?)));
        Ok(Self { ours, peer: peer.map_err(|error| format!("{error:#}")) })
    }

    fn pair(self, effect: LitEffect, truth: &LampTruth) -> LitPair {
        let is_same = effect != LitEffect::Occlusion;
        let other = self.peer.as_ref().ok().filter(|_| is_same);
        let differing = other.map(|(_, light)| differing(&self.ours.1.light, light));
        let wrong = |light: &[Vec3]| (effect == LitEffect::Shadows).then(|| truth.wrong(light));
        let (ms, rows) = self.ours;
        let ours = LitRun {
            process_ms: Samples::new(ms),
            work_ms: None,
            occlusion_rays: if effect == LitEffect::Occlusion { rows.rays.shadows } else { 0 },
            wrong: wrong(&rows.light),
        };
        let peer = self.peer.map(|(costs, light)| {
            let samples =
                |part: fn(&LitCost) -> f64| Samples::new(costs.iter().map(part).collect());
            LitRun {
                process_ms: samples(|cost| cost.process),
                work_ms: Some(samples(|cost| cost.work)),
                occlusion_rays: costs.last().map_or(0, |cost| cost.occlusion_rays),
                wrong: wrong(&light),
            }
        });
        LitPair {
            effect: effect.name().to_owned(),
            peer_effect: effect.peer().to_owned(),
            ours,
            peer,
            differing,
        }
    }
}

/// The share of pixels whose light, cut off at 1, is not the [`SAME`].
fn differing(one: &[Vec3], other: &[Vec3]) -> f64 {
    let shown = |light: &Vec3| light.clamp(Vec3::ZERO, Vec3::ONE);
    let is_other =
        |(one, other): &(&Vec3, &Vec3)| (shown(one) - shown(other)).abs().max_element() > SAME;
    one.iter().zip(other).filter(is_other).count() as f64 / one.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use metaball_light::Effects;

    use super::*;

    /// A picture in shadow is right, and one without shadows is another and wrong: as the peer's would
    /// be.
    #[test]
    fn a_picture_without_shadows_is_told_apart() {
        let planned = PlannedScene {
            spec: "scattered:300".to_owned(),
            size: (96, 72),
            rounds: 1,
            lit_rounds: 1,
            cells: [8; 3],
        };
        let (scene, view) = ours::load(&planned).expect("a scene");
        let effects = LitEffect::Shadows.effects(view.camera()).expect("effects");
        let truth = LampTruth::new(&scene, &view, &effects.lamps[0]);
        let light = |shadows| {
            let effects = Effects { shadows, ..effects.clone() };
            ours::rows(&scene, &view, &effects).expect("a picture").light
        };
        let (shadowed, unshadowed) = (light(true), light(false));
        assert_eq!(differing(&shadowed, &shadowed), 0.0);
        let right = truth.wrong(&shadowed);
        assert_eq!((right.pixels, right.lit, right.dark), (24 * 18, 0, 0));
        assert!(right.unclear < 40, "{right:?}");
        assert!(differing(&shadowed, &unshadowed) > 0.01);
        let wrong = truth.wrong(&unshadowed);
        assert!(wrong.lit > 5 && wrong.dark == 0, "{wrong:?}");
        let black = truth.wrong(&vec![Vec3::ZERO; shadowed.len()]);
        assert!(black.dark > 20 && black.lit == 0, "{black:?}");
    }
}
