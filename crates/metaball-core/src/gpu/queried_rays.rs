//! The list of the rays of a batch that have one query.

use std::sync::OnceLock;

use super::layout::{Binding, bind_group, bind_group_layout};
use super::pipeline::{Specialization, compute_pipeline};
use super::{Frame, Gpu, RayList, RenderError};
use crate::RayQuery;

/// The list, and the passes that make it: one for each query.
#[derive(Debug)]
pub(super) struct QueriedRays {
    list: RayList,
    layout: wgpu::BindGroupLayout,
    bind_group: wgpu::BindGroup,
    pipelines: [OnceLock<wgpu::ComputePipeline>; RayQuery::ALL.len()],
}

impl QueriedRays {
    /// For batches of so many rays.
    pub(super) fn new(
        gpu: &Gpu,
        pixels: u64,
        view: &wgpu::Buffer,
        rays: &wgpu::Buffer,
    ) -> Result<Self, RenderError> {
        let list = RayList::new(gpu, pixels)?;
        let bindings = [(0, Binding::Uniform), (1, Binding::Read), (2, Binding::Write)];
        let layout = bind_group_layout(gpu, "listed rays", &bindings);
        let buffers = [(0, view), (1, rays), (2, list.buffer())];
        let bind_group = gpu.checked(|| bind_group(gpu, "listed rays", &layout, &buffers))?;
        Ok(Self { list, layout, bind_group, pipelines: Default::default() })
    }

    pub(super) fn list(&self) -> &RayList {
        &self.list
    }

    /// Records the pass `label` that lists the rays with this query.
    pub(super) fn encode(
        &self,
        frame: &mut Frame<'_>,
        query: RayQuery,
        label: &'static str,
    ) -> Result<(), RenderError> {
        let pipeline = self.pipeline(frame.gpu(), query)?;
        let (across, down) = frame.targets().workgroups();
        self.list.clear(frame.encoder());
        frame.compute(label, |pass| {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.bind_group, &[]);
            pass.dispatch_workgroups(across, down, 1);
        });
        Ok(())
    }

    fn pipeline(&self, gpu: &Gpu, query: RayQuery) -> Result<&wgpu::ComputePipeline, RenderError> {
        let slot = &self.pipelines[query as usize - 1];
        if let Some(made) = slot.get() {
            return Ok(made);
        }
        let spec = Specialization::without_balls();
        let constants = [(RayQuery::CONSTANT, f64::from(query as u32))];
        let layouts = [&self.layout];
        let made = compute_pipeline(
            gpu,
            "listed rays",
            "batch/list_rays",
            "list_rays",
            &spec,
            &layouts,
            &constants,
        )?;
        Ok(slot.get_or_init(|| made))
    }
}
