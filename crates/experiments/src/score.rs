//! The command `score`: hits of any program against the reference.

use bench_scenes::BenchScene;
use harness::imported::ImportedHits;
use harness::record::Adapter;
use harness::reference::Reference;
use metaball_core::View;

use crate::compare::results;
use crate::console;

/// Prints the row that `compare` would, of hits along the rays of the scene's camera. Needs no adapter.
/// With `every_pixel` large scenes are compared whole too.
///
/// # Errors
/// When the hits' size makes no view.
pub fn score(bench: &BenchScene, imported: &ImportedHits, every_pixel: bool) -> anyhow::Result<()> {
    let size = (imported.image.width, imported.image.height);
    let rays = View::new(bench.camera, size.0, size.1)?.rays();
    let images = [&imported.image.hits[..]];
    let reference = Reference::of_pictures(&bench.scene, &rays, size, &images, every_pixel);
    // Nothing is drawn here.
    let record = imported.record((&bench.name, &bench.scene), &reference, Adapter::none())?;
    console::line(&results(&[record]));
    if !reference.is_complete() {
        console::note(&format!("compared on {}", reference.subset()));
    }
    Ok(())
}
