//! What moves, wherever its frames come from.

use std::ops::Range;

use metaball_core::{Camera, Scene};

use crate::notes::Notes;

/// Any error of an [`AnimatedScene`].
pub type BoxError = Box<dyn std::error::Error + Send + Sync>;

/// A scene for each frame. Frames are independent: any may be asked for, in any order and from any
/// thread, and is the same each time.
pub trait AnimatedScene: Sync {
    /// What moves, for people.
    fn name(&self) -> &str;

    /// All that its frames depend on except the content of files: a frame is kept from an earlier run
    /// only if this was the same then.
    fn description(&self) -> String;

    /// A camera for all frames.
    fn camera(&self) -> &Camera;

    /// The frames that it has; where it never ends, its first seconds.
    fn frames(&self) -> Range<u32>;

    /// What was read of the first frame's file, guessed and left out; nothing where there is no file.
    fn notes(&self) -> Option<&Notes> {
        None
    }

    /// The numbers of frames in a range for which there is something to draw.
    ///
    /// # Errors
    /// When that cannot be found out.
    fn present(&self, range: Range<u32>) -> Result<Vec<u32>, BoxError>;

    /// The scene of a frame.
    ///
    /// # Errors
    /// When there is none; does not stop the other frames.
    fn frame(&self, number: u32) -> Result<Scene, BoxError>;
}
