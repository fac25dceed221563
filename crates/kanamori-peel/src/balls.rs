//! The balls of a scene on the adapter.

use bytemuck::{Pod, Zeroable};
use metaball_core::gpu::{Gpu, RenderError, SceneBuffers, bind_group};
use metaball_core::{Aabb, Scene, View};

use crate::layouts::Layouts;
use crate::options::MOST_LIST_CAPACITY;

/// Balls of a workgroup of the passes over balls: `LANES` of
/// `shaders/wgsl/kanamori_peel/arrange.wgsl`.
const LANES: u32 = 256;

/// The most balls of a scene: targets keep indices as f32, exact up to 2²⁴, and a loop over workgroups
/// of balls in `shaders/wgsl/kanamori_peel/register.wgsl` must stay below the 65,535 iterations of
/// software Vulkan.
pub const MOST_BALLS: usize = 65_000 * LANES as usize;

/// Constants of a frame: WGSL's `Peeling` of `shaders/wgsl/kanamori_peel/frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Peeling {
    /// Factor from distance to depth, a power of two, 1/scene unit.
    pub(crate) depth_scale: f32,
}

/// A ball on the picture: WGSL's `Placed` of `shaders/wgsl/kanamori_peel/placed.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Placed {
    /// Lower left corner, clip space.
    pub(crate) low: [f32; 2],
    /// Upper right corner; equal to the other where the ball is not to be drawn.
    pub(crate) high: [f32; 2],
    /// 1 where the support holds the eye.
    pub(crate) around: u32,
    /// Fills the struct's last eight bytes.
    pub(crate) padding: u32,
}

/// Which balls are drawn: WGSL's `Arranged` of `shaders/wgsl/kanamori_peel/arranged.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Arranged {
    /// Balls whose rectangles are in the picture.
    pub(crate) in_view: u32,
    /// Those of them that are drawn.
    pub(crate) drawn: u32,
    /// Balls whose supports hold the eye.
    pub(crate) around: u32,
    /// Indices of the first of them.
    pub(crate) around_balls: [u32; MOST_LIST_CAPACITY as usize],
}

/// Buffers of one scene.
pub(crate) struct Balls {
    pub(crate) scene: SceneBuffers,
    pub(crate) count: u32,
    /// Group 2 of the passes over balls.
    pub(crate) arranging: wgpu::BindGroup,
    pub(crate) peeling: wgpu::Buffer,
    pub(crate) placed: wgpu::Buffer,
    pub(crate) seen: wgpu::Buffer,
    pub(crate) arranged: wgpu::Buffer,
    pub(crate) kernel_radii: wgpu::Buffer,
    bounds: Aabb,
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
        let arranged = gpu.storage("arranged balls", size_of::<Arranged>() as u64, none)?;
        let blocks = gpu.storage("blocks", 16 * count.div_ceil(LANES.into()).max(1), none)?;
        let peeling =
            gpu.storage("peeling", size_of::<Peeling>() as u64, wgpu::BufferUsages::UNIFORM)?;
        let arranging = gpu.checked(|| {
            let buffers = [(1, &placed), (2, &seen), (3, &arranged), (4, &blocks)];
            bind_group(gpu, "kanamori arranging", &layouts.arranging, &buffers)
        })?;
        let own = [&kernel_radii, &placed, &seen, &arranged, &blocks];
        Ok(Self {
            own_bytes: own.iter().map(|buffer| buffer.size()).sum(),
            scene: SceneBuffers::new(gpu, scene)?,
            count: scene.len() as u32,
            bounds: scene.bounds(),
            arranging,
            peeling,
            placed,
            seen,
            arranged,
            kernel_radii,
        })
    }

    /// Bytes on the adapter beside the scene's own.
    pub(crate) fn own_bytes(&self) -> u64 {
        self.own_bytes
    }

    /// Bytes that were sent beside the scene's own: the kernel spheres.
    pub(crate) fn own_upload_bytes(&self) -> u64 {
        4 * u64::from(self.count)
    }

    /// Which balls the last frame drew, and which are around the eye.
    pub(crate) fn arranged(&self, gpu: &Gpu) -> Result<Arranged, RenderError> {
        Ok(gpu.read(&self.arranged)?[0])
    }

    /// Workgroups of a pass over the balls.
    pub(crate) fn workgroups(&self) -> u32 {
        self.count.div_ceil(LANES)
    }

    /// Sends what depends on the view, and clears the flags of the balls that the last view saw.
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
