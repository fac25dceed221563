//! What the passes are bound to, and the formats of their targets.

use metaball_core::gpu::{
    Binding, Gpu, RenderError, Specialization, bind_group_layout, frame_layout, scene_layout,
};

/// Lists of active balls: "32-bit floats" of section 4.2.
pub(crate) const LIST_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// t and index of a layer's point.
pub(crate) const POINT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;
/// Distances times a power of two: exact.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Bind group layouts: groups 0 and 1 of all passes, then the four that group 2 can be, then the
/// three of group 3.
pub(crate) struct Layouts {
    pub(crate) frame: wgpu::BindGroupLayout,
    pub(crate) scene: wgpu::BindGroupLayout,
    /// Placed, seen, arranged, blocks.
    pub(crate) arranging: wgpu::BindGroupLayout,
    /// Placed, tiles, registered, tallies.
    pub(crate) registering: wgpu::BindGroupLayout,
    /// Tiles, rays left, draws.
    pub(crate) turning: wgpu::BindGroupLayout,
    /// Constants, placed, arranged, kernel radii, seen, tiles, registered, rays left.
    pub(crate) drawing: wgpu::BindGroupLayout,
    /// The nearest kernel spheres.
    pub(crate) seeing: wgpu::BindGroupLayout,
    /// The lists.
    pub(crate) peeling: wgpu::BindGroupLayout,
    /// The lists, the points, the nearest kernel spheres.
    pub(crate) testing: wgpu::BindGroupLayout,
}

impl Layouts {
    pub(crate) fn new(gpu: &Gpu, spec: &Specialization) -> Result<Self, RenderError> {
        use Binding::{Depth, Read, Texture, TextureArray, Uniform, Write};
        // Bindings are numbered from `first`.
        let layout = |label, first: u32, bindings: &[Binding]| {
            let numbered: Vec<_> = (first..).zip(bindings.iter().copied()).collect();
            bind_group_layout(gpu, label, &numbered)
        };
        gpu.checked(|| Self {
            frame: frame_layout(gpu, spec),
            scene: scene_layout(gpu, spec),
            arranging: layout("kanamori arranging", 1, &[Write, Read, Write, Write]),
            registering: layout("kanamori registering", 0, &[Read, Write, Write, Write]),
            turning: layout("kanamori turning", 0, &[Write, Write, Write]),
            drawing: layout(
                "kanamori drawing",
                0,
                &[Uniform, Read, Read, Read, Write, Read, Read, Write],
            ),
            seeing: layout("kanamori seeing", 0, &[Depth]),
            peeling: layout("kanamori peeling", 0, &[TextureArray]),
            testing: layout("kanamori testing", 0, &[TextureArray, Texture, Depth]),
        })
    }
}
