//! A tree in GPU buffers.

use metaball_core::gpu::{Gpu, RenderError};

use super::pipelines::Layouts;
use super::suspended::SuspendedPool;
use crate::Tree;

/// The longest list of a leaf: about as long as the budget of `shaders/wgsl/fbvh/budget.wgsl`, so that
/// one walk along it fits into a dispatch, and none of the eight invocations that software Vulkan runs
/// side by side brings them near the 65,535 iterations, in all, after which it ends them.
const LONGEST_LIST: u32 = 6_600;

/// The three arrays of a tree, bound together with the pool of suspended rays.
pub(super) struct TreeBuffers {
    nodes: wgpu::Buffer,
    leaves: wgpu::Buffer,
    lists: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl TreeBuffers {
    pub(super) fn new(
        gpu: &Gpu,
        method: &'static str,
        layouts: &Layouts,
        tree: &Tree,
        suspended: &SuspendedPool,
    ) -> Result<Self, RenderError> {
        let longest = tree.leaves().windows(2).map(|pair| pair[1].first - pair[0].first).max();
        if let Some(found) = longest.filter(|&longest| longest > LONGEST_LIST) {
            let reason =
                format!("needed leaves of at most {LONGEST_LIST} balls, found one of {found}");
            return Err(RenderError::Unsupported { method, reason });
        }
        let none = wgpu::BufferUsages::empty();
        let nodes = gpu.upload("fbvh nodes", tree.nodes(), none)?;
        let leaves = gpu.upload("fbvh leaves", tree.leaves(), none)?;
        let lists = gpu.upload("fbvh lists", tree.lists(), none)?;
        let bind_group = bind(gpu, layouts, [&nodes, &leaves, &lists, suspended.buffer()]);
        Ok(Self { nodes, leaves, lists, bind_group })
    }

    /// Binds the tree with another pool.
    pub(super) fn rebind(&mut self, gpu: &Gpu, layouts: &Layouts, suspended: &SuspendedPool) {
        let buffers = [&self.nodes, &self.leaves, &self.lists, suspended.buffer()];
        self.bind_group = bind(gpu, layouts, buffers);
    }

    pub(super) fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    pub(super) fn bytes(&self) -> u64 {
        self.nodes.size() + self.leaves.size() + self.lists.size()
    }
}

fn bind(gpu: &Gpu, layouts: &Layouts, buffers: [&wgpu::Buffer; 4]) -> wgpu::BindGroup {
    let entry = |binding| wgpu::BindGroupEntry {
        binding,
        resource: buffers[binding as usize].as_entire_binding(),
    };
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("fbvh tree"),
        layout: &layouts.tree,
        entries: &[entry(0), entry(1), entry(2), entry(3)],
    })
}
