//! The buffers that frames of one size write.

use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::clock::Clock;
use super::layout::{Binding, bind_group, bind_group_layout};
use super::rays::{PackedRay, RayPass};
use super::{FrameStatus, Gpu, RenderError, Specialization};
use crate::{Color, Hit, PackedHit, Ray, View, Work};

/// Pixels on a side of the square that a workgroup of a pass over the picture covers:
/// `@workgroup_size(8, 8)`.
pub const TILE: u32 = 8;

/// The buffers of one image size: rays, hits and status, timestamps of passes, and where they were
/// requested blended colours and work counters. 32 bytes a pixel; 4 more with colours, 32 more with
/// work. All images are stored row by row from the top left.
///
/// One frame at a time uses them.
#[derive(Debug)]
pub struct Targets {
    width: u32,
    height: u32,
    pub(super) view: wgpu::Buffer,
    rays: wgpu::Buffer,
    hits: wgpu::Buffer,
    pub(super) status: wgpu::Buffer,
    colors: Option<wgpu::Buffer>,
    pub(super) work: Option<wgpu::Buffer>,
    bind_group: wgpu::BindGroup,
    pub(super) clock: Clock,
    pub(super) in_use: AtomicBool,
    free_rays: RayPass,
    /// Made with the first view that has an opaque scene.
    stopped_rays: OnceLock<RayPass>,
}

/// A view as shaders see it: WGSL's `View` of `shaders/wgsl/core/view.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ViewUniform {
    /// Start of all rays, world space, scene units.
    pub eye: Vec3,
    /// Pixels across.
    pub width: u32,
    /// Unit vector to the right of the picture.
    pub right: Vec3,
    /// Pixels down.
    pub height: u32,
    /// Unit vector to the top of the picture.
    pub up: Vec3,
    /// Half a pixel's height at unit distance from the eye.
    pub half_pixel: f32,
    /// Unit vector into the picture.
    pub forward: Vec3,
    /// Fills the last sixteen bytes; zero.
    pub padding: u32,
}

impl ViewUniform {
    /// The view's camera and size.
    pub fn new(view: &View) -> Self {
        let camera = view.camera();
        let half_pixel = f64::from(camera.half_height()) / f64::from(view.height());
        Self {
            eye: camera.eye(),
            width: view.width(),
            right: camera.right(),
            height: view.height(),
            up: camera.up(),
            half_pixel: half_pixel as f32,
            forward: camera.forward(),
            padding: 0,
        }
    }
}

impl Targets {
    /// Makes the targets of an image size, with blended colours and with work counters if wanted.
    /// Methods that draw to them have to be specialised for the same.
    ///
    /// # Errors
    /// When the picture has no pixels or more than the adapter can bind or dispatch.
    pub fn new(
        gpu: &Gpu,
        width: u32,
        height: u32,
        colors: bool,
        counting: bool,
    ) -> Result<Self, RenderError> {
        let limit = gpu.device.limits().max_compute_workgroups_per_dimension.saturating_mul(TILE);
        if [width, height].iter().any(|&side| side == 0 || side > limit) {
            return Err(RenderError::PictureSize { width, height, limit });
        }
        let pixels = u64::from(width) * u64::from(height);
        let none = wgpu::BufferUsages::empty();
        let one_a_pixel = |what, size: usize| gpu.storage(what, pixels * size as u64, none);
        let view =
            gpu.storage("view", size_of::<ViewUniform>() as u64, wgpu::BufferUsages::UNIFORM)?;
        let rays = one_a_pixel("rays", size_of::<PackedRay>())?;
        let hits = one_a_pixel("hits", size_of::<PackedHit>())?;
        let status = gpu.storage("status", size_of::<FrameStatus>() as u64, none)?;
        let colors =
            colors.then(|| one_a_pixel("blended colours", size_of::<Color>())).transpose()?;
        let work = counting.then(|| one_a_pixel("work", size_of::<Work>())).transpose()?;

        let mut buffers = vec![(0, &view), (1, &rays), (2, &hits), (3, &status)];
        buffers.extend(colors.as_ref().map(|buffer| (4, buffer)));
        buffers.extend(work.as_ref().map(|buffer| (5, buffer)));
        let layout = layout_of(gpu, colors.is_some(), work.is_some(), false);
        let bind_group = gpu.checked(|| bind_group(gpu, "frame", &layout, &buffers))?;
        let free_rays = RayPass::free(gpu, &view, &rays, &hits)?;
        Ok(Self {
            width,
            height,
            bind_group,
            clock: Clock::new(gpu)?,
            in_use: AtomicBool::new(false),
            free_rays,
            stopped_rays: OnceLock::new(),
            view,
            rays,
            hits,
            status,
            colors,
            work,
        })
    }

    /// Pixels across.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels down.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Workgroups across and down of a pass with one invocation a pixel and [`TILE`]² of them in a
    /// workgroup.
    pub fn workgroups(&self) -> (u32, u32) {
        (self.width.div_ceil(TILE), self.height.div_ceil(TILE))
    }

    /// Bytes on the device, but for the clock's 64 KiB and an opaque scene's 4 a pixel.
    pub fn bytes(&self) -> u64 {
        let optional = [&self.colors, &self.work].into_iter().flatten();
        let always = [&self.view, &self.rays, &self.hits, &self.status].into_iter();
        always.chain(optional).map(wgpu::Buffer::size).sum()
    }

    /// The view of the last frame, one [`ViewUniform`].
    pub fn view(&self) -> &wgpu::Buffer {
        &self.view
    }

    /// Group 0, laid out as [`frame_layout`].
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// One [`PackedRay`] a pixel: the rays of the last frame.
    pub fn rays(&self) -> &wgpu::Buffer {
        &self.rays
    }

    /// One [`PackedHit`] a pixel.
    pub fn hits(&self) -> &wgpu::Buffer {
        &self.hits
    }

    /// One sRGB-encoded [`Color`] a pixel, if requested.
    pub fn colors(&self) -> Option<&wgpu::Buffer> {
        self.colors.as_ref()
    }

    /// One [`Work`] a pixel, if requested.
    pub fn work(&self) -> Option<&wgpu::Buffer> {
        self.work.as_ref()
    }

    /// The hits of the last frame. A pixel that its method did not write is undecided. Waits for the
    /// device.
    ///
    /// # Errors
    /// When the device fails.
    pub fn read_hits(&self, gpu: &Gpu) -> Result<Vec<Hit>, RenderError> {
        Ok(gpu.read::<PackedHit>(&self.hits)?.into_iter().map(PackedHit::unpack).collect())
    }

    /// Replaces the hits of the last frame, so that the shared shading shows others, such as those of
    /// the reference.
    ///
    /// # Errors
    /// When there is not one for each pixel, or the device fails.
    pub fn write_hits(&self, gpu: &Gpu, hits: &[Hit]) -> Result<(), RenderError> {
        let needed = self.width as usize * self.height as usize;
        if hits.len() != needed {
            return Err(RenderError::HitCount { needed, found: hits.len() });
        }
        let packed: Vec<_> = hits.iter().copied().map(PackedHit::from).collect();
        gpu.checked(|| gpu.queue.write_buffer(&self.hits, 0, bytemuck::cast_slice(&packed)))
    }

    /// Replaces the blended colour of a pixel of the last frame, if the targets have colours.
    ///
    /// # Errors
    /// When the device fails, or there is no such pixel.
    pub fn write_color(&self, gpu: &Gpu, pixel: usize, color: Color) -> Result<(), RenderError> {
        let Some(colors) = &self.colors else { return Ok(()) };
        let offset = (pixel * size_of::<Color>()) as u64;
        gpu.checked(|| gpu.queue.write_buffer(colors, offset, bytemuck::bytes_of(&color)))
    }

    /// The rays of the last frame, bit for bit as shaders saw them. `view` is that frame's. Waits for the
    /// device.
    ///
    /// # Errors
    /// When the device fails.
    pub fn read_rays(&self, gpu: &Gpu, view: &View) -> Result<Vec<Ray>, RenderError> {
        let origin = view.camera().eye();
        let unpack = |ray: PackedRay| Ray { t_max: ray.t_max, ..Ray::new(origin, ray.direction) };
        Ok(gpu.read::<PackedRay>(&self.rays)?.into_iter().map(unpack).collect())
    }

    /// The blended colours of the last frame, if the targets have them; meaningless where there is no
    /// hit. Waits for the device.
    ///
    /// # Errors
    /// When the device fails.
    pub fn read_colors(&self, gpu: &Gpu) -> Result<Option<Vec<Color>>, RenderError> {
        self.colors.as_ref().map(|buffer| gpu.read(buffer)).transpose()
    }

    /// What the pixels of the last frame cost, if the targets count it. Waits for the device.
    ///
    /// # Errors
    /// When the device fails.
    pub fn read_work(&self, gpu: &Gpu) -> Result<Option<Vec<Work>>, RenderError> {
        self.work.as_ref().map(|buffer| gpu.read(buffer)).transpose()
    }

    /// The pass that makes this view's rays; uploads the view's opaque scene.
    pub(super) fn ray_pass(&self, gpu: &Gpu, view: &View) -> Result<&RayPass, RenderError> {
        let Some(distances) = view.opaque_distance() else { return Ok(&self.free_rays) };
        let pass = match self.stopped_rays.get() {
            Some(pass) => pass,
            None => {
                let pass = RayPass::stopped(gpu, &self.view, &self.rays, &self.hits)?;
                self.stopped_rays.get_or_init(|| pass)
            }
        };
        pass.stop_at(gpu, distances)?;
        Ok(pass)
    }
}

/// Layout of group 0. It has no bindings for what the specialisation leaves out.
pub fn frame_layout(gpu: &Gpu, spec: &Specialization) -> wgpu::BindGroupLayout {
    layout_of(gpu, spec.colors, spec.counting, false)
}

/// Layout of group 0 for passes that answer the rays of a [`RayBatch`](super::RayBatch), with its rays and
/// hits in place of the frame's, and at binding 6 the list of the rays to answer.
pub fn free_ray_layout(gpu: &Gpu, spec: &Specialization) -> wgpu::BindGroupLayout {
    layout_of(gpu, spec.colors, spec.counting, true)
}

fn layout_of(gpu: &Gpu, colors: bool, counting: bool, listed: bool) -> wgpu::BindGroupLayout {
    let mut bindings =
        vec![(0, Binding::Uniform), (1, Binding::Read), (2, Binding::Write), (3, Binding::Write)];
    bindings.extend(colors.then_some((4, Binding::Write)));
    bindings.extend(counting.then_some((5, Binding::Write)));
    bindings.extend(listed.then_some((6, Binding::Read)));
    bind_group_layout(gpu, "frame", &bindings)
}
