//! The tracers on the CPU and in WGSL are twins: along the same rays they find the same.

use fbvh::{Tracer, Tree};
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;

use super::agreement::pass;
use super::fixtures::{fixture, picture};
use super::{methods_on_adapter, on_gpu, preset, scenes, terms_of, tree_options};

pub(super) fn trials() -> Vec<Trial> {
    let traced = methods_on_adapter().filter(|method| method.technique.tree().is_some());
    traced
        .flat_map(|method| scenes().map(move |scene| (scene, method.name)))
        .map(|(scene, method)| {
            let name = format!("twins::{scene}::{method}");
            on_gpu(name, move |gpu| hit_for_hit(gpu, scene, method))
        })
        .collect()
}

/// The CPU's hits keep the promise of the method, and are the shader's wherever it promises any.
fn hit_for_hit(gpu: &Gpu, scene: &'static str, method: &'static str) -> Result<(), Failed> {
    let fixture = fixture(gpu, scene)?;
    let options = tree_options(method)?;
    let tree = Tree::build(&fixture.scene.scene, &options)?;
    let tracer = Tracer::new(&tree, &fixture.scene.scene);
    let hits = tracer.first_hits(fixture.judge.rays());
    pass(&fixture.judge.judge(&hits, &terms_of(method)?))?;
    let promise = terms_of(method)?.promise;
    let picture = picture(gpu, scene, &preset(method)?)?;
    pass(&fixture.judge.compare((&hits, promise), (&picture, promise)))
}
