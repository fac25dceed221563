//! Bind group layouts from short lists.

use super::Gpu;

/// How a buffer is bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Binding {
    /// `var<uniform>`, seen by all stages.
    Uniform,
    /// `var<storage, read>`, seen by all stages.
    Read,
    /// `var<storage, read_write>`, seen by compute and fragment stages.
    Write,
}

/// A layout of buffers, by binding number.
pub(super) fn layout(gpu: &Gpu, label: &str, bindings: &[(u32, Binding)]) -> wgpu::BindGroupLayout {
    use wgpu::{BufferBindingType, ShaderStages};
    let writers = ShaderStages::COMPUTE | ShaderStages::FRAGMENT;
    let readers = writers | ShaderStages::VERTEX;
    let entries: Vec<_> = bindings
        .iter()
        .map(|&(binding, kind)| {
            let (visibility, ty) = match kind {
                Binding::Uniform => (readers, BufferBindingType::Uniform),
                Binding::Read => (readers, BufferBindingType::Storage { read_only: true }),
                Binding::Write => (writers, BufferBindingType::Storage { read_only: false }),
            };
            wgpu::BindGroupLayoutEntry {
                binding,
                visibility,
                ty: wgpu::BindingType::Buffer {
                    ty,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }
        })
        .collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &entries,
    })
}

/// Whole buffers, by binding number.
pub(super) fn group(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    buffers: &[(u32, &wgpu::Buffer)],
) -> wgpu::BindGroup {
    let entries: Vec<_> = buffers
        .iter()
        .map(|&(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}
