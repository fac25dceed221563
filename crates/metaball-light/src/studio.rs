//! A view with its effects on the device.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};
use metaball_core::gpu::{
    Binding, Frame, FrameReport, Gpu, IsoRenderer, RayBatch, RayQuery, RayTracer, RenderError,
    Shader, Specialization, Targets, bind_group, bind_group_layout, render_with,
};
use metaball_core::{NO_LIMIT, Scene, View};

use crate::sampling::shift;
use crate::{Effects, Environment, Film, Floor, Surface};

/// What all passes are told: WGSL's `Settings` of `light/path.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
struct Settings {
    absorption: Vec3,
    refraction: f32,
    reflectivity: f32,
    bounces: u32,
    shadows: u32,
    occlusion_rays: u32,
    occlusion_reach: f32,
    lights: u32,
    exposure: u32,
    exposures: u32,
    seed: u32,
    bands: u32,
    columns: u32,
    rows: u32,
    floor_middle: Vec3,
    floor_reach: f32,
    floor_color: Vec3,
    tile: f32,
}

/// A lamp: WGSL's `LightSource` of `light/path.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
struct LightSource {
    toward: Vec3,
    size: f32,
    color: Vec3,
    padding: u32,
}

/// A pixel's path: WGSL's `Path` of `light/path.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
struct Path {
    radiance: Vec3,
    stage: u32,
    throughput: Vec3,
    feelers: u32,
    place: Vec3,
    clearance: f32,
    normal: Vec3,
    bounces: u32,
    pending: Vec3,
    on_floor: u32,
    base: Vec3,
    doubts: u32,
}

/// A view of a scene with its light, and the film that it is exposed on. 216 bytes a pixel.
#[derive(Debug)]
pub struct Studio<'a> {
    gpu: &'a Gpu,
    view: View,
    effects: Effects,
    settings: Settings,
    targets: Targets,
    paths: RayBatch,
    feelers: RayBatch,
    uniform: wgpu::Buffer,
    path_states: wgpu::Buffer,
    film: wgpu::Buffer,
    groups: [wgpu::BindGroup; 3],
    passes: Passes,
}

/// One compute pipeline for each step of a path.
#[derive(Debug)]
struct Passes {
    start: wgpu::ComputePipeline,
    surface: wgpu::ComputePipeline,
    feel: wgpu::ComputePipeline,
    develop: wgpu::ComputePipeline,
}

impl<'a> Studio<'a> {
    /// Prepares a view. `samples` is how many will be exposed: a single one goes through the middles of
    /// pixels, several are spread over them.
    ///
    /// # Errors
    /// When the picture does not fit the adapter.
    pub fn new(
        gpu: &'a Gpu,
        scene: &Scene,
        view: &View,
        effects: Effects,
        samples: u32,
        seed: u32,
    ) -> Result<Self, RenderError> {
        let has_colors = scene.colors().is_some();
        let (width, height) = (view.width(), view.height());
        let targets = Targets::new(gpu, width, height, has_colors, false)?;
        let paths = RayBatch::new(gpu, &targets)?;
        let feelers = RayBatch::new(gpu, &targets)?;
        let none = wgpu::BufferUsages::empty();
        let settings = settings(&effects, samples, seed);
        let uniform = gpu.upload("light settings", &[settings], wgpu::BufferUsages::UNIFORM)?;
        let lights: Vec<_> = effects.lamps.iter().map(LightSource::new).collect();
        let lights = gpu.upload("lamps", &lights, none)?;
        let pixels = view.pixels() as u64;
        let path_states = gpu.storage("paths of light", pixels * size_of::<Path>() as u64, none)?;
        let film = gpu.storage("film", pixels * size_of::<Vec4>() as u64, none)?;
        let panorama = match &effects.environment {
            Environment::Sky => None,
            Environment::Panorama(panorama) => {
                Some(gpu.upload("panorama", panorama.light(), none)?)
            }
        };

        let mut in_view = vec![
            (0, Binding::Uniform, targets.view()),
            (1, Binding::Write, paths.rays()),
            (2, Binding::Write, paths.hits()),
            (6, Binding::Read, paths.list()),
        ];
        in_view.extend(paths.colors().map(|colors| (4, Binding::Write, colors)));
        let of_feelers = vec![
            (0, Binding::Write, feelers.rays()),
            (1, Binding::Write, feelers.hits()),
            (2, Binding::Read, feelers.list()),
        ];
        let mut of_light = vec![
            (0, Binding::Uniform, &uniform),
            (1, Binding::Read, &lights),
            (2, Binding::Write, &path_states),
            (3, Binding::Write, &film),
        ];
        of_light.extend(panorama.as_ref().map(|image| (4, Binding::Read, image)));
        let bound = [("paths", in_view), ("feelers", of_feelers), ("light", of_light)];
        let layouts = bound.each_ref().map(|(label, buffers)| {
            let bindings: Vec<_> = buffers.iter().map(|&(at, kind, _)| (at, kind)).collect();
            bind_group_layout(gpu, label, &bindings)
        });
        let groups = [0, 1, 2].map(|index: usize| {
            let (label, buffers) = &bound[index];
            let buffers: Vec<_> = buffers.iter().map(|&(at, _, buffer)| (at, buffer)).collect();
            bind_group(gpu, label, &layouts[index], &buffers)
        });
        let spec = Specialization { colors: has_colors, ..Specialization::without_balls() };
        let spec = spec.choosing(match effects.environment {
            Environment::Sky => &["light/sky"],
            Environment::Panorama(_) => &["light/image"],
        });
        let passes = Passes::new(gpu, &spec, &layouts.each_ref())?;
        Ok(Self {
            gpu,
            view: view.clone(),
            effects,
            settings,
            targets,
            paths,
            feelers,
            uniform,
            path_states,
            film,
            groups: gpu.checked(|| groups)?,
            passes,
        })
    }

    /// Begins a new picture from another place, with the same light.
    ///
    /// # Errors
    /// When the view is of another size, or the device fails.
    pub fn turn_to(&mut self, view: &View) -> Result<(), RenderError> {
        let needed = (self.view.width(), self.view.height());
        let found = (view.width(), view.height());
        if needed != found {
            return Err(RenderError::ViewSize { needed, found });
        }
        let gpu = self.gpu;
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.clear_buffer(&self.film, 0, None);
            gpu.queue.submit([encoder.finish()]);
        })?;
        self.view = view.clone();
        self.settings.exposure = 0;
        Ok(())
    }

    /// Follows one more path a pixel through the scene that the renderer has built, and adds it to the
    /// film.
    ///
    /// A method that follows no rays but the view's own is enough for effects that
    /// [end at the first surface](Effects::end_at_first_surface).
    ///
    /// # Errors
    /// When the method cannot follow the rays that the effects need, and whatever stops it.
    pub fn expose(&mut self, renderer: &mut dyn IsoRenderer) -> Result<FrameReport, RenderError> {
        let gpu = self.gpu;
        let (mut settings, mut view) = (self.settings, self.view.clone());
        let follows = self.is_followed_by(renderer);
        if !follows && self.effects.end_at_first_surface() && settings.exposures > 1 {
            // The method's rays go through the middles of pixels: the camera is turned in their place.
            let (right, up) = shift(settings.exposure, settings.seed);
            let pixel = 2.0 * view.camera().half_height() / view.height() as f32;
            view = view.with_camera(view.camera().turned(pixel * right, pixel * up));
            settings.exposures = 1;
        }
        gpu.checked(|| gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&settings)))?;
        let report = render_with(gpu, renderer, &self.targets, &view, |renderer, frame| {
            if follows { self.encode(renderer, frame) } else { self.encode_first(renderer, frame) }
        })?;
        // What is added is a whole sample: an incomplete frame has been drawn again.
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.record(&mut pass, &self.passes.develop);
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
        })?;
        self.settings.exposure += 1;
        Ok(report)
    }

    /// The mean of the samples so far; black before the first.
    ///
    /// # Errors
    /// When the device fails.
    pub fn film(&self) -> Result<Film, RenderError> {
        let sums = self.gpu.read::<Vec4>(&self.film)?;
        let light = sums.iter().map(|sum| sum.truncate() / sum.w.max(1.0)).collect();
        Ok(Film { width: self.view.width(), height: self.view.height(), light })
    }

    /// Rays of the last sample that the method could not answer, to the last float.
    ///
    /// # Errors
    /// When the device fails.
    pub fn doubts(&self) -> Result<u64, RenderError> {
        let paths = self.gpu.read::<Path>(&self.path_states)?;
        Ok(paths.iter().map(|path| u64::from(path.doubts)).sum())
    }

    /// The last ray of each path, with its answer.
    pub fn last_rays(&self) -> &RayBatch {
        &self.paths
    }

    /// The last ray of each path that felt for light, with its answer.
    pub fn last_feelers(&self) -> &RayBatch {
        &self.feelers
    }

    /// Whether the method answers all that the effects ask along rays.
    fn is_followed_by(&self, renderer: &mut dyn IsoRenderer) -> bool {
        let answered = |tracer: &mut dyn RayTracer| {
            self.effects.questions().iter().all(|&question| tracer.answers(question))
        };
        renderer.ray_tracer().is_some_and(answered)
    }

    /// Paths of one surface, which the method finds along the view's own rays.
    fn encode_first(
        &self,
        renderer: &mut dyn IsoRenderer,
        frame: &mut Frame<'_>,
    ) -> Result<(), RenderError> {
        if !self.effects.end_at_first_surface() {
            return Err(self.refusal(renderer.name()));
        }
        renderer.encode(frame)?;
        frame.compute("light start", |pass| self.record(pass, &self.passes.start));
        let (targets, paths) = (&self.targets, &self.paths);
        let hits = paths.hits();
        frame.encoder().copy_buffer_to_buffer(targets.hits(), 0, hits, 0, hits.size());
        if let (Some(found), Some(colors)) = (targets.colors(), paths.colors()) {
            frame.encoder().copy_buffer_to_buffer(found, 0, colors, 0, colors.size());
        }
        self.paths.encode_list(frame, RayQuery::FirstHit, "light start")?;
        self.meet_surface(frame);
        Ok(())
    }

    fn encode(
        &self,
        renderer: &mut dyn IsoRenderer,
        frame: &mut Frame<'_>,
    ) -> Result<(), RenderError> {
        let method = renderer.name();
        let needed = self.effects.questions();
        let tracer = renderer.ray_tracer().ok_or_else(|| self.refusal(method))?;
        let own = self.settings.lights * self.settings.shadows + self.settings.occlusion_rays;
        frame.compute("light start", |pass| self.record(pass, &self.passes.start));
        for _ in 0..=self.effects.bounces {
            tracer.encode_answers(frame, &self.paths, RayQuery::FirstHit)?;
            self.meet_surface(frame);
            if needed.contains(&RayQuery::Exit) {
                tracer.encode_answers(frame, &self.paths, RayQuery::Exit)?;
                self.meet_surface(frame);
            }
            if needed.contains(&RayQuery::AnyHit) {
                for _ in 0..own {
                    tracer.encode_answers(frame, &self.feelers, RayQuery::AnyHit)?;
                    frame.compute("light feel", |pass| {
                        self.record_along(pass, &self.passes.feel, &self.feelers);
                    });
                }
            }
        }
        Ok(())
    }

    /// Takes up the answers to the paths' own rays.
    fn meet_surface(&self, frame: &mut Frame<'_>) {
        frame.compute("light surface", |pass| {
            self.record_along(pass, &self.passes.surface, &self.paths);
        });
    }

    fn refusal(&self, method: &'static str) -> RenderError {
        let reason = format!(
            "needed answers to rays that ask {:?} for these effects; the method has none",
            self.effects.questions()
        );
        RenderError::Unsupported { method, reason }
    }

    /// Over the picture.
    fn record(&self, pass: &mut wgpu::ComputePass<'_>, pipeline: &wgpu::ComputePipeline) {
        let (across, down) = self.targets.workgroups();
        self.bind(pass, pipeline);
        pass.dispatch_workgroups(across, down, 1);
    }

    /// Along the rays that have just been answered.
    fn record_along(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        pipeline: &wgpu::ComputePipeline,
        answered: &RayBatch,
    ) {
        self.bind(pass, pipeline);
        pass.dispatch_workgroups_indirect(answered.list(), 0);
    }

    fn bind(&self, pass: &mut wgpu::ComputePass<'_>, pipeline: &wgpu::ComputePipeline) {
        pass.set_pipeline(pipeline);
        for (index, group) in self.groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
    }
}

impl Passes {
    fn new(
        gpu: &Gpu,
        spec: &Specialization,
        layouts: &[&wgpu::BindGroupLayout],
    ) -> Result<Self, RenderError> {
        let pipeline = |module, entry| {
            Shader::new(gpu, module, module, spec)?.compute(gpu, module, entry, spec, layouts, &[])
        };
        Ok(Self {
            start: pipeline("light/start", "start_paths")?,
            surface: pipeline("light/surface", "meet_surface")?,
            feel: pipeline("light/feel", "feel")?,
            develop: pipeline("light/develop", "add_to_film")?,
        })
    }
}

impl Effects {
    /// What rays must be able to ask for these effects.
    fn questions(&self) -> Vec<RayQuery> {
        match self.surface {
            Surface::Fluid { .. } => vec![RayQuery::FirstHit, RayQuery::Exit],
            Surface::Opaque { .. } => {
                let feeler = self.feel().then_some(RayQuery::AnyHit);
                [RayQuery::FirstHit].into_iter().chain(feeler).collect()
            }
        }
    }
}

impl LightSource {
    fn new(lamp: &crate::Lamp) -> Self {
        Self {
            toward: lamp.toward.normalize_or(Vec3::Y),
            size: (0.5 * lamp.diameter).clamp(0.0, 90.0).to_radians().sin(),
            color: lamp.color,
            padding: 0,
        }
    }
}

fn settings(effects: &Effects, samples: u32, seed: u32) -> Settings {
    let (reflectivity, refraction, absorption) = match effects.surface {
        Surface::Opaque { reflectivity } => (reflectivity, 0.0, Vec3::ZERO),
        Surface::Fluid { refraction, absorption } => (0.0, refraction, absorption),
    };
    let (columns, rows) = match &effects.environment {
        Environment::Sky => (0, 0),
        Environment::Panorama(panorama) => panorama.size(),
    };
    let none = Floor { middle: Vec3::ZERO, reach: 0.0, color: Vec3::ZERO, tile: 0.0 };
    let floor = effects.floor.unwrap_or(none);
    Settings {
        absorption,
        refraction,
        reflectivity,
        bounces: effects.bounces,
        shadows: u32::from(effects.shadows),
        occlusion_rays: effects.occlusion.map_or(0, |occlusion| occlusion.rays),
        occlusion_reach: effects.occlusion.map_or(NO_LIMIT, |occlusion| occlusion.reach),
        lights: effects.lamps.len() as u32,
        exposure: 0,
        exposures: samples,
        seed,
        bands: effects.bands,
        columns,
        rows,
        floor_middle: floor.middle,
        floor_reach: floor.reach,
        floor_color: floor.color,
        tile: floor.tile,
    }
}

#[cfg(test)]
mod tests {
    use metaball_shaders::{KernelModule, Variant, compose, host_layout, struct_layout};

    use super::*;

    #[test]
    fn host_structs_are_their_wgsl_twins() {
        let variant = Variant {
            kernel: KernelModule::Power,
            radii: false,
            strengths: false,
            colors: false,
            counting: false,
            chosen: &["light/image"],
        };
        let module = compose("light/surface", &variant).expect("composes");
        let twin = |name| struct_layout(&module, name).expect("used by the shader");
        let settings = host_layout!(Settings {
            absorption,
            refraction,
            reflectivity,
            bounces,
            shadows,
            occlusion_rays,
            occlusion_reach,
            lights,
            exposure,
            exposures,
            seed,
            bands,
            columns,
            rows,
            floor_middle,
            floor_reach,
            floor_color,
            tile,
        });
        assert_eq!(settings, twin("Settings"));
        assert_eq!(host_layout!(LightSource { toward, size, color, padding }), twin("LightSource"));
        let path = host_layout!(Path {
            radiance,
            stage,
            throughput,
            feelers,
            place,
            clearance,
            normal,
            bounces,
            pending,
            on_floor,
            base,
            doubts,
        });
        assert_eq!(path, twin("Path"));
    }
}
