//! Scenes that need more room or work than a frame begins with: the frame says so and is redone,
//! and the picture is right.

use glam::Vec3;
use harness::judge::{Exam, terms_of};
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::reference::Oracle;
use metaball_core::{Camera, Kernel, Metaball, Scene, View};

use super::agreement::pass;
use super::{draw, on_gpu, renderer};

pub(super) fn trials() -> Vec<Trial> {
    harness::methods::METHODS
        .iter()
        .map(|method| {
            let name = format!("capacity::dense_leaf::{}", method.name);
            on_gpu(name, move |gpu| dense_leaf(gpu, method.name))
        })
        .collect()
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
    let picture = draw(gpu, renderer.as_mut(), &scene, &view)?;
    let oracle = Oracle::new(&scene);
    let exam = Exam::new(&scene, &oracle, &picture.rays);
    let findings = exam.judge(&picture.hits, &terms_of(method));
    let judged = findings.measured + findings.excused;
    if judged < 50 {
        return Err(format!("needed 50 hits to judge, found {judged}").into());
    }
    pass(&findings)
}
