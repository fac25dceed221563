//! The trials: scenes multiplied by methods.

mod agreement;
mod canaries;
mod capacity;
mod certify;
mod depth;
mod fixtures;
mod fragments;
mod frames;
mod light;
mod peeling;
mod specialisation;
mod stability;
mod twins;
mod unchecked;

use bench_scenes::{BenchScene, Overrides};
use harness::canvas::Canvas;
use harness::configuration::Configuration;
use harness::judge::Terms;
use harness::methods::{Method, methods};
use harness::renderer::Renderer;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::{Gpu, IsoRenderer, Targets};
use metaball_core::{Hit, Ray, Scene, View};

use crate::machine;

/// Columns and rows of test pictures: software adapters are slow.
const SIZE: (u32, u32) = (64, 48);

/// All trials. Without an adapter they show as ignored.
pub fn all() -> Vec<Trial> {
    let mut trials = agreement::trials();
    trials.extend(canaries::trials());
    trials.extend(capacity::trials());
    trials.extend(certify::trials());
    trials.extend(depth::trials());
    trials.extend(fragments::trials());
    trials.extend(frames::trials());
    trials.extend(light::trials());
    trials.extend(peeling::trials());
    trials.extend(specialisation::trials());
    trials.extend(stability::trials());
    trials.extend(twins::trials());
    trials.extend(unchecked::trials());
    trials
}

/// A trial that needs the adapter.
fn on_gpu(
    name: String,
    test: impl FnOnce(&'static Gpu) -> Result<(), Failed> + Send + 'static,
) -> Trial {
    let gpu = machine::gpu();
    Trial::test(name, move || match gpu {
        Some(gpu) => test(gpu),
        None => Err("no adapter".into()),
    })
    .with_ignored_flag(gpu.is_none())
}

/// A method as it is listed.
fn preset(method: &str) -> Result<Configuration, Failed> {
    let found = harness::methods::find(method);
    Ok(found.ok_or_else(|| format!("no method is called {method}"))?.into())
}

/// What a method as it is listed is held to.
fn terms_of(method: &str) -> Result<Terms, Failed> {
    Ok(preset(method)?.technique.terms())
}

/// The tree that a method as it is listed traces.
fn tree_options(method: &str) -> Result<fbvh::Options, Failed> {
    Ok(preset(method)?.technique.tree().ok_or("the method has no tree")?)
}

/// A renderer of a method that does not count its work.
fn renderer(method: &str) -> Result<Renderer, Failed> {
    Ok(preset(method)?.renderer(false))
}

/// The same of a method that is on the adapter.
fn on_adapter(method: &str) -> Result<Box<dyn IsoRenderer>, Failed> {
    Ok(renderer(method)?.on_adapter().ok_or_else(|| format!("{method} is on the CPU"))?)
}

/// The methods that are on the adapter.
fn methods_on_adapter() -> impl Iterator<Item = &'static Method> {
    methods().iter().filter(|method| method.needs_adapter())
}

/// The scenes on which every method is tried: all small ones, and the molecule.
fn scenes() -> impl Iterator<Item = &'static str> {
    let known = bench_scenes::known().iter();
    known.filter(|scene| scene.small || scene.name == "molecule").map(|scene| scene.name)
}

fn load(name: &str) -> Result<BenchScene, Failed> {
    Ok(bench_scenes::load(name, &Overrides::default())?)
}

/// A scene's own view, small.
fn view_of(scene: &BenchScene) -> Result<View, Failed> {
    Ok(View::new(scene.camera, SIZE.0, SIZE.1)?)
}

/// A picture as numbers: what was drawn, along which rays.
struct Picture {
    rays: Vec<Ray>,
    hits: Vec<Hit>,
}

/// Builds a scene and draws one frame of it.
fn draw(gpu: &Gpu, renderer: &mut Renderer, scene: &Scene, view: &View) -> Result<Picture, Failed> {
    let has_colors = scene.colors().is_some();
    let targets = Targets::new(gpu, view.width(), view.height(), has_colors, false)?;
    let hits = Canvas::on_adapter(gpu, &targets).picture(renderer, scene, view)?;
    Ok(Picture { rays: targets.read_rays(gpu, view)?, hits })
}
