//! Files of particles and molecules as metaball scenes.
//!
//! # The way through
//! path → bytes → [`Format`] → [`Particles`] → [`Scene`](metaball_core::Scene).
//!
//! - [`load()`] goes all of it: a particle file, or a scene file that names one, becomes a scene and a
//!   camera that shows it.
//! - [`read()`] stops at the particles: balls with radii and colours, before a kernel and a threshold
//!   make a surface of them. [`parse()`] does the same to bytes that are no file, and [`Format::parse`] to
//!   bytes without a name.
//! - [`Sequence`] has a scene for each frame.
//!
//! ```
//! use particle_files::{Overrides, load};
//!
//! let water = load("examples/water.xyz", &Overrides::default())?;
//! println!("{}: {} balls, {}", water.name, water.scene.len(), water.scene.kernel());
//! // Prints "water.xyz: 3 balls, power-2".
//! # assert_eq!((water.name.as_str(), water.scene.len()), ("water.xyz", 3));
//! # assert_eq!(water.scene.kernel().to_string(), "power-2");
//! # Ok::<(), particle_files::LoadError>(())
//! ```
//!
//! # Errors
//! A [`LoadError`] names the file, with line and column or key, what was needed and what was found:
//!
//! ```
//! let error = particle_files::parse("pool.csv", b"x,y,z,radius\n0,0,0,four\n").unwrap_err();
//! assert_eq!(
//!     error.to_string(),
//!     "pool.csv, line 2, column 4 (radius): needed a finite number, found \"four\""
//! );
//! ```
//!
//! No bytes make reading panic: a panic of the crate `pdbtbx`, which reads structures, is caught and becomes
//! an error. So that it prints nothing, the first structure installs a panic hook, which hands on the panics
//! of everything else.
//!
#![doc = include_str!("../FORMATS.md")]

mod animated_scene;
mod elements;
mod error;
mod file;
mod formats;
mod framing;
mod guard;
mod inputs;
mod load;
mod molecule;
mod numbered_path;
mod overrides;
mod particles;
mod read;
mod scene_file;
mod sequence;
mod spacing;
mod text;

pub use animated_scene::{AnimatedScene, BoxError};
pub use error::{LoadError, Location};
pub use formats::{Format, PackedFrames, pack_balls, pack_frames};
pub use framing::framing;
pub use inputs::inputs;
pub use load::{Loaded, load};
pub use molecule::SUPPORT_OVER_VAN_DER_WAALS;
pub use numbered_path::NumberedPath;
pub use overrides::{Overrides, kernel_named};
pub use particles::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, Particles};
pub use read::{parse, read};
pub use sequence::Sequence;
