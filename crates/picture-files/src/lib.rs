//! Pictures, hits and light as files, each written whole or not at all.
//!
//! | what | format | |
//! | --- | --- | --- |
//! | a picture | PNG, eight bits a channel, sRGB | [`PngFile`], [`write_png`], [`encode_png`] |
//! | a picture that says what it shows | the same with a text | [`encode_described_png`], [`description_in_png`] |
//! | pictures side by side | PNG | [`write_sheet`] |
//! | hits: distance and normal | OpenEXR or NumPy | [`HitsFile`], [`write_hits`], [`read_hits`] |
//! | linear light | OpenEXR; Radiance HDR is read too | [`LightFile`], [`write_light`], [`read_light`] |
//!
//! All of them reach the disk under another name, and are moved when they are whole, as
//! [`write_atomically`] does. A [`PngFile`], a [`HitsFile`] and a [`LightFile`] are written row by row, so
//! that a picture need not fit the memory.
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

mod described_png;
mod draft;
mod error;
mod hits;
mod light;
mod pixel_count;
mod png;
mod scan_lines;
mod sheet;

pub use described_png::{description_in_png, encode_described_png};
pub use draft::write_atomically;
pub use error::PictureFileError;
pub use hits::{HitImage, HitsFile, read_hits, write_hits};
pub use light::{LightFile, LightImage, read_light, write_light};
pub use png::{PngFile, encode_png, write_png};
pub use sheet::write_sheet;
