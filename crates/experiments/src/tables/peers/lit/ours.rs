//! Ours: the certified tree and the path tracer on the CPU.

use std::hint::black_box;

use bench_scenes::Overrides;
use fbvh::{Options, Tracer, Tree};
use metaball_core::{Image, Kernel, Scene, View};
use metaball_light::cpu::{PathTracer, Rows};
use metaball_light::{Effects, develop};

use crate::tables::peers::effect::LitEffect;
use crate::tables::peers::run::PlannedScene;
use picture_files::encode_png;

/// The whole of a picture, from the scene's name to the bytes of a PNG, on the current pool; returns
/// its light.
pub(super) fn draw(planned: &PlannedScene, effect: LitEffect) -> anyhow::Result<Rows> {
    let (scene, view) = load(planned)?;
    let effects = effect.effects(view.camera())?;
    let rows = rows(&scene, &view, &effects)?;
    let image = Image::new(view.width(), view.height(), &develop(&rows.light, 0.0));
    black_box(encode_png(&image)?);
    Ok(rows)
}

/// Linear light of a view.
pub(super) fn rows(scene: &Scene, view: &View, effects: &Effects) -> anyhow::Result<Rows> {
    let tree = Tree::build(scene, &Options::certified())?;
    let tracer = Tracer::new(&tree, scene);
    Ok(PathTracer::new(&tracer, scene, view, effects, 1, 0)?.rows(0..view.height()))
}

/// The planned scene with α = 2 and without its colours, and its view.
pub(super) fn load(planned: &PlannedScene) -> anyhow::Result<(Scene, View)> {
    let bench = bench_scenes::load(&planned.spec, &Overrides::default())?;
    let scene = Scene::new(bench.scene.balls(), Kernel::QUARTIC, bench.scene.threshold())?;
    Ok((scene, View::new(bench.camera, planned.size.0, planned.size.1)?))
}
