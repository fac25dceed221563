//! What the method keeps of a scene on the device.

use std::mem::offset_of;

use bytemuck::{Pod, Zeroable};
use metaball_core::gpu::{Gpu, RenderError, SceneBuffers};
use metaball_core::{Aabb, Scene, View};

use crate::pipelines::Layouts;

/// Balls of a workgroup of the passes over balls: `LANES` of `arrange.wgsl`.
const LANES: u32 = 256;

/// The most balls: one workgroup a block, and indices that f32 keeps exactly.
pub(crate) const MOST_BALLS: usize = 65_535 * LANES as usize;

/// WGSL's `Peeling` of `frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Peeling {
    /// A power of two, 1/scene unit.
    pub(crate) depth_scale: f32,
}

/// A ball on the picture: WGSL's `Placed` of `rectangle.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Placed {
    /// Lower left corner, clip space.
    pub(crate) low: [f32; 2],
    /// Upper right corner; equal to the other where nothing is to be seen.
    pub(crate) high: [f32; 2],
    /// 1 where the support holds the eye.
    pub(crate) around: u32,
    /// Fills the struct's last eight bytes.
    pub(crate) padding: u32,
}

/// The head of WGSL's `Arranged` of `arranged.wgsl`; the balls to draw follow.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct ArrangedHead {
    /// Balls to draw.
    pub(crate) drawn: u32,
    /// Balls around the eye.
    pub(crate) around: u32,
    /// The first of them.
    pub(crate) around_balls: [u32; 30],
}

/// Two indirect draws: the balls, and the tiles. Each is the number of vertices, of instances, and
/// the first of both.
const NO_DRAWS: [u32; 8] = [4, 0, 0, 0, 4, 0, 0, 0];

/// Buffers of one scene, and the two groups 2 that bind them.
pub(crate) struct Balls {
    pub(crate) scene: SceneBuffers,
    pub(crate) count: u32,
    pub(crate) arranging: wgpu::BindGroup,
    pub(crate) drawing: wgpu::BindGroup,
    /// What indirect draws read.
    pub(crate) arguments: wgpu::Buffer,
    #[cfg(test)]
    pub(crate) placed: wgpu::Buffer,
    bounds: Aabb,
    peeling: wgpu::Buffer,
    seen: wgpu::Buffer,
    arranged: wgpu::Buffer,
    /// What shaders write for the next layer.
    draws: wgpu::Buffer,
    no_draws: wgpu::Buffer,
    own_bytes: u64,
}

impl Balls {
    pub(crate) fn new(gpu: &Gpu, scene: &Scene, layouts: &Layouts) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        let count = scene.len() as u64;
        let kernel_radii: Vec<f32> = scene
            .balls()
            .map(|ball| scene.kernel().core_radius(&ball, scene.threshold()).unwrap_or(0.0) as f32)
            .collect();
        let kernel_radii = gpu.upload("kernel spheres", &kernel_radii, none)?;
        let of_balls = |what, each: usize| gpu.storage(what, count.max(1) * each as u64, none);
        let placed = of_balls("placed balls", size_of::<Placed>())?;
        let seen = of_balls("balls seen", size_of::<u32>())?;
        let head = size_of::<ArrangedHead>() as u64;
        let arranged = gpu.storage("arranged balls", head + 4 * count.max(1), none)?;
        let blocks = gpu.storage("blocks", 8 * count.div_ceil(LANES.into()).max(1), none)?;
        let draws = gpu.upload("next draws", &NO_DRAWS, none)?;
        let no_draws = gpu.upload("no draws", &NO_DRAWS, none)?;
        let arguments = gpu.storage("draws", draws.size(), wgpu::BufferUsages::INDIRECT)?;
        let peeling =
            gpu.storage("peeling", size_of::<Peeling>() as u64, wgpu::BufferUsages::UNIFORM)?;

        let group = |label, layout, buffers: &[&wgpu::Buffer]| {
            let entries: Vec<_> = (0u32..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry {
                    binding,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(label),
                layout,
                entries: &entries,
            })
        };
        let (arranging, drawing) = gpu.checked(|| {
            let arranging = [&peeling, &placed, &seen, &arranged, &blocks, &draws];
            let drawing = [&peeling, &placed, &arranged, &kernel_radii, &seen, &draws];
            (
                group("kanamori arranging", &layouts.arranging, &arranging),
                group("kanamori drawing", &layouts.drawing, &drawing),
            )
        })?;
        let own = [&kernel_radii, &placed, &seen, &arranged, &blocks];
        Ok(Self {
            own_bytes: own.iter().map(|buffer| buffer.size()).sum(),
            scene: SceneBuffers::new(gpu, scene)?,
            count: scene.len() as u32,
            bounds: scene.bounds(),
            arranging,
            drawing,
            arguments,
            #[cfg(test)]
            placed,
            peeling,
            seen,
            arranged,
            draws,
            no_draws,
        })
    }

    /// Bytes on the device beside the scene's own.
    pub(crate) fn own_bytes(&self) -> u64 {
        self.own_bytes
    }

    /// Bytes that were sent beside the scene's own: the kernel spheres.
    pub(crate) fn own_upload_bytes(&self) -> u64 {
        4 * u64::from(self.count)
    }

    /// Balls that the last frame drew.
    pub(crate) fn drawn(&self, gpu: &Gpu) -> Result<u32, RenderError> {
        let words: Vec<u32> = gpu.read(&self.arranged)?;
        Ok(words[offset_of!(ArrangedHead, drawn) / size_of::<u32>()])
    }

    /// Workgroups of a pass over the balls.
    pub(crate) fn workgroups(&self) -> u32 {
        self.count.div_ceil(LANES)
    }

    /// Sends what depends on the view, and forgets which balls the last view saw.
    pub(crate) fn begin(
        &self,
        gpu: &Gpu,
        view: &View,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), RenderError> {
        let peeling = Peeling { depth_scale: depth_scale(&self.bounds, view) };
        encoder.clear_buffer(&self.seen, 0, None);
        gpu.checked(|| gpu.queue.write_buffer(&self.peeling, 0, bytemuck::bytes_of(&peeling)))
    }

    /// Makes the draws of the next layer those that shaders asked for since the last call.
    pub(crate) fn take_draws(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_buffer_to_buffer(&self.draws, 0, &self.arguments, 0, self.draws.size());
        encoder.copy_buffer_to_buffer(&self.no_draws, 0, &self.draws, 0, self.draws.size());
    }
}

/// The power of two that brings every distance in the scene's bounds below one half.
fn depth_scale(bounds: &Aabb, view: &View) -> f32 {
    if bounds.is_empty() {
        return 1.0;
    }
    let eye = view.camera().eye().as_dvec3();
    let reach = (bounds.center().as_dvec3() - eye).length() + bounds.extent().as_dvec3().length();
    // Scenes reach to a few times 1e18, so neither the power nor a product leaves f32's range.
    (-reach.log2().ceil() - 1.0).exp2() as f32
}
