//! What the passes are bound to, and the formats of their targets.

use metaball_core::gpu::{
    Binding, Gpu, Specialization, bind_group_layout, frame_layout, scene_layout,
};

/// Distances to cores are read as they were written.
pub(crate) const CORE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
/// Depth is for the test alone.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The bind group layouts, by group.
pub(crate) struct Layouts {
    /// Group 0.
    pub(crate) frame: wgpu::BindGroupLayout,
    /// Group 1.
    pub(crate) scene: wgpu::BindGroupLayout,
    /// Group 2: ball of each rank, core radius of each ball.
    pub(crate) balls: wgpu::BindGroupLayout,
    /// Group 2 of the radix sort: entries read, entries written, digit table, ball of each rank.
    pub(crate) sort: wgpu::BindGroupLayout,
    /// Group 3: list heads, list nodes, core distance, progress, rays of a dispatch, rays that wait,
    /// sums.
    pub(crate) lists: wgpu::BindGroupLayout,
    /// Group 3 of the passes over tiles: list heads, list nodes, tile marks, tile entries, core distance.
    pub(crate) tiles: wgpu::BindGroupLayout,
}

impl Layouts {
    pub(crate) fn new(gpu: &Gpu, spec: &Specialization) -> Self {
        use Binding::{Read, Texture, Write, WriteTexture};
        let layout = |label, bindings: &[(u32, Binding)]| bind_group_layout(gpu, label, bindings);
        Self {
            frame: frame_layout(gpu, spec),
            scene: scene_layout(gpu, spec),
            balls: layout("illes balls", &[(0, Read), (1, Read)]),
            sort: layout("illes sort", &[(0, Read), (1, Write), (2, Write), (3, Write)]),
            lists: layout(
                "illes lists",
                &[
                    (0, Write),
                    (1, Write),
                    (2, Texture),
                    (3, Write),
                    (7, Read),
                    (8, Write),
                    (9, Write),
                ],
            ),
            tiles: layout(
                "illes tiles",
                &[(0, Write), (1, Write), (4, Write), (5, Write), (6, WriteTexture(CORE_FORMAT))],
            ),
        }
    }
}
