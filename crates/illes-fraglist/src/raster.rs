//! Core depth and lists by rasterising a rectangle a ball, as published.

use metaball_core::NO_LIMIT;
use metaball_core::gpu::{
    Frame, Gpu, RenderAttachments, RenderError, Shader, Specialization, pipeline_layout,
};

use crate::canvas::{CORE_FORMAT, Canvas, DEPTH_FORMAT};
use crate::pipelines::Layouts;
use crate::renderer::Built;

/// `illes_fraglist/cores.wgsl` and `gather.wgsl`.
pub(crate) struct RasterGather {
    cores: wgpu::RenderPipeline,
    gather: wgpu::RenderPipeline,
}

impl RasterGather {
    pub(crate) fn new(
        gpu: &Gpu,
        spec: &Specialization,
        layouts: &Layouts,
    ) -> Result<Self, RenderError> {
        let Layouts { frame, scene, balls, lists, .. } = layouts;
        let cores = RasterPass {
            module: "illes_fraglist/cores",
            vertex: "bound_core",
            fragment: "draw_core",
            groups: &[frame, scene, balls],
            color: Some(CORE_FORMAT),
            // Depth falls with distance; the clear value is 0.
            depth_compare: wgpu::CompareFunction::Greater,
        };
        // A depth target that nothing is tested against: with a colour target in its place, software
        // Vulkan drops the storage writes of fragments that others cover.
        let gather = RasterPass {
            module: "illes_fraglist/gather",
            vertex: "bound_support",
            fragment: "gather",
            groups: &[frame, scene, balls, lists],
            color: None,
            depth_compare: wgpu::CompareFunction::Always,
        };
        Ok(Self { cores: cores.pipeline(gpu, spec)?, gather: gather.pipeline(gpu, spec)? })
    }

    pub(crate) fn record(&self, frame: &mut Frame<'_>, built: &Built, canvas: &Canvas) {
        let targets = frame.targets();
        let far = wgpu::Color { r: f64::from(NO_LIMIT), ..wgpu::Color::BLACK };
        let cores = RenderAttachments {
            colors: &[Some(wgpu::RenderPassColorAttachment {
                view: &canvas.core,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(far),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &canvas.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
        };
        frame.render("cores", cores, |pass| {
            pass.set_pipeline(&self.cores);
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, built.scene.bind_group(), &[]);
            pass.set_bind_group(2, &built.bind_group, &[]);
            pass.draw(0..4, 0..built.len());
        });
        let gather = RenderAttachments {
            colors: &[],
            depth: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &canvas.depth,
                depth_ops: None,
                stencil_ops: None,
            }),
        };
        frame.render("gather", gather, |pass| {
            pass.set_pipeline(&self.gather);
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, built.scene.bind_group(), &[]);
            pass.set_bind_group(2, &built.bind_group, &[]);
            pass.set_bind_group(3, &canvas.bind_group, &[]);
            pass.draw(0..4, 0..built.len());
        });
    }
}

/// A pass that draws a rectangle for each ball.
struct RasterPass<'a> {
    module: &'static str,
    vertex: &'static str,
    fragment: &'static str,
    groups: &'a [&'a wgpu::BindGroupLayout],
    color: Option<wgpu::TextureFormat>,
    depth_compare: wgpu::CompareFunction,
}

impl RasterPass<'_> {
    /// Depth is written where there is colour.
    fn pipeline(
        &self,
        gpu: &Gpu,
        spec: &Specialization,
    ) -> Result<wgpu::RenderPipeline, RenderError> {
        let shader = Shader::new(gpu, self.module, self.module, spec)?;
        let constants = shader.constants(spec, &[]);
        let options = wgpu::PipelineCompilationOptions {
            constants: &constants,
            ..wgpu::PipelineCompilationOptions::default()
        };
        let targets: Vec<_> = self.color.map(|format| Some(format.into())).into_iter().collect();
        gpu.checked(|| {
            gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(self.module),
                layout: Some(&pipeline_layout(gpu, self.module, self.groups)),
                vertex: wgpu::VertexState {
                    module: &shader.module,
                    entry_point: Some(self.vertex),
                    compilation_options: options.clone(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState {
                    topology: wgpu::PrimitiveTopology::TriangleStrip,
                    ..wgpu::PrimitiveState::default()
                },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH_FORMAT,
                    depth_write_enabled: Some(self.color.is_some()),
                    depth_compare: Some(self.depth_compare),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &shader.module,
                    entry_point: Some(self.fragment),
                    compilation_options: options,
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            })
        })
    }
}
