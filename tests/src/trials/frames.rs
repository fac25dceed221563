//! What holds of every frame: it can be repeated, solid things hide what is behind them, and rays
//! go through their pixels.

use std::sync::Arc;

use harness::judge::Judge;
use harness::methods::methods;
use libtest_mimic::{Failed, Trial};
use metaball_core::Verdict;
use metaball_core::gpu::Gpu;
use metaball_core::reference::Oracle;

use super::agreement::pass;
use super::{draw, load, on_gpu, renderer, terms_of, view_of};

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = vec![on_gpu("frames::pixels_to_rays".to_owned(), pixels_to_rays)];
    for method in methods() {
        let name = format!("frames::twice_the_same::{}", method.name);
        trials.push(on_gpu(name, move |gpu| twice_the_same(gpu, method.name)));
        let name = format!("frames::behind_a_wall::{}", method.name);
        trials.push(on_gpu(name, move |gpu| behind_a_wall(gpu, method.name)));
    }
    trials
}

fn twice_the_same(gpu: &Gpu, method: &str) -> Result<(), Failed> {
    let scene = load("random-200")?;
    let view = view_of(&scene)?;
    let mut renderer = renderer(method)?;
    let first = draw(gpu, &mut renderer, &scene.scene, &view)?;
    let second = draw(gpu, &mut renderer, &scene.scene, &view)?;
    let differing = first.hits.iter().zip(&second.hits).filter(|(a, b)| a != b).count();
    if differing > 0 {
        return Err(format!("{differing} of {} pixels differ", first.hits.len()).into());
    }
    Ok(())
}

/// An opaque wall through the middle of the scene over the left half of the picture.
fn behind_a_wall(gpu: &Gpu, method: &str) -> Result<(), Failed> {
    let scene = load("random-200")?;
    let open = view_of(&scene)?;
    let distance = scene.camera.eye().distance(scene.scene.bounds().center());
    let is_left = |pixel: usize| pixel % (open.width() as usize) < open.width() as usize / 2;
    let wall: Arc<[f32]> = (0..open.pixels())
        .map(|pixel| if is_left(pixel) { distance } else { f32::INFINITY })
        .collect();
    let walled = open.clone().with_opaque_distance(wall)?;

    let mut renderer = renderer(method)?;
    let without = draw(gpu, &mut renderer, &scene.scene, &open)?;
    let with = draw(gpu, &mut renderer, &scene.scene, &walled)?;
    let hidden = without
        .hits
        .iter()
        .zip(&with.hits)
        .filter(|(open, walled)| open.is_hit() && walled.verdict == Verdict::Miss)
        .count();
    if hidden == 0 {
        return Err("the wall hid nothing: the test tests nothing".into());
    }
    let oracle = Oracle::new(&scene.scene);
    let judge = Judge::new(&scene.scene, &oracle, &with.rays);
    pass(&judge.judge(&with.hits, &terms_of(method)?))
}

/// The camera's stored axes err by half a unit in the last place each, so do the two products, the
/// two sums, the square root and the division: below 8 · 2⁻²³ of a unit vector in all.
fn pixels_to_rays(gpu: &Gpu) -> Result<(), Failed> {
    const ALLOWED: f64 = 8.0 * f32::EPSILON as f64;
    let scene = load("random-200")?;
    let view = view_of(&scene)?;
    let mut renderer = renderer(methods()[0].name)?;
    let picture = draw(gpu, &mut renderer, &scene.scene, &view)?;
    for (pixel, ray) in picture.rays.iter().enumerate() {
        let (column, row) = (pixel as u32 % view.width(), pixel as u32 / view.width());
        let exact = view.camera().exact_direction(column, row, view.width(), view.height());
        let error = (ray.direction.as_dvec3() - exact).length();
        if error > ALLOWED {
            return Err(format!("pixel {pixel}: off by {error:.2e}, allowed {ALLOWED:.2e}").into());
        }
    }
    Ok(())
}
