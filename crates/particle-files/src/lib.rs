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
//! # Formats
//! The ending of a file's name says its format; each may be followed by `.gz`.
//!
//! | ending | what is read |
//! | --- | --- |
//! | `.csv` | A header line, then columns in any order: `x,y,z,radius`, optionally `strength`, optionally `red,green,blue` (all three, sRGB-encoded, from 0 to 1). `radius` is the support radius R. |
//! | `.xyz` | XYZ and extended XYZ, first frame. A `radius` among the `Properties` is R. Without it, species that are elements make a molecule; other particles, and "elements" nearer together than atoms can be, get R = twice the median distance between nearest neighbours. |
//! | `.pdb`, `.ent` | Protein Data Bank format up to 99,999 atoms: first model, first of alternative locations. Blank element columns are filled in from the atom's name. |
//! | `.cif`, `.mmcif` | The same from mmCIF, of any size. |
//! | `.balls` | Equal balls with positions of 16 bits ([`pack_balls`] writes them). |
//! | `.frames` | A sequence of equal balls with positions of 16 bits ([`pack_frames`] writes it). |
//! | `.toml` | A scene file, below. |
//!
//! In a molecule R is [√2 times](SUPPORT_OVER_VAN_DER_WAALS) the van der Waals radius (Alvarez 2013): with the
//! default kernel and threshold an atom alone then shows at its van der Waals radius. Atoms have the
//! colours of their elements.
//!
//! A scene file names a particle file and says how its balls make a surface. Only `particles` is
//! required; unknown keys are errors.
//!
//! ```toml
//! particles = "pool.csv"      # path relative to this file; "pool-%04d.csv" for a sequence
//! kernel = "power"            # "power" (with exponent), "wyvill" or "perlin"; default "power"
//! exponent = 2                # 1 to 8, for "power" only; default 2
//! threshold = 0.25            # above 0; default 0.25
//! [camera]                    # default: one that frames the particles
//! eye = [2.2, 1.7, 3.4]
//! look_at = [0.0, 0.0, 0.0]
//! up = [0.0, 1.0, 0.0]        # default: this
//! vertical_fov_degrees = 38.0 # default: this
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
//! No bytes make it panic.

mod elements;
mod error;
mod file;
mod formats;
mod framing;
mod guard;
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

pub use error::{LoadError, Location};
pub use formats::{Format, PackedFrames, pack_balls, pack_frames};
pub use framing::framing;
pub use load::{Loaded, load};
pub use molecule::SUPPORT_OVER_VAN_DER_WAALS;
pub use numbered_path::NumberedPath;
pub use overrides::{Overrides, kernel_named};
pub use particles::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, Particles};
pub use read::{parse, read};
pub use sequence::Sequence;
