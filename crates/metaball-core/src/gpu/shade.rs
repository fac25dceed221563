//! Pictures of what a frame found, the same for all methods.

use bytemuck::{Pod, Zeroable};

use super::layout::{Binding, group, layout};
use super::spheres::SpherePicture;
use super::{Gpu, RenderError, Specialization, Targets, WorkKind, compute_pipeline, frame_layout};
use crate::{Scene, View};

/// What to show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Picture {
    /// The lit surface, in the blended colours where the scene has colours.
    Phong,
    /// Normals as colours: red to the right, green upwards, blue towards the eye.
    Normal,
    /// Distances as grey, white where the surface is nearest.
    Depth,
    /// The surface's colour without light.
    Color,
    /// The balls alone: each as the sphere in which it reaches the threshold by itself (Kanamori et
    /// al. 2008, figure 11 left). Needs no hits.
    Spheres,
    /// What each pixel cost, as a heat map from 0 to the costliest pixel.
    Work(WorkKind),
}

/// A picture, eight bits a channel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Red, green, blue (sRGB-encoded) and 255, row by row from the top left.
    pub rgba: Vec<u8>,
}

/// A picture and its scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaded {
    /// The picture.
    pub image: Image,
    /// What the ends of the scale stand for: scene units for [`Picture::Depth`], a count for
    /// [`Picture::Work`], nothing for the others.
    pub range: Option<ValueRange>,
}

/// Ends of a scale: WGSL's `ValueRange` of `shade/picture.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct ValueRange {
    /// The least value.
    pub low: f32,
    /// The greatest value.
    pub high: f32,
}

/// Key of the override constant in `shade/work.wgsl`: its `@id`.
const COUNTER: &str = "1";

/// Makes pictures. Not part of a frame: nobody times it, and it waits for what it draws.
#[derive(Debug)]
pub struct Shading<'a> {
    gpu: &'a Gpu,
}

impl<'a> Shading<'a> {
    /// Pictures on this device.
    pub fn new(gpu: &'a Gpu) -> Self {
        Self { gpu }
    }

    /// A picture of the last frame drawn to the targets; `scene` and `view` are that frame's.
    ///
    /// # Errors
    /// When the targets were made without work counters and the picture is of them, or the device
    /// fails.
    pub fn draw(
        &self,
        targets: &Targets,
        view: &View,
        scene: &Scene,
        picture: Picture,
    ) -> Result<Shaded, RenderError> {
        let (module, range, constants) = match picture {
            Picture::Spheres => {
                let image = SpherePicture::new(self.gpu, scene)?.draw(self.gpu, targets, view)?;
                return Ok(Shaded { image, range: None });
            }
            Picture::Phong => ("shade/phong", None, Vec::new()),
            Picture::Normal => ("shade/normal", None, Vec::new()),
            Picture::Color => ("shade/color", None, Vec::new()),
            Picture::Depth => ("shade/depth", Some(self.depths(targets)?), Vec::new()),
            Picture::Work(kind) => {
                let constants = vec![(COUNTER, f64::from(kind as u32))];
                ("shade/work", Some(self.counts(targets, kind)?), constants)
            }
        };
        let image = self.shade(targets, module, range.unwrap_or_default(), &constants)?;
        Ok(Shaded { image, range })
    }

    /// One pass over the picture.
    fn shade(
        &self,
        targets: &Targets,
        module: &str,
        range: ValueRange,
        constants: &[(&str, f64)],
    ) -> Result<Image, RenderError> {
        let gpu = self.gpu;
        let spec = Specialization {
            colors: targets.colors().is_some(),
            counting: targets.work().is_some(),
            ..Specialization::without_balls()
        };
        let (frame, picture) = (
            frame_layout(gpu, &spec),
            layout(gpu, "picture", &[(0, Binding::Write), (1, Binding::Uniform)]),
        );
        let pipeline =
            compute_pipeline(gpu, module, module, "shade", &spec, &[&frame, &picture], constants)?;

        let (width, height) = (targets.width(), targets.height());
        let bytes = u64::from(width) * u64::from(height) * 4;
        let pixels = gpu.storage("picture", bytes, wgpu::BufferUsages::empty())?;
        let range = gpu.upload("scale of a picture", &[range], wgpu::BufferUsages::UNIFORM)?;
        gpu.checked(|| {
            let bind_group = group(gpu, "picture", &picture, &[(0, &pixels), (1, &range)]);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut pass = encoder.begin_compute_pass(&Default::default());
            let (across, down) = targets.workgroups();
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, &bind_group, &[]);
            pass.dispatch_workgroups(across, down, 1);
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
        })?;
        Ok(Image { width, height, rgba: gpu.read(&pixels)? })
    }

    /// Distances of the nearest and the farthest hit; 0 and 0 where there is none.
    fn depths(&self, targets: &Targets) -> Result<ValueRange, RenderError> {
        let hits = targets.read_hits(self.gpu)?;
        let depths = || hits.iter().filter(|hit| hit.is_hit()).map(|hit| hit.t);
        Ok(ValueRange {
            low: depths().reduce(f32::min).unwrap_or(0.0),
            high: depths().reduce(f32::max).unwrap_or(0.0),
        })
    }

    /// From 0 to what the costliest pixel counted.
    fn counts(&self, targets: &Targets, kind: WorkKind) -> Result<ValueRange, RenderError> {
        let work = targets.read_work(self.gpu)?.ok_or(RenderError::NoTarget { what: "work" })?;
        let most = work.iter().map(|work| kind.of(work)).max().unwrap_or(0);
        Ok(ValueRange { low: 0.0, high: most as f32 })
    }
}
