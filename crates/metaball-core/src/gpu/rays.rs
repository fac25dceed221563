//! The pass that makes the primary rays of a frame.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::layout::{Binding, bind_group, bind_group_layout};
use super::pipeline::{Specialization, compute_pipeline};
use super::{Gpu, RenderError};
use crate::NO_LIMIT;

/// A primary ray as shaders see it, 16 bytes: WGSL's `PrimaryRay` of `shaders/wgsl/core/view.wgsl`. It starts at
/// the view's eye.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct PackedRay {
    /// Direction, unit to rounding.
    pub direction: Vec3,
    /// Where something opaque ends the ray, scene units, or [`NO_LIMIT`].
    pub t_max: f32,
}

/// `shaders/wgsl/core/rays.wgsl` bound to the buffers of one image size.
#[derive(Debug)]
pub(super) struct RayPass {
    pipeline: wgpu::ComputePipeline,
    frame: wgpu::BindGroup,
    opaque_scene: Option<OpaqueScene>,
}

/// Distances at which rays end.
#[derive(Debug)]
struct OpaqueScene {
    distances: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl RayPass {
    /// For views without an opaque scene: rays have no end.
    pub(super) fn free(
        gpu: &Gpu,
        view: &wgpu::Buffer,
        rays: &wgpu::Buffer,
        hits: &wgpu::Buffer,
    ) -> Result<Self, RenderError> {
        let frame = ray_layout(gpu);
        Ok(Self {
            pipeline: pipeline(gpu, &["opaque/none"], &[&frame])?,
            frame: bind(gpu, &frame, view, rays, hits)?,
            opaque_scene: None,
        })
    }

    /// For views with an opaque scene.
    pub(super) fn stopped(
        gpu: &Gpu,
        view: &wgpu::Buffer,
        rays: &wgpu::Buffer,
        hits: &wgpu::Buffer,
    ) -> Result<Self, RenderError> {
        let frame = ray_layout(gpu);
        let opaque = bind_group_layout(gpu, "opaque scene", &[(0, Binding::Read)]);
        let pixels = rays.size() / size_of::<PackedRay>() as u64;
        let bytes = pixels * size_of::<f32>() as u64;
        let distances = gpu.storage("opaque distances", bytes, wgpu::BufferUsages::empty())?;
        let bind_group =
            gpu.checked(|| bind_group(gpu, "opaque scene", &opaque, &[(0, &distances)]))?;
        Ok(Self {
            pipeline: pipeline(gpu, &["opaque/image"], &[&frame, &opaque])?,
            frame: bind(gpu, &frame, view, rays, hits)?,
            opaque_scene: Some(OpaqueScene { distances, bind_group }),
        })
    }

    /// Uploads the distances. WGSL has no infinity: it becomes [`NO_LIMIT`].
    pub(super) fn stop_at(&self, gpu: &Gpu, distances: &[f32]) -> Result<(), RenderError> {
        let Some(opaque_scene) = &self.opaque_scene else { return Ok(()) };
        let finite: Vec<f32> = distances.iter().map(|t| t.min(NO_LIMIT)).collect();
        gpu.checked(|| {
            gpu.queue.write_buffer(&opaque_scene.distances, 0, bytemuck::cast_slice(&finite));
        })
    }

    pub(super) fn record(&self, pass: &mut wgpu::ComputePass<'_>, workgroups: (u32, u32)) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.frame, &[]);
        if let Some(opaque_scene) = &self.opaque_scene {
            pass.set_bind_group(1, &opaque_scene.bind_group, &[]);
        }
        pass.dispatch_workgroups(workgroups.0, workgroups.1, 1);
    }
}

/// Group 0 of this pass, the only one that writes rays.
fn ray_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    bind_group_layout(
        gpu,
        "rays",
        &[(0, Binding::Uniform), (1, Binding::Write), (2, Binding::Write)],
    )
}

fn bind(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    view: &wgpu::Buffer,
    rays: &wgpu::Buffer,
    hits: &wgpu::Buffer,
) -> Result<wgpu::BindGroup, RenderError> {
    gpu.checked(|| bind_group(gpu, "rays", layout, &[(0, view), (1, rays), (2, hits)]))
}

fn pipeline(
    gpu: &Gpu,
    opaque: &'static [&'static str],
    layouts: &[&wgpu::BindGroupLayout],
) -> Result<wgpu::ComputePipeline, RenderError> {
    let spec = Specialization::without_balls().choosing(opaque);
    compute_pipeline(gpu, "rays", "core/rays", "make_rays", &spec, layouts, &[])
}
