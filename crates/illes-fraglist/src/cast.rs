//! The passes after the gathering: each ray is followed along its list.

use metaball_core::Kernel;
use metaball_core::gpu::{Frame, Gpu, RenderError, Shader, Specialization};

use crate::balls::Balls;
use crate::canvas::Canvas;
use crate::layouts::Layouts;
use crate::options::{Options, exact_degree};

/// Key of the override constant in `shaders/wgsl/illes_fraglist/budget.wgsl`: its `@id`.
const BUDGET: &str = "48";

/// `shaders/wgsl/illes_fraglist/begin.wgsl` and `shaders/wgsl/illes_fraglist/cast.wgsl`.
pub(crate) struct CastPasses {
    begin: wgpu::ComputePipeline,
    cast: wgpu::ComputePipeline,
}

impl CastPasses {
    pub(crate) fn new(
        gpu: &Gpu,
        spec: &Specialization,
        layouts: &Layouts,
        options: &Options,
        budget: Option<u32>,
    ) -> Result<Self, RenderError> {
        let Layouts { frame, scene, balls, lists, .. } = layouts;
        let groups = [frame, scene, balls, lists];
        let shader = Shader::new(gpu, "illes cast", "illes_fraglist/cast", spec)?;
        let mut constants = constants(spec.kernel, options);
        constants.extend(budget.map(|iterations| (BUDGET, f64::from(iterations))));
        let begin = Shader::new(gpu, "illes begin", "illes_fraglist/begin", spec)?;
        Ok(Self {
            begin: begin.compute(gpu, "illes begin", "begin_rays", spec, &groups, &[])?,
            cast: shader.compute(gpu, "illes cast", "cast_rays", spec, &groups, &constants)?,
        })
    }

    /// The pass `cast`, which begins all rays and casts those that meet balls, and `resumes` passes `resume`,
    /// each over the rays that wait after the one before it.
    pub(crate) fn record(
        &self,
        frame: &mut Frame<'_>,
        balls: &Balls,
        canvas: &Canvas,
        resumes: u32,
    ) {
        let targets = frame.targets();
        let bind = |pass: &mut wgpu::ComputePass<'_>, group: &wgpu::BindGroup| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, balls.scene.bind_group(), &[]);
            pass.set_bind_group(2, &balls.bind_group, &[]);
            pass.set_bind_group(3, group, &[]);
        };
        let (columns, rows) = targets.workgroups();
        let [first, second] = &canvas.turns;
        first.waiting.clear(frame.encoder());
        second.waiting.clear(frame.encoder());
        frame.compute("cast", |pass| {
            pass.set_pipeline(&self.begin);
            bind(pass, &first.bind_group);
            pass.dispatch_workgroups(columns, rows, 1);
            pass.set_pipeline(&self.cast);
            bind(pass, &second.bind_group);
            first.waiting.dispatch(pass);
        });
        let turns = [(second, first), (first, second)].into_iter().cycle();
        for (before, now) in turns.take(resumes as usize) {
            now.waiting.clear(frame.encoder());
            frame.compute("resume", |pass| {
                pass.set_pipeline(&self.cast);
                bind(pass, &now.bind_group);
                before.waiting.dispatch(pass);
            });
        }
    }
}

/// Override constants by id: of `shaders/wgsl/illes_fraglist/records.wgsl`, and for exact pieces of
/// `shaders/wgsl/illes_fraglist/polynomial.wgsl`.
fn constants(kernel: Kernel, options: &Options) -> Vec<(&'static str, f64)> {
    let mut constants = vec![("49", f64::from(options.capacity()))];
    if let (true, Some(degree)) = (options.piece.is_exact(), exact_degree(kernel)) {
        let weight = |power: usize| {
            kernel.coefficients().and_then(|all| all.get(power)).copied().unwrap_or(0.0)
        };
        let weights = [("50", weight(1)), ("51", weight(2)), ("52", weight(3))];
        constants.extend(weights);
        constants.push(("53", f64::from(degree)));
    }
    constants
}
