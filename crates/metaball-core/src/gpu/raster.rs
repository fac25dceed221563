//! Pipelines and targets of passes that rasterise, from short descriptions.

use super::{Gpu, RenderError, Shader, Specialization, pipeline_layout};

/// Triangles of a strip, culled on neither side.
pub const TRIANGLE_STRIP: wgpu::PrimitiveState = wgpu::PrimitiveState {
    topology: wgpu::PrimitiveTopology::TriangleStrip,
    strip_index_format: None,
    front_face: wgpu::FrontFace::Ccw,
    cull_mode: None,
    unclipped_depth: false,
    polygon_mode: wgpu::PolygonMode::Fill,
    conservative: false,
};

/// A raster pipeline. Vertices are made from their index: there are no vertex buffers.
#[derive(Debug, Clone, Copy)]
pub struct RasterDescriptor<'a> {
    /// Name in messages of wgpu.
    pub label: &'a str,
    /// Entry point of the vertex stage.
    pub vertex: &'a str,
    /// Entry point of the fragment stage.
    pub fragment: &'a str,
    /// Override constants of the method's own, by id (from 16).
    pub constants: &'a [(&'a str, f64)],
    /// Bind group layouts, the first as group 0.
    pub layouts: &'a [&'a wgpu::BindGroupLayout],
    /// How vertices make triangles.
    pub primitive: wgpu::PrimitiveState,
    /// Colour targets, by location.
    pub targets: &'a [Option<wgpu::ColorTargetState>],
    /// The depth target, if there is one.
    pub depth: Option<DepthTest>,
}

/// What a raster pipeline does with its depth target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DepthTest {
    /// Format of the target.
    pub format: wgpu::TextureFormat,
    /// Which fragments pass.
    pub compare: wgpu::CompareFunction,
    /// Whether those that pass write their depth.
    pub writes: bool,
}

impl Shader {
    /// A raster pipeline of two entry points.
    ///
    /// # Errors
    /// When wgpu refuses it.
    pub fn raster(
        &self,
        gpu: &Gpu,
        spec: &Specialization,
        descriptor: &RasterDescriptor<'_>,
    ) -> Result<wgpu::RenderPipeline, RenderError> {
        let constants = self.constants(spec, descriptor.constants);
        let compilation = || wgpu::PipelineCompilationOptions {
            constants: &constants,
            ..wgpu::PipelineCompilationOptions::default()
        };
        gpu.checked(|| {
            gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(descriptor.label),
                layout: Some(&pipeline_layout(gpu, descriptor.label, descriptor.layouts)),
                vertex: wgpu::VertexState {
                    module: &self.module,
                    entry_point: Some(descriptor.vertex),
                    compilation_options: compilation(),
                    buffers: &[],
                },
                primitive: descriptor.primitive,
                depth_stencil: descriptor.depth.map(|depth| wgpu::DepthStencilState {
                    format: depth.format,
                    depth_write_enabled: Some(depth.writes),
                    depth_compare: Some(depth.compare),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &self.module,
                    entry_point: Some(descriptor.fragment),
                    compilation_options: compilation(),
                    targets: descriptor.targets,
                }),
                multiview_mask: None,
                cache: None,
            })
        })
    }
}

impl Gpu {
    /// A texture of a picture's size that raster passes can draw to, with whatever `usages` adds.
    ///
    /// # Errors
    /// When the picture has more pixels across or down than the adapter's textures.
    pub fn render_target(
        &self,
        label: &str,
        format: wgpu::TextureFormat,
        (width, height): (u32, u32),
        layers: u32,
        usages: wgpu::TextureUsages,
    ) -> Result<wgpu::Texture, RenderError> {
        let limit = self.device.limits().max_texture_dimension_2d;
        if width > limit || height > limit {
            return Err(RenderError::PictureSize { width, height, limit });
        }
        self.checked(|| {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usages,
                view_formats: &[],
            })
        })
    }
}
