//! What the search keeps for a picture: lists of its tiles, and where each ray's search stands.

use bytemuck::{Pod, Zeroable};
use metaball_core::gpu::{Binding, Gpu, RenderError, bind_group, bind_group_layout};

/// Tiles of a picture at most: `MOST_TILES` of `kanamori_robust/lists.wgsl`.
pub(super) const MOST_TILES: u32 = 16_384;

/// A ball in a tile's list: WGSL's `Entry` of `kanamori_robust/lists.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Entry {
    /// No point of the support is nearer to the eye.
    pub(crate) near: f32,
    /// The ball.
    pub(crate) ball: u32,
}

/// Where a search stands: WGSL's `State` of `kanamori_robust/search.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct State {
    /// What is done next; 0 begins.
    pub(crate) stage: u32,
    /// The first entry that still matters.
    pub(crate) first: u32,
    /// Where on the ray the other distances count from.
    pub(crate) base: f32,
    /// Nothing before reaches T.
    pub(crate) low: f32,
    /// Where the interval looked at begins.
    pub(crate) probe: f32,
    /// Where it ends.
    pub(crate) high: f32,
}

/// Buffers of one picture size, and the group 2 that binds them.
pub(super) struct Room {
    pub(super) bind_group: wgpu::BindGroup,
    size: (u32, u32),
    room_for: u32,
    marks: wgpu::Buffer,
    states: wgpu::Buffer,
}

impl Room {
    /// Room for so many entries of lists.
    pub(super) fn new(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        size: (u32, u32),
        entries: u32,
    ) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        let of = |what, count: u64, each: usize| gpu.storage(what, count * each as u64, none);
        let pixels = u64::from(size.0) * u64::from(size.1);
        let marks = of("kanamori tile marks", MOST_TILES.into(), size_of::<u32>())?;
        let list = of("kanamori tile lists", entries.into(), size_of::<Entry>())?;
        let states = of("kanamori searches", pixels, size_of::<State>())?;
        let buffers = [(0, &marks), (1, &list), (2, &states)];
        let bind_group = gpu.checked(|| bind_group(gpu, "kanamori lists", layout, &buffers))?;
        Ok(Self { bind_group, size, room_for: entries, marks, states })
    }

    /// Whether it is for pictures of this size, with room for so many entries.
    pub(super) fn fits(&self, size: (u32, u32), entries: u32) -> bool {
        self.size == size && self.room_for >= entries
    }

    /// Empties the lists and begins all searches.
    pub(super) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.marks, 0, None);
        encoder.clear_buffer(&self.states, 0, None);
    }

    /// Tiles of the picture, as `kanamori_robust/lists.wgsl` counts them.
    pub(super) fn tiles(&self) -> u32 {
        let tiles = |side: u32| self.size.0.div_ceil(side) * self.size.1.div_ceil(side);
        let mut side = 16;
        while tiles(side) > MOST_TILES {
            side *= 2;
        }
        tiles(side)
    }
}

/// Layout of group 2: marks, lists, searches.
pub(super) fn room_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    bind_group_layout(gpu, "kanamori lists", &[0, 1, 2].map(|binding| (binding, Binding::Write)))
}
