//! The command `score`: hits of any program against the reference.

use std::path::PathBuf;

use bench_scenes::{Overrides, load};
use harness::imported::ImportedHits;
use harness::record::Adapter;
use harness::reference::Reference;
use metaball_core::{Camera, Scene, View};

use crate::compare::results;
use crate::console;

/// What to score.
pub struct Options<'a> {
    /// Name, generator or file.
    pub scene: String,
    /// What to change about the scene.
    pub overrides: Overrides,
    /// The camera that the hits were found with, of the scene and its own camera.
    pub camera: &'a dyn Fn(&Scene, &Camera) -> anyhow::Result<Camera>,
    /// Whether to compare every pixel of a large scene too.
    pub every_pixel: bool,
    /// What the program is called.
    pub name: String,
    /// Its hits.
    pub file: PathBuf,
}

/// Prints the row that `compare` would. Needs no adapter.
///
/// # Errors
/// When the scene or the hits cannot be read.
pub fn score(options: &Options<'_>) -> anyhow::Result<()> {
    let imported = ImportedHits::read(&options.name, &options.file)?;
    let bench = load(&options.scene, &options.overrides)?;
    let size = (imported.image.width, imported.image.height);
    let camera = (options.camera)(&bench.scene, &bench.camera)?;
    let rays = View::new(camera, size.0, size.1)?.rays();
    let images = [&imported.image.hits[..]];
    let reference = Reference::of_pictures(&bench.scene, &rays, size, &images, options.every_pixel);
    // Nothing is drawn here.
    let adapter = Adapter { name: "none".into(), backend: "none".into(), driver: "none".into() };
    let record = imported.record((&bench.name, &bench.scene), &reference, adapter)?;
    console::line(&results(&[record]));
    if !reference.is_complete() {
        console::note(&format!("compared on {}", reference.subset()));
    }
    Ok(())
}
