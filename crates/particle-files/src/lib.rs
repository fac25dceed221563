//! Files of particles and molecules as metaball scenes.
//!
//! # The way through
//! path → bytes → text → [`Format`] → [`Table`] → [`Particles`] → [`Scene`](metaball_core::Scene).
//!
//! - [`load()`] goes all of it: a particle file, or a scene file that names one, becomes a scene and a
//!   camera that shows it. [`load_bytes()`] does the same to bytes that are no file.
//! - [`read()`] stops at the particles: positions with sizes and colours, before a kernel and a threshold
//!   make a surface of them. [`parse()`] does the same to bytes that are no file.
//! - A [`Formula`] makes the balls of SPH or of another program of particles, where one is asked for.
//! - [`particles_of()`] and [`load_table()`] begin with a table that may come from elsewhere.
//! - [`read_table()`] stops before anything is decided: positions and columns as the file has them.
//! - [`Sequence`] has a scene for each frame.
//!
//! ```
//! use particle_files::{Overrides, ReadOptions, load};
//!
//! let water = load("examples/water.xyz", &ReadOptions::default(), &Overrides::default())?;
//! println!("{}: {} balls, {}", water.name, water.scene.len(), water.scene.kernel());
//! // Prints "water.xyz: 3 balls, power-2".
//! # assert_eq!((water.name.as_str(), water.scene.len()), ("water.xyz", 3));
//! # assert_eq!(water.scene.kernel().to_string(), "power-2");
//! # Ok::<(), particle_files::LoadError>(())
//! ```
//!
//! # Errors
//! A [`LoadError`] names the file, with line and column or key, what was needed, what was found, and
//! where there is one the way out:
//!
//! ```
//! use particle_files::{ReadOptions, parse};
//!
//! let error = parse("pool.csv", b"x,y,z,radius\n0,0,0,four\n", &ReadOptions::default()).unwrap_err();
//! assert_eq!(
//!     error.to_string(),
//!     "pool.csv, line 2, column 4 (radius): needed a finite number, found \"four\""
//! );
//! ```
//!
//! No bytes make reading panic.
//!
#![doc = include_str!("../FORMATS.md")]

mod animated_scene;
mod atom_names;
mod atom_radii;
mod balls;
mod binary;
mod cell;
mod coloring;
mod convert;
mod elements;
mod error;
mod file;
mod formats;
mod formula;
mod framing;
mod inputs;
mod interpret;
mod load;
mod notes;
mod number;
mod numbered_path;
mod options;
mod origin;
mod overrides;
mod particles;
mod periodic;
mod read;
mod roles;
mod rows;
mod scene_file;
mod select;
mod sequence;
mod sizes;
mod smoothing_length;
mod spacing;
mod surface;
mod table;
mod text;
mod units;
mod write;
mod zip;

pub use animated_scene::{AnimatedScene, BoxError};
pub use balls::{Balls, Positions, Radii};
pub use cell::Cell;
pub use coloring::{ColorBy, Legend, Scale};
pub use convert::{ConvertError, convert};
pub use error::{LoadError, Location};
pub use formats::{Format, PackedFrames, pack_balls, pack_frames};
pub use formula::{
    ByFormula, Formula, FormulaOptions, GaussianSurface, Molmap, Preset, QuickSurf, Sph, Splashsurf,
};
pub use framing::{framing, own_camera};
pub use inputs::inputs;
pub use load::{Loaded, load, load_bytes, load_table};
pub use notes::{Note, NoteKind, Notes};
pub use numbered_path::NumberedPath;
pub use options::{ReadOptions, Substance};
pub use overrides::{Overrides, kernel_named};
pub use particles::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, Particles, Sizes};
pub use read::{parse, particles_of, read, read_table};
pub use select::{Rule, Selection};
pub use sequence::Sequence;
pub use table::{Column, Lines, Table, Values, Words};
pub use units::Unit;
pub use write::WriteFormat;
