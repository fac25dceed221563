//! The rays of a batch that ask one question, side by side.

use std::sync::OnceLock;

use bytemuck::{Pod, Zeroable};

use super::layout::{Binding, group, layout};
use super::pipeline::{Specialization, compute_pipeline};
use super::{Frame, Gpu, Question, RenderError};

/// What a list begins with: WGSL's `Listed` of `ray/listed.wgsl`. The first twelve bytes are the size of an
/// indirect dispatch along it.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct ListHead {
    pub(super) groups_x: u32,
    pub(super) groups_y: u32,
    pub(super) groups_z: u32,
    pub(super) count: u32,
}

/// The list, and the passes that make it: one for each question.
#[derive(Debug)]
pub(super) struct RayList {
    buffer: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    bind_group: wgpu::BindGroup,
    pipelines: [OnceLock<wgpu::ComputePipeline>; Question::ALL.len()],
}

impl RayList {
    /// For so many rays, one a pixel of a view.
    pub(super) fn new(
        gpu: &Gpu,
        pixels: u64,
        view: &wgpu::Buffer,
        rays: &wgpu::Buffer,
    ) -> Result<Self, RenderError> {
        let bytes = size_of::<ListHead>() as u64 + pixels * size_of::<u32>() as u64;
        let buffer = gpu.storage("rays that ask", bytes, wgpu::BufferUsages::INDIRECT)?;
        let bindings = [(0, Binding::Uniform), (1, Binding::Read), (2, Binding::Write)];
        let layout = layout(gpu, "rays that ask", &bindings);
        let buffers = [(0, view), (1, rays), (2, &buffer)];
        let bind_group = gpu.checked(|| group(gpu, "rays that ask", &layout, &buffers))?;
        Ok(Self { buffer, layout, bind_group, pipelines: Default::default() })
    }

    pub(super) fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Records the pass that lists the rays with this question.
    pub(super) fn encode(
        &self,
        frame: &mut Frame<'_>,
        question: Question,
        label: &'static str,
    ) -> Result<(), RenderError> {
        let pipeline = self.pipeline(frame.gpu(), question)?;
        let (across, down) = frame.targets().workgroups();
        frame.encoder().clear_buffer(&self.buffer, 0, Some(size_of::<ListHead>() as u64));
        frame.compute(label, |pass| {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.bind_group, &[]);
            pass.dispatch_workgroups(across, down, 1);
        });
        Ok(())
    }

    fn pipeline(
        &self,
        gpu: &Gpu,
        question: Question,
    ) -> Result<&wgpu::ComputePipeline, RenderError> {
        let place = &self.pipelines[question as usize - 1];
        if let Some(made) = place.get() {
            return Ok(made);
        }
        let spec = Specialization::without_balls();
        let constants = [(Question::CONSTANT, f64::from(question as u32))];
        let layouts = [&self.layout];
        let made = compute_pipeline(
            gpu,
            "rays that ask",
            "ray/list",
            "list_rays",
            &spec,
            &layouts,
            &constants,
        )?;
        Ok(place.get_or_init(|| made))
    }
}
