//! Sphere tracing by brute force.
//!
//! # Theory
//! Hart 1996, Sphere tracing: a geometric method for the antialiased ray tracing of implicit surfaces: a
//! point where the field is below T by δ is at least δ/λ away from the surface, where λ bounds the field's
//! slope in between.
//!
//! # Changes versus the paper
//! λ is not one number for the scene but the sum over the balls that a step can reach.
//!
//! # Practice
//! No structure: every step evaluates every ball, so that scenes of more than [`MOST_BALLS`] are refused.

use std::time::{Duration, Instant};

use metaball_core::Scene;
use metaball_core::gpu::{
    BuildReport, Frame, Gpu, IsoRenderer, RenderError, SceneBuffers, Shader, ShaderModule,
    Specialization, frame_layout, scene_layout,
};

/// A hit is where the field is below T by this part of T.
pub const TOLERANCE: f32 = 1e-5;

/// The most balls of a scene.
const MOST_BALLS: usize = 1_000;

/// Balls that a ray evaluates before it is undecided. Software Vulkan ends the loops of eight
/// invocations, silently, after 65,535 iterations in all.
const BUDGET: u32 = 7_000;

/// A step is no longer than this part of the smallest radius.
pub const REACH: f32 = 0.25;

const NAME: &str = "sphere-tracer";

const SHADER: ShaderModule = ShaderModule {
    name: "sphere_tracer",
    source: include_str!("sphere_tracer.wgsl"),
    is_entry: true,
};

/// The renderer.
pub struct SphereTracer {
    counting: bool,
    built: Option<Built>,
}

struct Built {
    pipeline: wgpu::ComputePipeline,
    scene: SceneBuffers,
}

impl SphereTracer {
    /// A renderer without a scene.
    pub fn new(counting: bool) -> Self {
        Self { counting, built: None }
    }
}

impl IsoRenderer for SphereTracer {
    fn name(&self) -> &'static str {
        NAME
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        self.built = None;
        if scene.len() > MOST_BALLS {
            let found = scene.len();
            let reason = format!("needed at most {MOST_BALLS} balls, found {found}");
            return Err(RenderError::Unsupported { method: NAME, reason });
        }
        let start = Instant::now();
        let spec = Specialization::of(scene, self.counting);
        let radii = scene.supports().iter().map(|support| support.radius);
        let reach = REACH * radii.fold(f32::INFINITY, f32::min).min(f32::MAX);
        let constants = [("16", reach.into()), ("17", TOLERANCE.into()), ("18", f64::from(BUDGET))];
        let groups = [&frame_layout(gpu, &spec), &scene_layout(gpu, &spec)];
        let shader = Shader::of_module(gpu, &SHADER, &spec)?;
        let pipeline = shader.compute(gpu, "trace", "trace", &spec, &groups, &constants)?;
        let pipelines = start.elapsed();
        let scene = SceneBuffers::new(gpu, scene)?;
        let bytes = scene.bytes();
        self.built = Some(Built { pipeline, scene });
        Ok(BuildReport {
            structure: Duration::ZERO,
            pipelines,
            upload_bytes: bytes,
            device_bytes: bytes,
            facts: Vec::new(),
        })
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let built = self.built.as_ref().ok_or(RenderError::NotBuilt { method: NAME })?;
        let targets = frame.targets();
        let (across, down) = targets.workgroups();
        frame.compute("trace", |pass| {
            pass.set_pipeline(&built.pipeline);
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, built.scene.bind_group(), &[]);
            pass.dispatch_workgroups(across, down, 1);
        });
        Ok(())
    }
}
