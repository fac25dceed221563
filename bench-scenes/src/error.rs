//! What can be wrong with a spec.

use metaball_core::{CameraError, CutError, SceneError, ViewError};
use thiserror::Error;

/// Why there is no scene.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The words name neither a known scene nor a generator nor a kind of file.
    #[error(
        "{spec:?} is no scene. Needed one of\n  a known name: {known}\n  a generator: {generators}, \
         each as name:count[:density[:seed]]\n  a file of particles, or a scene file (.toml)"
    )]
    Unknown {
        /// The spec.
        spec: String,
        /// Names of known scenes, separated by commas.
        known: String,
        /// Names of generators, separated by commas.
        generators: String,
    },
    /// The words name a scene that does not move, or none.
    #[error(
        "{spec:?} does not move. Needed one of\n  a known name: {known}\n  a generator: {generators}, \
         each as name:count[:density[:seed]]\n  a particle file for each frame, such as \
         frame-%04d.xyz, a file of many frames, or a scene file that names such particles\n  a .frames \
         file"
    )]
    Still {
        /// The spec.
        spec: String,
        /// Names of moving scenes, separated by commas.
        known: String,
        /// Names of generators that move, separated by commas.
        generators: String,
    },
    /// A generator's spec cannot be used.
    #[error("{name}: needed {needed}, found {found}")]
    Parameter {
        /// What was wrong, for instance `count of "tornado:x"`.
        name: String,
        /// What it should be.
        needed: String,
        /// What it is.
        found: String,
    },
    /// A file or an override cannot be used.
    #[error(transparent)]
    File(#[from] particle_files::LoadError),
    /// The parts make no scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The number makes no Gaussian.
    #[error(transparent)]
    Cut(#[from] CutError),
    /// The numbers make no camera.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The numbers make no picture.
    #[error(transparent)]
    View(#[from] ViewError),
}
