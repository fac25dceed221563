//! Where rays are kept between two dispatches: the host's side of `shaders/wgsl/fbvh/suspended.wgsl`.

use bytemuck::{Pod, Zeroable};
use metaball_core::gpu::{Gpu, RenderError};

/// A suspended ray, WGSL's `Suspended`. The host only needs its size.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct Suspended {
    pub(super) pixel: u32,
    pub(super) reference: u32,
    /// `Search` of the modules in `shaders/wgsl/fbvh/leaf`: in each of the same size.
    pub(super) search: [u32; 7],
    pub(super) best_t: f32,
    pub(super) best_leaf: u32,
    pub(super) best_status: u32,
}

/// The head of WGSL's `Pool`: the size of the next dispatch, and the number of suspended rays.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct PoolHead {
    pub(super) groups: u32,
    pub(super) groups_y: u32,
    pub(super) groups_z: u32,
    pub(super) waiting: u32,
}

/// Rays that a pool holds at first: enough for most pictures, 3 MB.
const FIRST_CAPACITY: u32 = 1 << 16;

/// The pool of suspended rays, and the buffer from which the next dispatch takes its size.
pub(super) struct SuspendedPool {
    pool: wgpu::Buffer,
    empty: wgpu::Buffer,
    arguments: wgpu::Buffer,
    capacity: u32,
}

impl SuspendedPool {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        Self::with_capacity(gpu, FIRST_CAPACITY)
    }

    /// A pool for so many rays.
    pub(super) fn with_capacity(gpu: &Gpu, capacity: u32) -> Result<Self, RenderError> {
        let head = PoolHead { groups: 0, groups_y: 1, groups_z: 1, waiting: 0 };
        let bytes =
            size_of::<PoolHead>() as u64 + u64::from(capacity) * size_of::<Suspended>() as u64;
        let none = wgpu::BufferUsages::empty();
        let pool = gpu.storage("fbvh suspended rays", bytes, none)?;
        let empty = gpu.upload("fbvh empty pool", &[head], none)?;
        let arguments = gpu.storage("fbvh dispatch", 12, wgpu::BufferUsages::INDIRECT)?;
        Ok(Self { pool, empty, arguments, capacity })
    }

    /// Number of rays.
    pub(super) fn capacity(&self) -> u32 {
        self.capacity
    }

    /// The pool itself.
    pub(super) fn buffer(&self) -> &wgpu::Buffer {
        &self.pool
    }

    /// Twelve bytes for an indirect dispatch over the suspended rays.
    pub(super) fn arguments(&self) -> &wgpu::Buffer {
        &self.arguments
    }

    pub(super) fn bytes(&self) -> u64 {
        self.pool.size() + self.empty.size() + self.arguments.size()
    }

    /// Empties the pool, at the start of a frame.
    pub(super) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_buffer_to_buffer(&self.empty, 0, &self.pool, 0, self.empty.size());
    }

    /// Sizes the next indirect dispatches by the number of suspended rays.
    pub(super) fn count(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_buffer_to_buffer(&self.pool, 0, &self.arguments, 0, 12);
    }
}
