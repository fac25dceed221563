//! What of the method can be set.

use metaball_core::gpu::{Gpu, RenderError};

/// Settings; the default is the published method with the paper's own numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// K, the balls that a ray's list holds: 1 to 30, as far as the adapter's targets go. The
    /// paper's four targets hold 14 (section 4.2).
    pub list_capacity: u32,
    /// Width at which a range is a root, in parts of an interval between two points of a ray: 1e-6
    /// to 0.5. The paper prints 10e−4 (section 5.4).
    pub threshold: f32,
    /// Ranges that can wait while clipping, 1 to 4; the paper's is 3 (section 5.4). It bears on
    /// time alone.
    pub stack_size: u32,
    /// Whether balls hidden by kernel spheres are left out (section 5.2).
    pub culling: bool,
    /// Whether points with one t are told apart by their balls' indices, so that none is lost where
    /// several coincide (section 7, figure 9a). Not in the paper. Takes the place of one ball in the
    /// list.
    pub distinct_points: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            list_capacity: 14,
            threshold: 1e-3,
            stack_size: 3,
            culling: true,
            distinct_points: false,
        }
    }
}

/// Bytes of a pixel of one target: four f32.
const TARGET_BYTES: u32 = 16;

impl Options {
    /// As robust as lists of a fixed length can be: no point is lost, and eight targets hold 29
    /// balls.
    pub fn robust() -> Self {
        Self { list_capacity: 29, distinct_points: true, ..Self::default() }
    }

    /// Numbers of a list before its balls.
    fn head(&self) -> u32 {
        2 + u32::from(self.distinct_points)
    }

    /// Targets of four f32 that hold a full list and what stands before it: N_buf.
    pub(crate) fn targets(&self) -> u32 {
        (self.list_capacity + self.head()).div_ceil(4)
    }

    /// Refuses what is out of range or beyond the adapter.
    pub(crate) fn check(&self, gpu: &Gpu, method: &'static str) -> Result<(), RenderError> {
        let refused = |reason| Err(RenderError::Unsupported { method, reason });
        let limits = gpu.device.limits();
        let targets = limits
            .max_color_attachments
            .min(limits.max_color_attachment_bytes_per_sample / TARGET_BYTES)
            .min(8);
        let longest = (4 * targets).saturating_sub(self.head());
        if !(1..=longest).contains(&self.list_capacity) {
            let found = self.list_capacity;
            return refused(format!(
                "list capacity: needed 1 to {longest} on this adapter, found {found}"
            ));
        }
        if !(1e-6..=0.5).contains(&self.threshold) {
            let found = self.threshold;
            return refused(format!("clipping threshold: needed 1e-6 to 0.5, found {found}"));
        }
        if !(1..=4).contains(&self.stack_size) {
            let found = self.stack_size;
            return refused(format!("clipping stack size: needed 1 to 4, found {found}"));
        }
        Ok(())
    }
}
