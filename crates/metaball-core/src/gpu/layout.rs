//! Bind groups and their layouts, from lists of bindings.

use super::Gpu;

/// How a buffer or a texture is bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Binding {
    /// `var<uniform>`, seen by all stages.
    Uniform,
    /// `var<storage, read>`, seen by all stages.
    Read,
    /// `var<storage, read_write>`, seen by compute and fragment stages.
    Write,
    /// `texture_2d<f32>`, loaded from and not sampled, seen by all stages.
    Texture,
    /// `texture_2d_array<f32>`, as [`Binding::Texture`].
    TextureArray,
    /// `texture_depth_2d`, as [`Binding::Texture`].
    Depth,
    /// `texture_storage_2d<…, write>` of a format, seen by compute stages.
    WriteTexture(wgpu::TextureFormat),
}

/// What is bound.
#[derive(Debug, Clone, Copy)]
pub enum Resource<'a> {
    /// A whole buffer.
    Buffer(&'a wgpu::Buffer),
    /// A view of a texture.
    Texture(&'a wgpu::TextureView),
}

impl<'a> From<&'a wgpu::Buffer> for Resource<'a> {
    fn from(buffer: &'a wgpu::Buffer) -> Self {
        Self::Buffer(buffer)
    }
}

impl<'a> From<&'a wgpu::TextureView> for Resource<'a> {
    fn from(view: &'a wgpu::TextureView) -> Self {
        Self::Texture(view)
    }
}

/// A bind group layout: what is bound, by binding number.
pub fn bind_group_layout(
    gpu: &Gpu,
    label: &str,
    bindings: &[(u32, Binding)],
) -> wgpu::BindGroupLayout {
    use wgpu::{BindingType, BufferBindingType, ShaderStages, TextureViewDimension};
    let writers = ShaderStages::COMPUTE | ShaderStages::FRAGMENT;
    let readers = writers | ShaderStages::VERTEX;
    let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let texture = |sample_type, view_dimension| BindingType::Texture {
        sample_type,
        view_dimension,
        multisampled: false,
    };
    let exact = wgpu::TextureSampleType::Float { filterable: false };
    let entries: Vec<_> = bindings
        .iter()
        .map(|&(binding, kind)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: match kind {
                Binding::Write => writers,
                Binding::WriteTexture(_) => ShaderStages::COMPUTE,
                _ => readers,
            },
            ty: match kind {
                Binding::Uniform => buffer(BufferBindingType::Uniform),
                Binding::Read => buffer(BufferBindingType::Storage { read_only: true }),
                Binding::Write => buffer(BufferBindingType::Storage { read_only: false }),
                Binding::Texture => texture(exact, TextureViewDimension::D2),
                Binding::TextureArray => texture(exact, TextureViewDimension::D2Array),
                Binding::Depth => texture(wgpu::TextureSampleType::Depth, TextureViewDimension::D2),
                Binding::WriteTexture(format) => BindingType::StorageTexture {
                    access: wgpu::StorageTextureAccess::WriteOnly,
                    format,
                    view_dimension: TextureViewDimension::D2,
                },
            },
            count: None,
        })
        .collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &entries,
    })
}

/// A bind group of that layout: resources, by binding number.
pub fn bind_group<'a, R: Copy + Into<Resource<'a>>>(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: &[(u32, R)],
) -> wgpu::BindGroup {
    let entries: Vec<_> = resources
        .iter()
        .map(|&(binding, resource)| wgpu::BindGroupEntry {
            binding,
            resource: match resource.into() {
                Resource::Buffer(buffer) => buffer.as_entire_binding(),
                Resource::Texture(view) => wgpu::BindingResource::TextureView(view),
            },
        })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}
