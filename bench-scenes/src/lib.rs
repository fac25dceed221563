//! Scenes for comparing metaball ray casters.
//!
//! [`load()`] takes what a user types: a name of [`known()`], a generator's spec
//! (`tornado:5000:40:7`), or the path of a file, which `particle-files` reads. The [`cases()`] are scenes
//! with a parameter that is varied until a method breaks, [`arbitrary()`] and [`carved()`] ones are of any kind,
//! by seed. [`Moving`] scenes have a scene for each frame.
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
mod bench_scene;
mod cameras;
mod cases;
mod density;
mod error;
mod exact;
mod figures;
mod generate;
mod inputs;
mod known;
mod load;
mod moving;
mod random;
mod small;
mod vibration;

pub use arbitrary::{arbitrary, carved};
pub use bench_scene::{BenchScene, FileFacts, Kind};
pub use cases::{Case, Category, Redraw, cases};
pub use density::mean_overlap;
pub use error::LoadError;
pub use generate::{Generator, generators};
pub use inputs::inputs;
pub use known::{KnownScene, known};
pub use load::{load, load_as};
pub use moving::{FRAME_RATE, Moving, moving};
pub use particle_files::{Overrides, ReadOptions};
pub use random::Random;
