//! Core depth and lists by rasterising a rectangle a ball, as published.

use metaball_core::NO_LIMIT;
use metaball_core::gpu::{
    DepthTest, Frame, Gpu, RasterDescriptor, RenderAttachments, RenderError, Shader,
    Specialization, TRIANGLE_STRIP,
};

use crate::balls::Balls;
use crate::canvas::Canvas;
use crate::layouts::{CORE_FORMAT, DEPTH_FORMAT, Layouts};

/// `shaders/wgsl/illes_fraglist/cores.wgsl` and `shaders/wgsl/illes_fraglist/gather.wgsl`.
pub(crate) struct RasterGather {
    cores: wgpu::RenderPipeline,
    gather: wgpu::RenderPipeline,
}

impl RasterGather {
    pub(super) fn new(
        gpu: &Gpu,
        spec: &Specialization,
        layouts: &Layouts,
    ) -> Result<Self, RenderError> {
        let Layouts { frame, scene, balls, lists, .. } = layouts;
        let raster = |module, descriptor: RasterDescriptor<'_>| {
            let shader = Shader::new(gpu, module, module, spec)?;
            shader.raster(gpu, spec, &descriptor)
        };
        Ok(Self {
            cores: raster(
                "illes_fraglist/cores",
                RasterDescriptor {
                    label: "illes cores",
                    vertex: "bound_core",
                    fragment: "draw_core",
                    constants: &[],
                    layouts: &[frame, scene, balls],
                    primitive: TRIANGLE_STRIP,
                    targets: &[Some(CORE_FORMAT.into())],
                    // Depth falls with distance; the clear value is 0.
                    depth: Some(DepthTest {
                        format: DEPTH_FORMAT,
                        compare: wgpu::CompareFunction::Greater,
                        writes: true,
                    }),
                },
            )?,
            gather: raster(
                "illes_fraglist/gather",
                RasterDescriptor {
                    label: "illes gather",
                    vertex: "bound_support",
                    fragment: "gather",
                    constants: &[],
                    layouts: &[frame, scene, balls, lists],
                    primitive: TRIANGLE_STRIP,
                    targets: &[],
                    // A depth target that nothing is tested against: with a colour target in its
                    // place, software Vulkan drops the storage writes of fragments that others cover.
                    depth: Some(DepthTest {
                        format: DEPTH_FORMAT,
                        compare: wgpu::CompareFunction::Always,
                        writes: false,
                    }),
                },
            )?,
        })
    }

    /// The passes `cores` and `gather`.
    pub(super) fn record(&self, frame: &mut Frame<'_>, balls: &Balls, canvas: &Canvas) {
        let targets = frame.targets();
        let bind = |pass: &mut wgpu::RenderPass<'_>| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, balls.scene.bind_group(), &[]);
            pass.set_bind_group(2, &balls.bind_group, &[]);
        };
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
            bind(pass);
            pass.set_pipeline(&self.cores);
            pass.draw(0..4, 0..balls.len());
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
            bind(pass);
            pass.set_bind_group(3, &canvas.turns[0].bind_group, &[]);
            pass.set_pipeline(&self.gather);
            pass.draw(0..4, 0..balls.len());
        });
    }
}
