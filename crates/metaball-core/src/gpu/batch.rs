//! Free rays on the device, one a pixel, with their answers.

use super::layout::bind_group;
use super::queried_rays::QueriedRays;
use super::{Frame, FreeRay, Gpu, RayList, RenderError, Specialization, Targets, free_ray_layout};
use crate::RayQuery;
use crate::{Color, Hit, PackedHit};

/// One free ray for each pixel of some targets, and its answer. The caller writes the rays, from the
/// host ([`RayBatch::write_rays`]) or by a pass of its own. Unfinished rays count in the status of the
/// targets' frame, work in the targets' counters. 52 bytes a pixel; 4 more with colours.
#[derive(Debug)]
pub struct RayBatch {
    rays: wgpu::Buffer,
    hits: wgpu::Buffer,
    colors: Option<wgpu::Buffer>,
    queried: QueriedRays,
    bind_group: wgpu::BindGroup,
}

impl RayBatch {
    /// A batch with one ray for each pixel of the targets, none of them with a query yet.
    ///
    /// # Errors
    /// When the adapter cannot bind so much.
    pub fn new(gpu: &Gpu, targets: &Targets) -> Result<Self, RenderError> {
        let pixels = u64::from(targets.width()) * u64::from(targets.height());
        let none = wgpu::BufferUsages::empty();
        let one_a_pixel = |what, size: usize| gpu.storage(what, pixels * size as u64, none);
        let rays = one_a_pixel("free rays", size_of::<FreeRay>())?;
        let hits = one_a_pixel("answers to free rays", size_of::<PackedHit>())?;
        let has_colors = targets.colors().is_some();
        let colors = has_colors
            .then(|| one_a_pixel("colours at free rays", size_of::<Color>()))
            .transpose()?;

        let queried = QueriedRays::new(gpu, pixels, &targets.view, &rays)?;

        let mut buffers = vec![(0, &targets.view), (1, &rays), (2, &hits), (3, &targets.status)];
        buffers.extend(colors.as_ref().map(|buffer| (4, buffer)));
        buffers.extend(targets.work().map(|buffer| (5, buffer)));
        buffers.push((6, queried.list().buffer()));
        let spec = Specialization {
            colors: has_colors,
            counting: targets.work().is_some(),
            ..Specialization::without_balls()
        };
        let layout = free_ray_layout(gpu, &spec);
        let bind_group = gpu.checked(|| bind_group(gpu, "free rays", &layout, &buffers))?;
        Ok(Self { rays, hits, colors, queried, bind_group })
    }

    /// Group 0 of the passes that answer queries, laid out as [`free_ray_layout`].
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// Records the pass `label` that lists the rays with this query: the passes that answer them and
    /// that read the answers run along the list, without idle invocations.
    ///
    /// # Errors
    /// When the pass cannot be made.
    pub fn encode_list(
        &self,
        frame: &mut Frame<'_>,
        query: RayQuery,
        label: &'static str,
    ) -> Result<(), RenderError> {
        self.queried.encode(frame, query, label)
    }

    /// The last list.
    pub fn list(&self) -> &RayList {
        self.queried.list()
    }

    /// One [`FreeRay`] a pixel, row by row from the top left, to be written by the caller.
    pub fn rays(&self) -> &wgpu::Buffer {
        &self.rays
    }

    /// One [`PackedHit`] a pixel: the last answer.
    pub fn hits(&self) -> &wgpu::Buffer {
        &self.hits
    }

    /// One [`Color`] a pixel, where the targets have colours: the blended colour at first hits and
    /// exits.
    pub fn colors(&self) -> Option<&wgpu::Buffer> {
        self.colors.as_ref()
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        let colors = self.colors.as_ref().map_or(0, wgpu::Buffer::size);
        self.rays.size() + self.hits.size() + self.list().buffer().size() + colors
    }

    /// Writes rays from the host, row by row from the top left; the rest of the batch has no query.
    ///
    /// # Errors
    /// When there are more rays than pixels, or the device fails.
    pub fn write_rays(&self, gpu: &Gpu, rays: &[FreeRay]) -> Result<(), RenderError> {
        let needed = (self.rays.size() / size_of::<FreeRay>() as u64) as usize;
        if rays.len() > needed {
            return Err(RenderError::RayCount { needed, found: rays.len() });
        }
        let mut all = rays.to_vec();
        all.resize(needed, FreeRay::NONE);
        gpu.checked(|| gpu.queue.write_buffer(&self.rays, 0, bytemuck::cast_slice(&all)))
    }

    /// The rays, bit for bit as shaders see them. Waits for the device.
    ///
    /// # Errors
    /// When the device fails.
    pub fn read_rays(&self, gpu: &Gpu) -> Result<Vec<FreeRay>, RenderError> {
        gpu.read(&self.rays)
    }

    /// The last answers; meaningless at rays without a query. Waits for the device.
    ///
    /// # Errors
    /// When the device fails.
    pub fn read_hits(&self, gpu: &Gpu) -> Result<Vec<Hit>, RenderError> {
        Ok(gpu.read::<PackedHit>(&self.hits)?.into_iter().map(PackedHit::unpack).collect())
    }
}
