//! Where rays wait between two dispatches: the host's side of `fbvh/suspend.wgsl`.

use bytemuck::{Pod, Zeroable};
use metaball_core::gpu::{Gpu, RenderError};

/// A waiting ray; WGSL's `Suspended`. The host only needs its size.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct Suspended {
    pub(super) pixel: u32,
    pub(super) place: u32,
    pub(super) stage: u32,
    pub(super) next: u32,
    pub(super) low: f32,
    pub(super) low_value: f32,
    pub(super) high: f32,
    pub(super) high_value: f32,
    pub(super) iterations: u32,
    pub(super) best_t: f32,
    pub(super) best_leaf: u32,
    pub(super) best_status: u32,
}

/// The head of WGSL's `Pool`: the size of the next dispatch, and how many rays wait.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct PoolHead {
    pub(super) groups: u32,
    pub(super) groups_y: u32,
    pub(super) groups_z: u32,
    pub(super) waiting: u32,
}

/// Rays that can wait at first: enough for most pictures, 3 MB.
const FIRST_SLOTS: u32 = 1 << 16;

/// The pool of waiting rays, and the buffer from which the next dispatch takes its size.
pub(super) struct WaitingRoom {
    pool: wgpu::Buffer,
    empty: wgpu::Buffer,
    arguments: wgpu::Buffer,
    slots: u32,
}

impl WaitingRoom {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        Self::with_slots(gpu, FIRST_SLOTS)
    }

    /// A room for at least so many rays.
    pub(super) fn with_slots(gpu: &Gpu, slots: u32) -> Result<Self, RenderError> {
        let nobody = PoolHead { groups: 0, groups_y: 1, groups_z: 1, waiting: 0 };
        let bytes = size_of::<PoolHead>() as u64 + u64::from(slots) * size_of::<Suspended>() as u64;
        let none = wgpu::BufferUsages::empty();
        let pool = gpu.storage("fbvh waiting rays", bytes, none)?;
        let empty = gpu.upload("fbvh empty pool", &[nobody], none)?;
        let arguments = gpu.storage("fbvh dispatch", 12, wgpu::BufferUsages::INDIRECT)?;
        Ok(Self { pool, empty, arguments, slots })
    }

    pub(super) fn slots(&self) -> u32 {
        self.slots
    }

    pub(super) fn pool(&self) -> &wgpu::Buffer {
        &self.pool
    }

    /// Twelve bytes for an indirect dispatch over the rays that wait.
    pub(super) fn arguments(&self) -> &wgpu::Buffer {
        &self.arguments
    }

    pub(super) fn bytes(&self) -> u64 {
        self.pool.size() + self.empty.size() + self.arguments.size()
    }

    /// Sends everybody away: at the start of a frame.
    pub(super) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_buffer_to_buffer(&self.empty, 0, &self.pool, 0, self.empty.size());
    }

    /// Makes the next indirect dispatches as large as the room is full.
    pub(super) fn count(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_buffer_to_buffer(&self.pool, 0, &self.arguments, 0, 12);
    }
}
