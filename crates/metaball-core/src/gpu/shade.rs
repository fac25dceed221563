//! Pictures of hits, the same for all methods.

use super::layout::{Binding, bind_group, bind_group_layout};
use super::spheres::SpherePicture;
use super::{Gpu, RenderError, Specialization, Targets, compute_pipeline, frame_layout};
use crate::{Image, Picture, Scene, Shaded, ValueRange, View, WorkKind};

/// Key of the override constant in `shaders/wgsl/shade/work.wgsl`: its `@id`.
const COUNTER: &str = "1";

/// Makes pictures of what frames found. Not part of a frame: it is not timed, and it waits.
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
            Picture::Depth => {
                let range = ValueRange::of_distances(&targets.read_hits(self.gpu)?);
                ("shade/depth", Some(range), Vec::new())
            }
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
            bind_group_layout(gpu, "picture", &[(0, Binding::Write), (1, Binding::Uniform)]),
        );
        let pipeline =
            compute_pipeline(gpu, module, module, "shade", &spec, &[&frame, &picture], constants)?;

        let (width, height) = (targets.width(), targets.height());
        let bytes = u64::from(width) * u64::from(height) * 4;
        let pixels = gpu.storage("picture", bytes, wgpu::BufferUsages::empty())?;
        let range = gpu.upload("scale of a picture", &[range], wgpu::BufferUsages::UNIFORM)?;
        gpu.checked(|| {
            let bind_group = bind_group(gpu, "picture", &picture, &[(0, &pixels), (1, &range)]);
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

    /// From 0 to what the costliest pixel counted.
    fn counts(&self, targets: &Targets, kind: WorkKind) -> Result<ValueRange, RenderError> {
        let work = targets.read_work(self.gpu)?.ok_or(RenderError::NoTarget { what: "work" })?;
        let most = work.iter().map(|work| kind.of(work)).max().unwrap_or(0);
        Ok(ValueRange { low: 0.0, high: most as f32 })
    }
}
