//! Shaders without wgpu's checks of indices and loops find what those with them do, bit for bit.

use glam::Vec3;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::{AdapterChoice, Gpu, ShaderChecks};
use metaball_core::{Hit, Verdict};

use super::fixtures::{fixture, picture};
use super::{draw, methods_on_adapter, on_gpu, preset, renderer};

/// More coincident points than lists hold, and an eye in the solid: they share shaders.
const SCENES: [&str; 2] = ["fifteen-coincident", "eye-inside-surface"];

pub(super) fn trials() -> Vec<Trial> {
    let of_method = |method: &'static str| {
        on_gpu(format!("unchecked::{method}"), move |gpu| unchecked_as_checked(gpu, method))
    };
    let mut trials: Vec<_> = methods_on_adapter().map(|method| of_method(method.name)).collect();
    trials.push(Trial::test("unchecked::canary", canary));
    trials
}

fn unchecked_as_checked(gpu: &Gpu, method: &str) -> Result<(), Failed> {
    let other = match gpu.report().shader_checks {
        ShaderChecks::On => ShaderChecks::Off,
        ShaderChecks::Off => ShaderChecks::On,
    };
    let other = Gpu::new(&AdapterChoice::Environment)?.with_shader_checks(other);
    let mut renderer = renderer(method)?;
    for scene in SCENES {
        let fixture = fixture(gpu, scene)?;
        let drawn = draw(&other, &mut renderer, &fixture.scene.scene, &fixture.view)?;
        let same = same(&picture(gpu, scene, &preset(method)?)?, &drawn.hits);
        same.map_err(|differing| format!("{scene}: {differing} pixels differ"))?;
    }
    Ok(())
}

/// How many differ, if any do.
fn same(one: &[Hit], other: &[Hit]) -> Result<(), usize> {
    let differing = one.iter().zip(other).filter(|(a, b)| a != b).count();
    if one.len() == other.len() && differing == 0 { Ok(()) } else { Err(differing) }
}

/// One float's difference is one.
fn canary() -> Result<(), Failed> {
    let hit = Hit { verdict: Verdict::Hit, fallback: false, t: 1.0, normal: Vec3::Z };
    let moved = Hit { t: 1.0_f32.next_up(), ..hit };
    match same(&[hit, hit], &[hit, moved]) {
        Err(1) => Ok(()),
        other => Err(format!("a moved hit: {other:?}").into()),
    }
}
