//! Errors of devices, frames and methods.

use metaball_shaders::ComposeError;
use thiserror::Error;

use super::FrameStatus;
use crate::{HostError, Scene};

/// Why something was not made on a device, or not drawn.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A shader does not compose.
    #[error(transparent)]
    Shader(#[from] ComposeError),
    /// A buffer or binding would exceed what the adapter allows.
    #[error("{what}: needed {needed_bytes} bytes, this adapter binds at most {limit_bytes}")]
    TooLarge {
        /// What it was to hold.
        what: &'static str,
        /// Its size.
        needed_bytes: u64,
        /// The adapter's limit.
        limit_bytes: u64,
    },
    /// The picture has more pixels across or down than the adapter can dispatch.
    #[error("picture: needed from 1 to {limit} pixels each way, found {width} × {height}")]
    PictureSize {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// The adapter's limit.
        limit: u32,
    },
    /// A view differs in size from the targets of its frame.
    #[error(
        "view: needed the targets' size of {} × {} pixels, found {} × {}",
        needed.0, needed.1, found.0, found.1
    )]
    ViewSize {
        /// Width and height of the targets.
        needed: (u32, u32),
        /// Width and height of the view.
        found: (u32, u32),
    },
    /// An image of hits differs in size from the targets that it is written to.
    #[error("hits: needed one for each of {needed} pixels, found {found}")]
    HitCount {
        /// Pixels of the targets.
        needed: usize,
        /// Hits given.
        found: usize,
    },
    /// More rays than a batch can hold.
    #[error("rays of a batch: needed at most {needed}, found {found}")]
    RayCount {
        /// The batch's capacity.
        needed: usize,
        /// Rays given.
        found: usize,
    },
    /// A frame was begun on targets on which another frame is not finished.
    #[error("targets: needed no other frame on them, found one begun and not finished")]
    TargetsInUse,
    /// A picture of something that the targets were not made to hold.
    #[error("picture of {what}: the targets were made without it")]
    NoTarget {
        /// The missing target.
        what: &'static str,
    },
    /// A method needs an adapter, and there is none.
    #[error("needed a graphics adapter, found none")]
    NoAdapter,
    /// A method was used before its `build`.
    #[error("method {method}: needed a scene built before the first frame")]
    NotBuilt {
        /// Name of the method.
        method: &'static str,
    },
    /// A method cannot draw this scene at all.
    #[error("method {method}: {reason}")]
    Unsupported {
        /// Name of the method.
        method: &'static str,
        /// What it needs, and what the scene has.
        reason: String,
    },
    /// A method's structure could not be built.
    #[error("method {method}: {source}")]
    Structure {
        /// Name of the method.
        method: &'static str,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A frame was incomplete, and larger capacities did not help.
    #[error(
        "method {method}: {} rays or pixels without a final answer, capacities needed {:?}",
        status.unfinished, status.needed
    )]
    Incomplete {
        /// Name of the method.
        method: &'static str,
        /// Status of the last frame.
        status: FrameStatus,
    },
    /// The device ran out of memory.
    #[error("device out of memory: {text}")]
    OutOfMemory {
        /// wgpu's text.
        text: String,
    },
    /// wgpu refused a call: a mistake in a shader, layout or pass.
    #[error("refused by wgpu: {text}")]
    Refused {
        /// wgpu's text.
        text: String,
    },
    /// The device was lost, or its driver failed.
    #[error("device lost: {text}")]
    DeviceLost {
        /// wgpu's text.
        text: String,
    },
}

impl RenderError {
    /// Whether the picture or the scene does not fit the adapter: a smaller one may, and another adapter
    /// may draw this one.
    pub fn is_too_large(&self) -> bool {
        matches!(self, Self::TooLarge { .. } | Self::PictureSize { .. } | Self::OutOfMemory { .. })
    }

    /// Refuses a scene with negative balls, for a method whose bounds need every ball to add to the field.
    ///
    /// # Errors
    /// [`RenderError::Unsupported`], which names the first negative ball.
    pub fn check_positive(method: &'static str, scene: &Scene) -> Result<(), Self> {
        scene
            .negative_ball()
            .map_or(Ok(()), |ball| Err(Self::Unsupported { method, reason: ball.to_string() }))
    }
}

/// What a method on the CPU refuses counts as what one on the adapter does.
impl From<HostError> for RenderError {
    fn from(error: HostError) -> Self {
        match error {
            HostError::Unsupported { method, reason } => Self::Unsupported { method, reason },
            HostError::Structure { method, source } => Self::Structure { method, source },
        }
    }
}
