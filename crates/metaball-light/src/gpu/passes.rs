//! The passes: a compute pipeline for each step of a path.

use metaball_core::gpu::{
    Frame, Gpu, RayBatch, RenderError, Shader, Specialization, Targets, bind_group,
    bind_group_layout,
};

use super::buffers::Buffers;
use crate::Environment;

/// The pipelines, and the groups that all of them bind.
#[derive(Debug)]
pub(crate) struct Passes {
    start: wgpu::ComputePipeline,
    surface: wgpu::ComputePipeline,
    shadow: wgpu::ComputePipeline,
    add_sample: wgpu::ComputePipeline,
    groups: [wgpu::BindGroup; 3],
    /// Workgroups over the picture.
    workgroups: (u32, u32),
}

impl Passes {
    pub(crate) fn new(
        gpu: &Gpu,
        targets: &Targets,
        buffers: &Buffers,
        environment: &Environment,
    ) -> Result<Self, RenderError> {
        let bound = [
            ("paths", buffers.of_paths(targets)),
            ("shadow rays", buffers.of_shadow_rays()),
            ("effects", buffers.of_effects()),
        ];
        let layouts = bound.each_ref().map(|(label, bound)| {
            let bindings: Vec<_> = bound.iter().map(|&(at, kind, _)| (at, kind)).collect();
            bind_group_layout(gpu, label, &bindings)
        });
        let groups = [0, 1, 2].map(|index: usize| {
            let (label, bound) = &bound[index];
            let buffers: Vec<_> = bound.iter().map(|&(at, _, buffer)| (at, buffer)).collect();
            bind_group(gpu, label, &layouts[index], &buffers)
        });

        let colors = targets.colors().is_some();
        let spec = Specialization { colors, ..Specialization::without_balls() };
        let spec = spec.choosing(match environment {
            Environment::Sky => &["light/environment/sky"],
            Environment::Panorama(_) => &["light/environment/image"],
        });
        let layouts = layouts.each_ref();
        let pipeline = |module, entry| {
            let shader = Shader::new(gpu, module, module, &spec)?;
            shader.compute(gpu, module, entry, &spec, &layouts, &[])
        };
        Ok(Self {
            start: pipeline("light/start", "start_paths")?,
            surface: pipeline("light/surface", "meet_surface")?,
            shadow: pipeline("light/shadow", "resolve_shadow_rays")?,
            add_sample: pipeline("light/add_sample", "add_sample")?,
            groups: gpu.checked(|| groups)?,
            workgroups: targets.workgroups(),
        })
    }

    /// Records the start of a path in every pixel.
    pub(crate) fn encode_start(&self, frame: &mut Frame<'_>) {
        frame.compute("light start", |pass| self.over_picture(pass, &self.start));
    }

    /// Records what becomes of paths whose own rays have been answered.
    pub(crate) fn encode_surface(&self, frame: &mut Frame<'_>, path_rays: &RayBatch) {
        frame.compute("light surface", |pass| self.along(pass, &self.surface, path_rays));
    }

    /// Records what becomes of paths whose shadow or occlusion rays have been answered.
    pub(crate) fn encode_shadow(&self, frame: &mut Frame<'_>, shadow_rays: &RayBatch) {
        frame.compute("light shadow", |pass| self.along(pass, &self.shadow, shadow_rays));
    }

    /// Adds the light of all paths to the film, outside of any frame.
    pub(crate) fn add_sample(&self, gpu: &Gpu) -> Result<(), RenderError> {
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.over_picture(&mut pass, &self.add_sample);
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
        })
    }

    fn over_picture(&self, pass: &mut wgpu::ComputePass<'_>, pipeline: &wgpu::ComputePipeline) {
        let (across, down) = self.workgroups;
        self.bind(pass, pipeline);
        pass.dispatch_workgroups(across, down, 1);
    }

    /// Over the pixels whose rays have just been answered.
    fn along(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        pipeline: &wgpu::ComputePipeline,
        answered: &RayBatch,
    ) {
        self.bind(pass, pipeline);
        answered.list().dispatch(pass);
    }

    fn bind(&self, pass: &mut wgpu::ComputePass<'_>, pipeline: &wgpu::ComputePipeline) {
        pass.set_pipeline(pipeline);
        for (index, group) in self.groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
    }
}
