//! What can go wrong.

use std::ops::Range;
use std::path::PathBuf;

#[cfg(feature = "gpu")]
use metaball_core::gpu::{GpuError, RenderError};
use metaball_core::{CameraError, ViewError};
use metaball_light::PanoramaError;
use particle_files::{BoxError, LoadError};
use picture_files::PictureFileError;
use thiserror::Error;

use crate::Method;

/// Why there is no picture. Every text names the thing, what was needed and what was found.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// Particles cannot be loaded.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// An option cannot be used.
    #[error("{option}: needed {needed}, found {found}")]
    Option {
        /// Its name, as the field's.
        option: &'static str,
        /// What it should be.
        needed: String,
        /// What it is.
        found: String,
    },
    /// Only a graphics adapter does this.
    #[error("{what} needs a graphics adapter; {instead}")]
    NeedsAdapter {
        /// What was asked for.
        what: String,
        /// What there is without one.
        instead: String,
    },
    /// The options make no camera.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The size makes no view.
    #[error(transparent)]
    View(#[from] ViewError),
    /// There is no adapter to draw with.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Adapter(#[from] GpuError),
    /// The method or the adapter cannot draw the scene.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The picture, or the scene, does not fit the adapter.
    #[cfg(feature = "gpu")]
    #[error("{refusal}; {instead}")]
    TooLarge {
        /// What, what it needs, and what the adapter has.
        refusal: RenderError,
        /// What would.
        instead: &'static str,
    },
    /// The method's tree does not have what was asked for.
    #[error(transparent)]
    Trace(#[from] fbvh::TraceError),
    /// A tree cannot be built for the scene.
    #[error("method {method}")]
    Build {
        /// The method.
        method: String,
        /// The builder's reason.
        source: fbvh::BuildError,
    },
    /// An image of the surroundings cannot be used.
    #[error(transparent)]
    Panorama(#[from] PanoramaError),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] PictureFileError),
    /// The finished rows of this very picture were left by an interrupted run, and would be lost.
    #[error(
        "{}: {rows} of {height} rows of this picture are there; resume goes on with them, and without \
         the file it is drawn anew",
        path.display()
    )]
    Unfinished {
        /// The spool.
        path: PathBuf,
        /// The rows that are there.
        rows: u32,
        /// The rows of the picture.
        height: u32,
    },
    /// To be resumed is another picture than the one that was interrupted.
    #[error(
        "{}: needed the {what} of this picture, {needed}, found {found}; without resume it is drawn \
         anew",
        path.display()
    )]
    OtherPicture {
        /// The spool.
        path: PathBuf,
        /// What is different.
        what: String,
        /// What it is now.
        needed: String,
        /// What it was then.
        found: String,
    },
    /// The file of finished rows is of something else.
    #[error("{}: needed a spool of finished rows, found another file", path.display())]
    NoSpool {
        /// The file.
        path: PathBuf,
    },
    /// Another run draws to the same file.
    #[error("{}: needed a spool for this run alone, found it in use by another", path.display())]
    SpoolInUse {
        /// The spool.
        path: PathBuf,
    },
    /// Whoever watched the picture broke it off.
    #[error("interrupted")]
    Interrupted,
    /// What an animation's scenes say of themselves.
    #[error(transparent)]
    Frames(BoxError),
    /// There is no frame to draw.
    #[error(
        "frames {}..{}: needed some of {scene}'s frames {}..{}",
        range.start, range.end, frames.start, frames.end
    )]
    NoFrames {
        /// What moves.
        scene: String,
        /// The frames asked for.
        range: Range<u32>,
        /// The frames that it has.
        frames: Range<u32>,
    },
    /// A frame of an animation stopped the run.
    #[error("frame {number}")]
    Frame {
        /// Its number.
        number: u32,
        /// Why.
        source: Box<Self>,
    },
}

impl Error {
    /// A method does not follow the rays that the light needs.
    pub(crate) fn unlit(method: &Method) -> Self {
        Self::Option {
            option: "method",
            needed: "fbvh-certified, which follows rays inside the solid".to_owned(),
            found: method.name().to_owned(),
        }
    }
}
