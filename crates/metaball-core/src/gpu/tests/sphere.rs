//! A renderer of one ball in closed form.

use glam::Vec3;
use metaball_shaders::Module;

use crate::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RenderError, SceneBuffers, Shader,
    Specialization, Targets, frame_layout, render, scene_layout,
};
use crate::{Camera, Color, Hit, Kernel, Metaball, Scene, View};

const MODULE: Module =
    Module { name: "sphere", source: include_str!("sphere.wgsl"), is_entry: true };

/// Draws ball 0, as many rows of the picture as its capacity allows, which may grow.
pub(super) struct Sphere {
    pub(super) counting: bool,
    pub(super) capacity: u32,
    pub(super) can_grow: bool,
    /// −1 turns all normals over.
    pub(super) outward: f64,
    pub(super) built: Option<Built>,
}

pub(super) struct Built {
    scene: Scene,
    buffers: SceneBuffers,
    pipeline: wgpu::ComputePipeline,
}

impl Sphere {
    pub(super) fn new() -> Self {
        Self { counting: false, capacity: u32::MAX, can_grow: true, outward: 1.0, built: None }
    }
}

impl IsoRenderer for Sphere {
    fn name(&self) -> &'static str {
        "sphere"
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        let spec = Specialization::of(scene, self.counting);
        let layouts = [&frame_layout(gpu, &spec), &scene_layout(gpu, &spec)];
        let core_radius = match scene.len() {
            0 => None,
            _ => scene.kernel().core_radius(&scene.ball(0), scene.threshold()),
        };
        let constants = [
            ("16", core_radius.unwrap_or(0.0)),
            ("17", f64::from(self.capacity)),
            ("18", self.outward),
        ];
        let shader = Shader::of_module(gpu, &MODULE, &spec)?;
        let pipeline = shader.compute(gpu, "sphere", "trace", &spec, &layouts, &constants)?;
        let buffers = SceneBuffers::new(gpu, scene)?;
        self.built = Some(Built { scene: scene.clone(), buffers, pipeline });
        Ok(BuildReport::default())
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let built = self.built.as_ref().ok_or(RenderError::NotBuilt { method: "sphere" })?;
        let targets = frame.targets();
        frame.compute("trace", |pass| {
            let (across, down) = targets.workgroups();
            pass.set_pipeline(&built.pipeline);
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, built.buffers.bind_group(), &[]);
            pass.dispatch_workgroups(across, down, 1);
        });
        Ok(())
    }

    fn grow(&mut self, gpu: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        if !self.can_grow {
            return Ok(false);
        }
        self.capacity = status.needed[1];
        let scene = self.built.as_ref().expect("a frame was drawn").scene.clone();
        self.build(gpu, &scene)?;
        Ok(true)
    }
}

pub(super) const WIDTH: u32 = 45;
pub(super) const HEIGHT: u32 = 30;

/// A ball of radius 2 at the origin whose core, under Wyvill's kernel and threshold 1/2, is the unit
/// sphere, seen from a distance of 5 on a picture of odd size.
pub(super) fn scene() -> Scene {
    Scene::new([Metaball::new(Vec3::ZERO, 2.0)], Kernel::Wyvill, 0.5).expect("legal")
}

pub(super) fn colored() -> Scene {
    scene().with_colors(vec![Color::srgb(200, 40, 10)]).expect("one for the ball")
}

pub(super) fn view_from(distance: f32) -> View {
    let eye = distance * Vec3::new(0.6, 0.48, 0.64);
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 38.0).expect("legal");
    View::new(camera, WIDTH, HEIGHT).expect("legal")
}

pub(super) fn view() -> View {
    view_from(5.0)
}

pub(super) fn targets(gpu: &Gpu, scene: &Scene, counting: bool) -> Targets {
    let colors = scene.colors().is_some();
    Targets::new(gpu, WIDTH, HEIGHT, colors, counting).expect("small enough")
}

/// Hits of the view by the renderer.
pub(super) fn hits(gpu: &Gpu, renderer: &mut Sphere, scene: &Scene, view: &View) -> Vec<Hit> {
    let targets = targets(gpu, scene, renderer.counting);
    renderer.build(gpu, scene).expect("builds");
    render(gpu, renderer, &targets, view).expect("renders");
    targets.read_hits(gpu).expect("reads")
}
