//! The picture of the balls alone.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::layout::{Binding, bind_group, bind_group_layout};
use super::targets::ViewUniform;
use super::{
    DepthTest, Gpu, RasterDescriptor, RenderError, Shader, Specialization, TRIANGLE_STRIP, Targets,
};
use crate::{Image, Scene, SurfaceColors, View};

const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A ball as `shaders/wgsl/shade/spheres.wgsl` draws it: WGSL's `CoreSphere`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct CoreSphere {
    /// Centre, world space, scene units.
    pub(super) center: Vec3,
    /// Core radius, scene units, positive.
    pub(super) radius: f32,
    /// Colour in linear light.
    pub(super) color: Vec3,
    /// The distance, scene units, that is stored as depth one half; the same for all.
    pub(super) half_depth: f32,
}

/// The core spheres of a scene, ready to be drawn. Balls that never reach the threshold alone are
/// not among them.
#[derive(Debug)]
pub(super) struct SpherePicture {
    spheres: wgpu::Buffer,
    count: u32,
    sphere_layout: wgpu::BindGroupLayout,
    view_layout: wgpu::BindGroupLayout,
    background: wgpu::RenderPipeline,
    foreground: wgpu::RenderPipeline,
}

impl SpherePicture {
    pub(super) fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, RenderError> {
        let spheres = core_spheres(scene);
        let buffer = gpu.upload("core spheres", &spheres, wgpu::BufferUsages::empty())?;
        let view_layout = bind_group_layout(gpu, "view", &[(0, Binding::Uniform)]);
        let sphere_layout = bind_group_layout(gpu, "core spheres", &[(0, Binding::Read)]);
        let spec = Specialization::without_balls();
        let shader = Shader::new(gpu, "spheres", "shade/spheres", &spec)?;
        let pipeline = |vertex, fragment| {
            let descriptor = RasterDescriptor {
                label: fragment,
                vertex,
                fragment,
                constants: &[],
                layouts: &[&view_layout, &sphere_layout],
                primitive: TRIANGLE_STRIP,
                targets: &[Some(COLOR_FORMAT.into())],
                // Depth falls with distance; the background's is 0, as the clear value.
                depth: Some(DepthTest {
                    format: DEPTH_FORMAT,
                    compare: wgpu::CompareFunction::GreaterEqual,
                    writes: true,
                }),
            };
            shader.raster(gpu, &spec, &descriptor)
        };
        Ok(Self {
            spheres: buffer,
            count: spheres.len() as u32,
            background: pipeline("cover_picture", "shade_background")?,
            foreground: pipeline("bound_sphere", "shade_sphere")?,
            sphere_layout,
            view_layout,
        })
    }

    pub(super) fn draw(
        &self,
        gpu: &Gpu,
        targets: &Targets,
        view: &View,
    ) -> Result<Image, RenderError> {
        let (width, height) = (targets.width(), targets.height());
        let texture =
            |label, format, usages| gpu.render_target(label, format, (width, height), 1, usages);
        let color = texture("picture", COLOR_FORMAT, wgpu::TextureUsages::COPY_SRC)?;
        let depth = texture("depth", DEPTH_FORMAT, wgpu::TextureUsages::empty())?;
        let uniform = gpu.upload("view", &[ViewUniform::new(view)], wgpu::BufferUsages::UNIFORM)?;
        // A row of a copied texture begins at a multiple of 256 bytes.
        let row_bytes = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(row_bytes) * u64::from(height);
        let rows = gpu.storage("picture", bytes, wgpu::BufferUsages::empty())?;
        gpu.checked(|| {
            let view_group = bind_group(gpu, "view", &self.view_layout, &[(0, &uniform)]);
            let sphere_group =
                bind_group(gpu, "core spheres", &self.sphere_layout, &[(0, &self.spheres)]);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            self.record(&mut encoder, &color, &depth, &view_group, &sphere_group);
            encoder.copy_texture_to_buffer(
                color.as_image_copy(),
                wgpu::TexelCopyBufferInfo {
                    buffer: &rows,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(row_bytes),
                        rows_per_image: None,
                    },
                },
                color.size(),
            );
            gpu.queue.submit([encoder.finish()]);
        })?;
        let rows: Vec<u8> = gpu.read(&rows)?;
        let filled = |row: &[u8]| row[..4 * width as usize].to_vec();
        let rgba = rows.chunks_exact(row_bytes as usize).flat_map(filled).collect();
        Ok(Image { width, height, rgba })
    }

    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        color: &wgpu::Texture,
        depth: &wgpu::Texture,
        view: &wgpu::BindGroup,
        spheres: &wgpu::BindGroup,
    ) {
        let color = color.create_view(&Default::default());
        let depth = depth.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("spheres"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, view, &[]);
        pass.set_bind_group(1, spheres, &[]);
        pass.set_pipeline(&self.background);
        pass.draw(0..4, 0..1);
        pass.set_pipeline(&self.foreground);
        pass.draw(0..4, 0..self.count);
    }
}

/// Each ball's sphere of its own threshold, with the ball's colour or a common one.
fn core_spheres(scene: &Scene) -> Vec<CoreSphere> {
    let cores = scene.balls().enumerate().filter_map(|(index, ball)| {
        let radius = scene.kernel().core_radius(&ball, scene.threshold())? as f32;
        let color =
            scene.colors().map_or(SurfaceColors::UNCOLORED, |colors| colors[index].to_linear());
        (radius > 0.0).then_some(CoreSphere { center: ball.center, radius, color, half_depth: 0.0 })
    });
    let mut spheres: Vec<_> = cores.collect();
    let smallest = spheres.iter().map(|sphere| sphere.radius).reduce(f32::min).unwrap_or(1.0);
    for sphere in &mut spheres {
        sphere.half_depth = smallest;
    }
    spheres
}
