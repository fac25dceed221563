//! A list of rays on the device.

use bytemuck::{Pod, Zeroable};

use super::{Gpu, RenderError};

/// What a list begins with: WGSL's `Listed` of `shaders/wgsl/core/ray_list.wgsl`. The first twelve bytes are
/// the arguments of an indirect dispatch along it.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct ListHead {
    pub(super) groups_x: u32,
    pub(super) groups_y: u32,
    pub(super) groups_z: u32,
    pub(super) count: u32,
}

/// A list of rays, each by its pixel, that passes write and others run along: WGSL's `Listed` and `Listing` of
/// `shaders/wgsl/core/ray_list.wgsl`. Four bytes a pixel.
#[derive(Debug)]
pub struct RayList {
    buffer: wgpu::Buffer,
}

impl RayList {
    /// For a picture of so many pixels.
    ///
    /// # Errors
    /// When the adapter cannot bind so much.
    pub fn new(gpu: &Gpu, pixels: u64) -> Result<Self, RenderError> {
        let bytes = size_of::<ListHead>() as u64 + pixels * size_of::<u32>() as u64;
        Ok(Self { buffer: gpu.storage("listed rays", bytes, wgpu::BufferUsages::INDIRECT)? })
    }

    /// The list itself. Its first twelve bytes are the arguments of an indirect dispatch along it, 64 rays a
    /// workgroup.
    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Empties the list.
    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.buffer, 0, Some(size_of::<ListHead>() as u64));
    }

    /// Runs a pass, whose pipeline and groups are set, along the list. It may not write it.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.dispatch_workgroups_indirect(&self.buffer, 0);
    }
}
