//! Scenes of files.

use std::path::Path;

use metaball_core::{Camera, Scene};

use crate::error::{Flaw, LoadError};
use crate::file;
use crate::formats::PackedFrames;
use crate::framing::{FRONT, framing};
use crate::overrides::Overrides;
use crate::particles::{DEFAULT_KERNEL, DEFAULT_THRESHOLD};
use crate::read::read;
use crate::scene_file::SceneFile;

/// What was loaded from a file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Loaded {
    /// The file's name without its folder.
    pub name: String,
    /// The balls, their kernel and threshold.
    pub scene: Scene,
    /// The scene file's camera, or one that frames the particles.
    pub camera: Camera,
}

/// The scene of a particle file, or of a scene file (`.toml`) that names one.
///
/// # Errors
/// Names the file with line and column or key, or the override, what was needed and what was found.
pub fn load(path: impl AsRef<Path>, overrides: &Overrides) -> Result<Loaded, LoadError> {
    let path = path.as_ref();
    let (scene, camera) = match file::ending(path).as_deref() {
        Some(SceneFile::ENDING) => {
            let SceneFile { particles, kernel, threshold, camera } = SceneFile::open(path)?;
            (read(particles)?.into_scene(kernel, threshold)?, camera)
        }
        Some(PackedFrames::ENDING) => {
            let flaw = Flaw::needed("the particles of one scene", "those of many frames");
            return Err(flaw.in_file(&path.display().to_string()));
        }
        _ => (read(path)?.into_scene(DEFAULT_KERNEL, DEFAULT_THRESHOLD)?, None),
    };
    Ok(Loaded {
        name: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        camera: camera.unwrap_or_else(|| framing(&scene.bounds(), FRONT)),
        scene: overrides.apply(scene)?,
    })
}
