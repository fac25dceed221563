//! Scenes for comparing metaball ray casters.
//!
//! [`load()`] takes what a user types: a name of [`known()`], a generator's spec
//! (`tornado:5000:40:7`), or the path of a file, which `particle-files` reads. The [`cases()`] are scenes
//! with a parameter that is turned until a method breaks, [`arbitrary()`] ones are of any kind, by seed.
//! [`Moving`] scenes have a scene for each frame.
//! Nothing here knows of any method or GPU.
//!
//! ```
//! use bench_scenes::{Overrides, load};
//!
//! let scene = load("scattered:1000", &Overrides::default())?;
//! assert_eq!(scene.scene.len(), 1000);
//! # Ok::<(), bench_scenes::LoadError>(())
//! ```

mod arbitrary;
mod cameras;
mod cases;
mod density;
mod error;
mod exact;
mod figures;
mod generate;
mod known;
mod load;
mod moving;
mod random;
mod small;

use metaball_core::{Camera, Scene};

pub use arbitrary::arbitrary;
pub use cases::{Case, Drawing, Subject, cases};
pub use density::mean_overlap;
pub use error::LoadError;
pub use generate::{Generator, generators};
pub use known::{KnownScene, known};
pub use load::load;
pub use moving::{FRAME_RATE, Moving, moving};
pub use particle_files::Overrides;
pub use random::Random;

/// A scene with the cameras that show it.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchScene {
    /// A known name, a generator's spec in full, or a file's name without its folder.
    pub name: String,
    /// One sentence on what it shows.
    pub about: String,
    /// The balls.
    pub scene: Scene,
    /// The camera for a single picture.
    pub camera: Camera,
    /// Cameras of a walk around the scene, for measurements over many views. Empty where `camera`
    /// is the only view.
    pub path: Vec<Camera>,
    /// How strictly verdicts on its rays may be compared.
    pub kind: Kind,
}

/// How strictly hit and miss may be compared between methods.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// No ray of `camera`, in pictures up to twice as wide as high, comes near a silhouette: the
    /// verdicts must be identical.
    Clear,
    /// Some rays graze the surface: those near it are the oracle's to call ambiguous.
    General,
}
