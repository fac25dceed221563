//! What the search keeps for pictures of one size: the lists of tiles, and the state of each ray.

use bytemuck::{Pod, Zeroable};
use metaball_core::gpu::{Binding, Gpu, RenderError, TileBins, bind_group, bind_group_layout};

/// A ball in a tile's list: WGSL's `Entry` of `shaders/wgsl/kanamori_robust/lists.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Entry {
    /// No point of the support is nearer to the eye, scene units.
    pub(crate) near: f32,
    /// Index of the ball.
    pub(crate) ball: u32,
}

/// A ray's search between two dispatches: WGSL's `State` of
/// `shaders/wgsl/kanamori_robust/search.wgsl`. Distances are along the ray, scene units; all but the
/// base count from the base.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct State {
    /// What is done next; 0 begins.
    pub(crate) stage: u32,
    /// Index of the first entry whose ball does not end before `probe`.
    pub(crate) first: u32,
    /// Distance from the eye that the others count from.
    pub(crate) base: f32,
    /// Nothing before reaches T.
    pub(crate) low: f32,
    /// Start of the interval that is bounded next.
    pub(crate) probe: f32,
    /// End of it.
    pub(crate) high: f32,
}

/// Buffers of one picture size, and the group 2 that binds them.
pub(super) struct SearchBuffers {
    pub(super) bind_group: wgpu::BindGroup,
    size: (u32, u32),
    /// Entries of all tiles together.
    capacity: u32,
    tiles: TileBins,
    states: wgpu::Buffer,
}

impl SearchBuffers {
    /// Buffers for pictures of so many pixels across and down, and lists of so many entries together.
    pub(super) fn new(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        size: (u32, u32),
        capacity: u32,
    ) -> Result<Self, RenderError> {
        let tiles = TileBins::new(gpu, capacity, size_of::<Entry>())?;
        let pixels = u64::from(size.0) * u64::from(size.1);
        let state_bytes = pixels * size_of::<State>() as u64;
        let states = gpu.storage("search states", state_bytes, wgpu::BufferUsages::empty())?;
        let buffers = [(0, tiles.marks()), (1, tiles.entries()), (2, &states)];
        let bind_group = gpu.checked(|| bind_group(gpu, "search", layout, &buffers))?;
        Ok(Self { bind_group, size, capacity, tiles, states })
    }

    /// Whether they are for pictures of this size and hold so many entries.
    pub(super) fn fit(&self, size: (u32, u32), entries: u32) -> bool {
        self.size == size && self.capacity >= entries
    }

    /// Empties the lists and begins all searches.
    pub(super) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        self.tiles.clear(encoder);
        encoder.clear_buffer(&self.states, 0, None);
    }

    /// Bytes on the adapter.
    pub(super) fn bytes(&self) -> u64 {
        self.tiles.bytes() + self.states.size()
    }

    /// Tiles of the picture.
    pub(super) fn tiles(&self) -> u32 {
        TileBins::tiles_of(self.size)
    }
}

/// Layout of group 2: tile marks, tile entries, search states.
pub(super) fn search_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    bind_group_layout(gpu, "search", &[0, 1, 2].map(|binding| (binding, Binding::Write)))
}
