//! The balls of a scene on the adapter.

use metaball_core::gpu::{Gpu, RenderError, SceneBuffers, bind_group};
use metaball_core::{Camera, Scene, Support};

use crate::layouts::Layouts;
use crate::options::Sort;
use crate::sort::{SortBuffers, by_effective_distance};

/// The balls of a scene, their order in the last frame, and their core radii.
pub(crate) struct Balls {
    pub(crate) scene: SceneBuffers,
    /// To be sorted for each frame.
    supports: Vec<Support>,
    ball_of_rank: wgpu::Buffer,
    core_radii: wgpu::Buffer,
    /// Where balls are sorted on the adapter.
    pub(crate) sort_buffers: Option<SortBuffers>,
    /// Group 2 of all passes but the sort.
    pub(crate) bind_group: wgpu::BindGroup,
}

impl Balls {
    pub(crate) fn new(
        gpu: &Gpu,
        scene: &Scene,
        layouts: &Layouts,
        sort: Sort,
    ) -> Result<Self, RenderError> {
        let core_radii: Vec<f32> = scene
            .balls()
            .map(|ball| {
                let radius = scene.kernel().core_radius(&ball, scene.threshold());
                radius.map_or(0.0, |radius| radius as f32)
            })
            .collect();
        let none = wgpu::BufferUsages::empty();
        let core_radii = gpu.upload("illes core radii", &core_radii, none)?;
        let ball_of_rank = gpu.storage("illes order", 4 * scene.len() as u64, none)?;
        let bind_group = gpu.checked(|| {
            let buffers = [(0, &ball_of_rank), (1, &core_radii)];
            bind_group(gpu, "illes balls", &layouts.balls, &buffers)
        })?;
        let count = scene.len() as u32;
        let sort_buffers = match sort {
            Sort::Host => None,
            Sort::Adapter => Some(SortBuffers::new(gpu, layouts, count, &ball_of_rank)?),
        };
        Ok(Self {
            scene: SceneBuffers::new(gpu, scene)?,
            supports: scene.supports().to_vec(),
            ball_of_rank,
            core_radii,
            sort_buffers,
            bind_group,
        })
    }

    /// Their number.
    pub(crate) fn len(&self) -> u32 {
        self.supports.len() as u32
    }

    /// Bytes sent to the adapter.
    pub(crate) fn upload_bytes(&self) -> u64 {
        self.scene.bytes() + self.core_radii.size()
    }

    /// Bytes on the adapter.
    pub(crate) fn device_bytes(&self) -> u64 {
        let sort = self.sort_buffers.as_ref().map_or(0, SortBuffers::bytes);
        self.upload_bytes() + self.ball_of_rank.size() + sort
    }

    /// Sorts on the host, and sends the order to the adapter.
    pub(crate) fn sort(&self, gpu: &Gpu, camera: &Camera) -> Result<(), RenderError> {
        let order = by_effective_distance(&self.supports, camera);
        let bytes = bytemuck::cast_slice(&order);
        gpu.checked(|| gpu.queue.write_buffer(&self.ball_of_rank, 0, bytes))
    }

    /// The balls of the last frame in their order.
    #[cfg(test)]
    pub(crate) fn order(&self, gpu: &Gpu) -> Result<Vec<u32>, RenderError> {
        gpu.read(&self.ball_of_rank)
    }
}
