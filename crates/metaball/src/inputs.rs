//! The files that a run reads: none of what it writes may be one of them.

use std::path::PathBuf;

use picture_files::RunFile;

use crate::LightOptions;

/// The files of the scene, and the image of its surroundings if there is one.
pub(crate) fn inputs(scene: &[PathBuf], light: &LightOptions) -> Vec<RunFile> {
    let scene = scene.iter().map(|path| ("scene", path.clone()));
    scene.chain(light.environment.iter().map(|path| ("environment", path.clone()))).collect()
}
