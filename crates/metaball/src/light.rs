//! Ray traced light in a picture: what may be asked for, and pictures lit by it.

mod lighting;
mod options;

#[cfg(feature = "gpu")]
pub(crate) use lighting::DEPTH_CUE_WIDTH;
pub(crate) use lighting::Lighting;
pub use options::{FloorKind, LightOptions};
