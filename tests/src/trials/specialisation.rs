//! Shaders made for a scene find what general ones find, and do not take more memory.

use harness::canvas::Canvas;
use harness::measure::PreparedRenderer;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::{Gpu, Targets};
use metaball_core::{Generality, Hit, Metaball, Scene, View};

use super::{load, methods_on_adapter, on_gpu, renderer};

pub(super) fn trials() -> Vec<Trial> {
    let trial = |method: &'static str| {
        let name = format!("specialisation::finds_the_same::{method}");
        on_gpu(name, move |gpu| finds_the_same(gpu, method))
    };
    methods_on_adapter().map(|method| trial(method.name)).collect()
}

/// Equal balls of strength 1 without colours: all there is to leave out. A strength that is read instead of
/// compiled in moves no bit. A driver may multiply in another order once it knows a number, and
/// depth peeling has a form of its own for the quartic: that moves t by rounding.
fn finds_the_same(gpu: &Gpu, method: &str) -> Result<(), Failed> {
    const ROUNDING: f32 = 1e-5;
    let bench = load("scattered:300")?;
    let view = View::new(bench.camera, 32, 24)?;
    let drawn = |scene: &Scene| -> Result<_, Failed> {
        let has_colors = scene.colors().is_some();
        let targets = Targets::new(gpu, view.width(), view.height(), has_colors, false)?;
        let canvas = Canvas::on_adapter(gpu, &targets);
        let drawn = PreparedRenderer::prepare(canvas, renderer(method)?, scene, &view)?;
        Ok((drawn.hits, drawn.build.device_bytes))
    };
    let (hits, bytes) = drawn(&bench.scene)?;
    if hits.iter().filter(|hit| hit.is_hit()).count() < 50 {
        return Err("fewer than 50 hits: the test tests nothing".into());
    }
    for generality in Generality::ALL {
        let (found, taken) = drawn(&bench.scene.clone().generalized(generality))?;
        let allowed = match generality {
            Generality::Kernel | Generality::Exponent | Generality::Radii => ROUNDING,
            Generality::Strengths | Generality::Colors => 0.0,
        };
        let differing = differing(&hits, &found, allowed);
        if differing > 0 {
            return Err(format!("{generality:?}: {differing} pixels differ").into());
        }
        // A radius is stored beside the centre, used or not.
        if taken < bytes || (taken == bytes && generality != Generality::Radii) {
            return Err(format!("{generality:?}: {taken} bytes, as specialised {bytes}").into());
        }
    }
    // The canary: balls that are a little larger are seen to be.
    let larger = |ball: Metaball| Metaball { radius: 1.001 * ball.radius, ..ball };
    let balls = bench.scene.balls().map(larger);
    let other = Scene::new(balls, bench.scene.kernel(), bench.scene.threshold())?;
    let (found, _) = drawn(&other)?;
    if differing(&hits, &found, ROUNDING) == 0 {
        return Err("larger balls look the same: the test tests nothing".into());
    }
    Ok(())
}

/// Pixels with another verdict, or a distance that differs by more than this part of it.
fn differing(one: &[Hit], other: &[Hit], allowed: f32) -> usize {
    let differs = |(one, other): &(&Hit, &Hit)| {
        one.verdict != other.verdict || (one.t - other.t).abs() > allowed * one.t
    };
    one.iter().zip(other).filter(differs).count()
}
