//! Wrong pictures that the comparisons must reject: a comparison nobody has seen fail is no test.

use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::reference::Oracle;
use metaball_core::{Hit, Scene};

use super::agreement::{pass, terms_of};
use super::{SIZE, draw, load, on_gpu, renderer, view_of};
use crate::judge::Exam;
use crate::promise::promise_of;

/// The method whose picture is spoilt, and a scene with enough in it to spoil.
const METHOD: &str = "fbvh";
const SCENE: &str = "random-200";

/// A way to spoil a picture.
type Spoil = fn(&mut Vec<Hit>);

pub(super) fn trials() -> Vec<Trial> {
    let spoilt: [(&str, Spoil); 5] = [
        ("shifted_by_a_pixel", |hits| hits.rotate_right(1)),
        ("shifted_by_a_row", |hits| hits.rotate_right(SIZE.0 as usize)),
        ("flipped_normal", |hits| {
            if let Some(hit) = hits.iter_mut().find(|hit| hit.is_hit()) {
                hit.normal = -hit.normal;
            }
        }),
        ("one_pixel_missing", |hits| {
            if let Some(hit) = hits.iter_mut().find(|hit| hit.is_hit()) {
                *hit = Hit::MISS;
            }
        }),
        ("truncated", |hits| {
            hits.pop();
        }),
    ];
    let mut trials: Vec<_> = spoilt
        .into_iter()
        .map(|(name, spoil)| {
            on_gpu(format!("canary::{name}"), move |gpu| rejects_spoilt(gpu, spoil))
        })
        .collect();
    trials.push(on_gpu("canary::missing_ball".to_owned(), rejects_a_missing_ball));
    trials.push(on_gpu("canary::against_another_method".to_owned(), rejects_between_methods));
    trials
}

fn rejects_spoilt(gpu: &Gpu, spoil: Spoil) -> Result<(), Failed> {
    let scene = load(SCENE)?;
    let mut renderer = renderer(METHOD)?;
    let mut picture = draw(gpu, renderer.as_mut(), &scene.scene, &view_of(&scene)?)?;
    let oracle = Oracle::new(&scene.scene);
    let exam = Exam::new(&scene.scene, &oracle, &picture.rays);
    pass(&exam.judge(&picture.hits, &terms_of(METHOD)))?;
    spoil(&mut picture.hits);
    match pass(&exam.judge(&picture.hits, &terms_of(METHOD))) {
        Ok(()) => Err("the spoilt picture passed".into()),
        Err(_) => Ok(()),
    }
}

/// A structure that lost the ball most in view.
fn rejects_a_missing_ball(gpu: &Gpu) -> Result<(), Failed> {
    let scene = load(SCENE)?;
    let eye = scene.camera.eye();
    let nearest = |ball: &metaball_core::Metaball| ball.center.distance(eye) - ball.radius;
    let mut balls: Vec<_> = scene.scene.balls().collect();
    balls.sort_by(|a, b| nearest(a).total_cmp(&nearest(b)));
    balls.remove(0);
    let without = Scene::new(balls, scene.scene.kernel(), scene.scene.threshold())?;

    let mut renderer = renderer(METHOD)?;
    let picture = draw(gpu, renderer.as_mut(), &without, &view_of(&scene)?)?;
    let oracle = Oracle::new(&scene.scene);
    let exam = Exam::new(&scene.scene, &oracle, &picture.rays);
    match pass(&exam.judge(&picture.hits, &terms_of(METHOD))) {
        Ok(()) => Err("the picture without a ball passed".into()),
        Err(_) => Ok(()),
    }
}

fn rejects_between_methods(gpu: &Gpu) -> Result<(), Failed> {
    let scene = load(SCENE)?;
    let mut renderer = renderer(METHOD)?;
    let picture = draw(gpu, renderer.as_mut(), &scene.scene, &view_of(&scene)?)?;
    let oracle = Oracle::new(&scene.scene);
    let exam = Exam::new(&scene.scene, &oracle, &picture.rays);
    let promise = promise_of(METHOD);
    pass(&exam.compare((&picture.hits, promise), (&picture.hits, promise)))?;
    let mut shifted = picture.hits.clone();
    shifted.rotate_right(1);
    match pass(&exam.compare((&picture.hits, promise), (&shifted, promise))) {
        Ok(()) => Err("the shifted picture passed".into()),
        Err(_) => Ok(()),
    }
}
