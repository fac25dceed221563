//! Fragment lists: that the terms for a cubic instead of the field still reject what is wrong, and what
//! becomes of more separators than an array holds.

use harness::judge::Judge;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::reference::Oracle;

use super::agreement::pass;
use super::canaries::{Spoil, rejects_spoilt};
use super::fixtures::fixture;
use super::{SIZE, draw, on_gpu, renderer, terms_of, view_of};

/// The published running sum, and the same cubics rebuilt.
const METHODS: [&str; 2] = ["illes", "illes-rebuilt"];
const SCENE: &str = "random-200";

pub(super) fn trials() -> Vec<Trial> {
    let spoilt: [(&str, Spoil); 3] = [
        ("shifted_by_a_pixel", |hits| hits.rotate_right(1)),
        ("shifted_by_a_row", |hits| hits.rotate_right(SIZE.0 as usize)),
        ("moved_by_a_tenth", |hits| hits.iter_mut().for_each(|hit| hit.t *= 1.1)),
    ];
    let mut trials = Vec::new();
    for method in METHODS {
        for (name, spoil) in spoilt {
            trials.push(on_gpu(format!("fragments::{method}::rejects_{name}"), move |gpu| {
                rejects_spoilt(gpu, SCENE, method, spoil)
            }));
        }
    }
    trials.push(on_gpu("fragments::illes-rebuilt::most_rays_are_promised".to_owned(), |gpu| {
        most_rays_are_promised(gpu, "illes-rebuilt")
    }));
    let marked = [("illes", true), ("illes-rebuilt", true), ("illes-exact", true)];
    for (method, is_marked) in marked.into_iter().chain([("illes-robust", false)]) {
        let name = format!("fragments::overlap_beyond_capacity::{method}");
        trials.push(on_gpu(name, move |gpu| overlap_beyond_capacity(gpu, method, is_marked)));
    }
    trials
}

/// A promise that holds for few rays is none: that of a running sum, away from the eye.
fn most_rays_are_promised(gpu: &Gpu, method: &str) -> Result<(), Failed> {
    let fixture = fixture(gpu, SCENE)?;
    let promise = terms_of(method)?.promise;
    let rays = fixture.judge.rays().iter().zip(fixture.judge.truths());
    let promised =
        rays.filter(|(ray, truth)| promise.holds(&fixture.scene.scene, ray, truth)).count();
    let needed = fixture.judge.rays().len() * 8 / 10;
    if promised < needed {
        return Err(format!("needed {needed} rays, found {promised}").into());
    }
    Ok(())
}

/// 65 balls over one point: the published array of 96 separators holds 32.
fn overlap_beyond_capacity(gpu: &Gpu, method: &str, is_marked: bool) -> Result<(), Failed> {
    let mut cases = bench_scenes::cases().iter();
    let case = cases.find(|known| known.name == "overlapping").ok_or("no such case")?;
    let scene = case.scene(65.0)?;
    let mut renderer = renderer(method)?;
    let drawn = draw(gpu, &mut renderer, &scene.scene, &view_of(&scene)?)?;
    let oracle = Oracle::new(&scene.scene);
    let judge = Judge::new(&scene.scene, &oracle, &drawn.rays);
    pass(&judge.judge(&drawn.hits, &terms_of(method)?))?;
    let marked = drawn.hits.iter().filter(|hit| hit.fallback).count();
    if (marked > 0) != is_marked {
        return Err(format!("{marked} pixels are marked").into());
    }
    Ok(())
}
