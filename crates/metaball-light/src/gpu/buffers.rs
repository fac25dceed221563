//! What a picture keeps on the adapter, and where shaders find it.

use glam::Vec4;
use metaball_core::gpu::{Binding, Gpu, RayBatch, RenderError, Targets};

use crate::path::{Lamp, Path, Settings};
use crate::{Effects, Environment};

/// The buffers of a picture.
#[derive(Debug)]
pub(crate) struct Buffers {
    pub(crate) path_rays: RayBatch,
    pub(crate) shadow_rays: RayBatch,
    pub(crate) settings: wgpu::Buffer,
    lamps: wgpu::Buffer,
    pub(crate) paths: wgpu::Buffer,
    pub(crate) film: wgpu::Buffer,
    panorama: Option<wgpu::Buffer>,
}

/// The binding, what it is, and its buffer.
type Bound<'a> = (u32, Binding, &'a wgpu::Buffer);

impl Buffers {
    pub(crate) fn new(
        gpu: &Gpu,
        targets: &Targets,
        effects: &Effects,
        settings: Settings,
    ) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        let pixels = u64::from(targets.width()) * u64::from(targets.height());
        let one_a_pixel = |what, size: usize| gpu.storage(what, pixels * size as u64, none);
        let lamps: Vec<_> = effects.lamps.iter().map(Lamp::new).collect();
        Ok(Self {
            path_rays: RayBatch::new(gpu, targets)?,
            shadow_rays: RayBatch::new(gpu, targets)?,
            settings: gpu.upload("light settings", &[settings], wgpu::BufferUsages::UNIFORM)?,
            lamps: gpu.upload("lamps", &lamps, none)?,
            paths: one_a_pixel("paths of light", size_of::<Path>())?,
            film: one_a_pixel("film", size_of::<Vec4>())?,
            panorama: match &effects.environment {
                Environment::Sky => None,
                Environment::Panorama(panorama) => {
                    Some(gpu.upload("panorama", panorama.light(), none)?)
                }
            },
        })
    }

    /// Group 0: the view and the paths' own rays, as shaders find a frame and its hits.
    pub(crate) fn of_paths<'a>(&'a self, targets: &'a Targets) -> Vec<Bound<'a>> {
        let rays = &self.path_rays;
        let mut bound = vec![
            (0, Binding::Uniform, targets.view()),
            (1, Binding::Write, rays.rays()),
            (2, Binding::Write, rays.hits()),
            (6, Binding::Read, rays.list().buffer()),
        ];
        bound.extend(rays.colors().map(|colors| (4, Binding::Write, colors)));
        bound
    }

    /// Group 1: shadow and occlusion rays.
    pub(crate) fn of_shadow_rays(&self) -> Vec<Bound<'_>> {
        let rays = &self.shadow_rays;
        vec![
            (0, Binding::Write, rays.rays()),
            (1, Binding::Write, rays.hits()),
            (2, Binding::Read, rays.list().buffer()),
        ]
    }

    /// Group 2: what only effects know.
    pub(crate) fn of_effects(&self) -> Vec<Bound<'_>> {
        let mut bound = vec![
            (0, Binding::Uniform, &self.settings),
            (1, Binding::Read, &self.lamps),
            (2, Binding::Write, &self.paths),
            (3, Binding::Write, &self.film),
        ];
        bound.extend(self.panorama.as_ref().map(|image| (4, Binding::Read, image)));
        bound
    }
}
