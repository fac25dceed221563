//! Wrong pictures that the comparisons must reject: a comparison nobody has seen fail is no test.

use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::{Hit, Scene};

use super::agreement::pass;
use super::fixtures::{fixture, picture};
use super::{SIZE, draw, on_gpu, preset, renderer, terms_of};

/// The methods whose pictures are spoilt, on the adapter and on the CPU, and a scene with enough in it to
/// spoil.
const METHODS: [&str; 3] = ["fbvh", "fbvh-certified-cpu", "kanamori-cpu"];
const SCENE: &str = "random-200";

/// A way to spoil a picture.
pub(super) type Spoil = fn(&mut Vec<Hit>);

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
    let mut trials = Vec::new();
    for method in METHODS {
        for (name, spoil) in spoilt {
            let name = format!("canary::{name}::{method}");
            trials.push(on_gpu(name, move |gpu| rejects_spoilt(gpu, SCENE, method, spoil)));
        }
        let name = format!("canary::missing_ball::{method}");
        trials.push(on_gpu(name, move |gpu| rejects_a_missing_ball(gpu, method)));
        let name = format!("canary::against_another_method::{method}");
        trials.push(on_gpu(name, move |gpu| rejects_between_methods(gpu, method)));
    }
    // Tens of roundings beside each root: the tolerance of no search excuses it.
    let sloppy: Spoil = |hits| hits.iter_mut().for_each(|hit| hit.t *= 1.0 + 3e-6);
    for method in ["fbvh-certified", "fbvh-certified-cpu", "kanamori-robust", "illes-robust"] {
        let name = format!("canary::sloppy_roots::{method}");
        trials.push(on_gpu(name, move |gpu| rejects_spoilt(gpu, SCENE, method, sloppy)));
    }
    trials
}

/// A known scene's picture by the method passes, and no longer when it is spoilt.
pub(super) fn rejects_spoilt(
    gpu: &Gpu,
    scene: &'static str,
    method: &'static str,
    spoil: Spoil,
) -> Result<(), Failed> {
    let fixture = fixture(gpu, scene)?;
    let mut hits = picture(gpu, scene, &preset(method)?)?.to_vec();
    pass(&fixture.judge.judge(&hits, &terms_of(method)?))?;
    spoil(&mut hits);
    match pass(&fixture.judge.judge(&hits, &terms_of(method)?)) {
        Ok(()) => Err("the spoilt picture passed".into()),
        Err(_) => Ok(()),
    }
}

/// A structure that lost the ball most in view.
fn rejects_a_missing_ball(gpu: &Gpu, method: &str) -> Result<(), Failed> {
    let fixture = fixture(gpu, SCENE)?;
    let scene = fixture.scene;
    let eye = scene.camera.eye();
    let nearest = |ball: &metaball_core::Metaball| ball.center.distance(eye) - ball.radius;
    let mut balls: Vec<_> = scene.scene.balls().collect();
    balls.sort_by(|a, b| nearest(a).total_cmp(&nearest(b)));
    balls.remove(0);
    let without = Scene::new(balls, scene.scene.kernel(), scene.scene.threshold())?;

    let mut renderer = renderer(method)?;
    let picture = draw(gpu, &mut renderer, &without, &fixture.view)?;
    match pass(&fixture.judge.judge(&picture.hits, &terms_of(method)?)) {
        Ok(()) => Err("the picture without a ball passed".into()),
        Err(_) => Ok(()),
    }
}

fn rejects_between_methods(gpu: &Gpu, method: &str) -> Result<(), Failed> {
    let fixture = fixture(gpu, SCENE)?;
    let hits = picture(gpu, SCENE, &preset(method)?)?;
    let promise = terms_of(method)?.promise;
    pass(&fixture.judge.compare((&hits, promise), (&hits, promise)))?;
    let mut shifted = hits.to_vec();
    shifted.rotate_right(1);
    match pass(&fixture.judge.compare((&hits, promise), (&shifted, promise))) {
        Ok(()) => Err("the shifted picture passed".into()),
        Err(_) => Ok(()),
    }
}
