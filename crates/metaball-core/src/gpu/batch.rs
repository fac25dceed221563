//! Arbitrary rays, and the methods that can follow them.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::layout::group;
use super::ray_list::RayList;
use super::{Frame, Gpu, RenderError, Specialization, Targets, free_ray_layout};
use crate::{Color, Hit, PackedHit, Ray};

/// What a ray asks of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Question {
    /// The smallest t at which the field rises to T; a start at T or above is
    /// [`Inside`](crate::Verdict::Inside).
    FirstHit = 1,
    /// Whether the field is T or more anywhere on the ray: shadow rays. Any such t will do, and no
    /// normal is found.
    AnyHit = 2,
    /// For a ray that starts in the solid, the smallest t at which the field falls below T; a start
    /// below T is [`Inside`](crate::Verdict::Inside) the space that is sought, at t = 0.
    Exit = 3,
}

impl Question {
    /// Every question, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::FirstHit, Self::AnyHit, Self::Exit];

    /// The override constant, by its `@id`, that tells a pass of `ray/list.wgsl` or `ray/free.wgsl` the
    /// question it is for.
    pub const CONSTANT: &str = "2";
}

/// A ray of a batch as shaders see it: WGSL's `FreeRay` of `ray/record.wgsl`, 32 bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FreeRay {
    /// Start, world space, scene units.
    pub origin: Vec3,
    /// The ray's end, or [`NO_LIMIT`](crate::NO_LIMIT).
    pub t_max: f32,
    /// Direction, unit to rounding.
    pub direction: Vec3,
    /// Number of the [`Question`]; 0 for a ray that asks nothing and is not looked at. Plus
    /// [`FreeRay::ANSWERED`] once whoever asked has taken up the answer.
    pub question: u32,
}

impl FreeRay {
    /// Added to a question that is answered: the ray is not looked at again.
    pub const ANSWERED: u32 = 1 << 8;

    /// A ray that asks nothing.
    pub const NONE: Self =
        Self { origin: Vec3::ZERO, t_max: 0.0, direction: Vec3::ZERO, question: 0 };

    /// The ray with its question.
    pub fn new(ray: &Ray, question: Question) -> Self {
        let Ray { origin, direction, t_max } = *ray;
        Self { origin, t_max, direction, question: question as u32 }
    }

    /// The points that it asks about.
    pub fn ray(&self) -> Ray {
        Ray { origin: self.origin, direction: self.direction, t_max: self.t_max }
    }

    /// What it asks, or has asked; `None` when nothing.
    pub fn question(&self) -> Option<Question> {
        let number = self.question & !Self::ANSWERED;
        Question::ALL.into_iter().find(|question| *question as u32 == number)
    }
}

/// One free ray for each pixel of some targets, and room for its answer. Whoever fills the rays
/// decides what they are. Answers count in the status of the targets' frame, and work in the
/// targets' counters. 52 bytes a pixel; 4 more with colours.
#[derive(Debug)]
pub struct RayBatch {
    rays: wgpu::Buffer,
    hits: wgpu::Buffer,
    colors: Option<wgpu::Buffer>,
    list: RayList,
    bind_group: wgpu::BindGroup,
}

impl RayBatch {
    /// Room for a ray a pixel.
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

        let list = RayList::new(gpu, pixels, &targets.view, &rays)?;

        let mut buffers = vec![(0, &targets.view), (1, &rays), (2, &hits), (3, &targets.status)];
        buffers.extend(colors.as_ref().map(|buffer| (4, buffer)));
        buffers.extend(targets.work().map(|buffer| (5, buffer)));
        buffers.push((6, list.buffer()));
        let spec = Specialization {
            colors: has_colors,
            counting: targets.work().is_some(),
            ..Specialization::without_balls()
        };
        let layout = free_ray_layout(gpu, &spec);
        let bind_group = gpu.checked(|| group(gpu, "free rays", &layout, &buffers))?;
        Ok(Self { rays, hits, colors, list, bind_group })
    }

    /// Group 0 of the passes that answer, laid out as [`free_ray_layout`].
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// Records the pass that lists the rays which ask this question, so that who answers them, and who takes
    /// up the answers, has nothing but work side by side.
    ///
    /// # Errors
    /// When the pass cannot be made.
    pub fn encode_list(
        &self,
        frame: &mut Frame<'_>,
        question: Question,
        label: &'static str,
    ) -> Result<(), RenderError> {
        self.list.encode(frame, question, label)
    }

    /// The last list, WGSL's `Listed` of `ray/listed.wgsl`. Begins with twelve bytes for an indirect dispatch
    /// along it, 64 rays a workgroup.
    pub fn list(&self) -> &wgpu::Buffer {
        self.list.buffer()
    }

    /// One [`FreeRay`] a pixel, to be written.
    pub fn rays(&self) -> &wgpu::Buffer {
        &self.rays
    }

    /// One [`PackedHit`] a pixel: the last answer.
    pub fn hits(&self) -> &wgpu::Buffer {
        &self.hits
    }

    /// One [`Color`] a pixel, where the targets have colours: at first hits and exits.
    pub fn colors(&self) -> Option<&wgpu::Buffer> {
        self.colors.as_ref()
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        let colors = self.colors.as_ref().map_or(0, wgpu::Buffer::size);
        self.rays.size() + self.hits.size() + self.list.buffer().size() + colors
    }

    /// Sends rays from the host, row by row from the top left; what is left of the batch asks nothing.
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

    /// The rays, bit for bit as the shaders see them.
    ///
    /// # Errors
    /// When the device fails.
    pub fn read_rays(&self, gpu: &Gpu) -> Result<Vec<FreeRay>, RenderError> {
        gpu.read(&self.rays)
    }

    /// The last answers; meaningless at rays that asked nothing.
    ///
    /// # Errors
    /// When the device fails.
    pub fn read_hits(&self, gpu: &Gpu) -> Result<Vec<Hit>, RenderError> {
        Ok(gpu.read::<PackedHit>(&self.hits)?.into_iter().map(PackedHit::unpack).collect())
    }
}

/// What a method can do beside primary rays: follow any ray. Effects are made of it.
pub trait RayTracer {
    /// Whether the method answers such questions.
    fn answers(&self, question: Question) -> bool;

    /// Records the passes that list the rays of a batch that ask this question
    /// ([`RayBatch::encode_list`]) and answer them, and leave the others alone. The batch is one of the frame's
    /// targets. An answer that a further ray may start from tells its clearance
    /// ([`PackedHit::clearance`]).
    ///
    /// # Errors
    /// When the method does not answer such questions, or a pass cannot be recorded.
    fn encode_answers(
        &mut self,
        frame: &mut Frame<'_>,
        batch: &RayBatch,
        question: Question,
    ) -> Result<(), RenderError>;
}
