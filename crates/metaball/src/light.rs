//! Ray traced light in a picture: what may be asked for, and pictures lit by it.

mod lighting;
mod options;

pub(crate) use lighting::{DEPTH_CUE_WIDTH, Lighting};
pub use options::{FloorKind, LightOptions};
