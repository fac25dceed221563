//! Scenes that need more capacity or work than a frame begins with: the frame reports it and is redone,
//! and the picture is right. Frames without end are errors.

use bench_scenes::{Overrides, load};
use fbvh::{Tracer, Tree};
use glam::Vec3;
use harness::judge::Judge;
use harness::methods::methods;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::{FrameStatus, Gpu};
use metaball_core::reference::Oracle;
use metaball_core::{Camera, Hit, Kernel, Metaball, Scene, View};

use super::agreement::pass;
use super::{draw, on_adapter, on_gpu, renderer, terms_of, tree_options};

pub(super) fn trials() -> Vec<Trial> {
    let dense_leaves = methods().iter().map(|method| {
        let name = format!("capacity::dense_leaf::{}", method.name);
        on_gpu(name, move |gpu| dense_leaf(gpu, method.name))
    });
    let divergent = ["fbvh", "fbvh-certified"].into_iter().map(|method| {
        let name = format!("capacity::divergent_rays::{method}");
        on_gpu(name, move |gpu| divergent_rays(gpu, method))
    });
    let endless = on_gpu("capacity::frames_without_end_are_errors".to_owned(), endless_is_an_error);
    dense_leaves.chain(divergent).chain([endless]).collect()
}

/// 1,200 balls that no plane can part, each with its own radius: a leaf test of more than a million
/// contributions a ray, where software Vulkan ends an invocation after 65,535 iterations.
fn dense_leaf(gpu: &Gpu, method: &str) -> Result<(), Failed> {
    let balls = (0..1200).map(|index| Metaball {
        center: Vec3::new(1e-4 * (index % 7) as f32, 1e-4 * (index % 11) as f32, 0.0),
        radius: 1.0 + 1e-3 * (index % 13) as f32,
        strength: 1e-3,
    });
    let scene = Scene::new(balls, Kernel::QUARTIC, 0.3)?;
    let camera = Camera::look_at(Vec3::new(0.3, 0.2, 3.0), Vec3::ZERO, Vec3::Y, 40.0)?;
    let view = View::new(camera, 20, 15)?;

    let mut renderer = renderer(method)?;
    let picture = draw(gpu, &mut renderer, &scene, &view)?;
    let oracle = Oracle::new(&scene);
    let judge = Judge::new(&scene, &oracle, &picture.rays);
    let findings = judge.judge(&picture.hits, &terms_of(method)?);
    let judged = findings.measured + findings.excused;
    if judged < 50 {
        return Err(format!("needed 50 hits to judge, found {judged}").into());
    }
    pass(&findings)
}

/// Rays that graze a dense cloud and diverge through its leaves, of 500 overlapping balls: invocations
/// that run side by side wait for each other, and software Vulkan ends their loops after
/// 65,535 iterations of all of them together. The shader finds what its twin on the CPU does.
fn divergent_rays(gpu: &Gpu, method: &str) -> Result<(), Failed> {
    let scene = load("scattered:10000:500", &Overrides::default())?.scene.with_threshold(39.0)?;
    let (eye, target) = (Vec3::new(1.098, 0.769, 2.197), Vec3::new(0.747, 0.689, 1.264));
    let camera = Camera::look_at(eye, target, Vec3::Y, 4.0)?;
    let view = View::new(camera, 16, 12)?;
    let picture = draw(gpu, &mut renderer(method)?, &scene, &view)?;

    let options = tree_options(method)?;
    let tree = Tree::build(&scene, &options)?;
    let twins = Tracer::new(&tree, &scene).first_hits(&picture.rays);
    let is_same = |ours: &Hit, twin: &Hit| {
        ours.verdict == twin.verdict && (!ours.is_hit() || (ours.t - twin.t).abs() <= 1e-4 * twin.t)
    };
    let pairs = picture.hits.iter().zip(&twins);
    let hits = twins.iter().filter(|twin| twin.is_hit()).count();
    match pairs.clone().filter(|(ours, twin)| !is_same(ours, twin)).count() {
        0 if hits > 50 => Ok(()),
        0 => Err(format!("needed more than 50 hits to compare, found {hits}").into()),
        apart => Err(format!("{apart} of {} hits are not their twins'", twins.len()).into()),
    }
}

/// A frame of which some ray never reports that it is finished ends as an error, after a few attempts.
fn endless_is_an_error(gpu: &Gpu) -> Result<(), Failed> {
    let scene = load("two-merging", &Overrides::default())?.scene;
    let mut renderer = on_adapter("fbvh-certified")?;
    renderer.build(gpu, &scene)?;
    let status = FrameStatus { unfinished: 1, needed: [0; 4] };
    for _ in 0..20 {
        if !renderer.grow(gpu, &status)? {
            return Ok(());
        }
    }
    Err("needed an end, found none after 20 attempts".into())
}
