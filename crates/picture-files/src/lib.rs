//! Pictures, hits and light as files, each written whole or not at all.
//!
//! | what | format | |
//! | --- | --- | --- |
//! | a picture | PNG, eight bits a channel, sRGB | [`encode_png`] |
//! | a picture that says what it shows | the same with a text | [`encode_described_png`], [`description_in_png`] |
//! | pictures side by side | PNG | [`write_sheet`] |
//! | hits: distance and normal | OpenEXR or NumPy | [`write_hits`], [`read_hits`] |
//! | linear light | OpenEXR; Radiance HDR is read too | [`write_light`], [`read_light`] |
//!
//! [`write_atomically`] is how all of them reach the disk.
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

mod atomic;
mod described_png;
mod error;
mod hits;
mod light;
mod png;
mod sheet;

pub use atomic::write_atomically;
pub use described_png::{description_in_png, encode_described_png};
pub use error::PictureFileError;
pub use hits::{HitImage, read_hits, write_hits};
pub use light::{LightImage, read_light, write_light};
pub use png::encode_png;
pub use sheet::write_sheet;
