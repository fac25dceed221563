//! Pictures, hits and light as files, each written whole or not at all.
//!
//! | what | format | |
//! | --- | --- | --- |
//! | a picture | PNG or JPEG, eight bits a channel, sRGB | [`PictureFile`], [`write_picture`], [`encode_png`] |
//! | a picture that says what it shows | the same with a text | [`write_described`], [`whole_picture`] |
//! | pictures side by side | PNG or JPEG | [`write_sheet`] |
//! | hits: distance and normal | OpenEXR or NumPy | [`HitsFile`], [`write_hits`], [`read_hits`] |
//! | linear light | OpenEXR; Radiance HDR is read too | [`LightFile`], [`write_light`], [`read_light`] |
//!
//! The ending of a path says which; another one than these is refused.
//!
//! All of them reach the disk under another name, and are moved when they are whole, as
//! [`write_atomically`] does: through symbolic links, and into what is no regular file ([`Target`]). A
//! [`PictureFile`] of PNG, a [`HitsFile`] and a [`LightFile`] are written row by row, so that a picture need
//! not fit the memory. [`refuse_overlap`] is asked before: no output is an input.
//!
//! ```
//! use metaball_core::Hit;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("hits.exr");
//! picture_files::write_hits(&path, 2, 1, &[Hit::MISS, Hit::MISS])?;
//! let hits = picture_files::read_hits(&path)?;
//! println!("{} × {} hits", hits.width, hits.height);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod described;
mod draft;
mod ending;
mod error;
mod hits;
mod jpeg;
mod light;
mod overlap;
mod picture;
mod pixel_count;
mod png;
mod scan_lines;
mod sheet;
mod target;

pub use described::{WholePicture, whole_picture, write_described};
pub use draft::{ensure_writable, write_atomically};
pub use error::PictureFileError;
pub use hits::{HitImage, HitsFile, read_hits, write_hits};
pub use light::{LightFile, LightImage, read_light, write_light};
pub use overlap::{RunFile, refuse_overlap};
pub use picture::{PictureFile, write_picture};
pub use png::encode_png;
pub use sheet::{ensure_sheet, write_sheet};
pub use target::Target;
