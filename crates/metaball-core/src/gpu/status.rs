//! Whether a frame is complete.

use bytemuck::{Pod, Zeroable};

/// Whether a frame is complete, and the capacities it needed: WGSL's `Status` of
/// `shaders/wgsl/core/status.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
pub struct FrameStatus {
    /// Rays or pixels without a final answer.
    pub unfinished: u32,
    /// Largest capacity that was needed, in elements; 0 where none was too small. Four slots, which
    /// each method assigns to its own pools, lists and limits.
    pub needed: [u32; 4],
}

impl FrameStatus {
    /// Whether every ray has its final answer. An incomplete frame is never shown, compared or timed.
    pub fn is_complete(&self) -> bool {
        self.unfinished == 0
    }
}
