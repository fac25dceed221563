//! From a scene to the pipelines that are specialised for it.

use metaball_shaders::{KernelModule, Module, Variant, code_size, compose, compose_module, naga};

use super::shader_checks::{foreign_module, own_module};
use super::{Gpu, RenderError};
use crate::{Kernel, KernelForm, Scene};

/// Key of the override constant in `shaders/wgsl/exponent/compiled.wgsl`: its `@id`.
///
/// Composition changes the names of constants, so they are set by id. Ids below 16 belong to the
/// shared modules; methods number theirs from 16.
const EXPONENT: &str = "0";

/// The same in `shaders/wgsl/kernel/gaussian.wgsl`: how far down the cut is, and the factor of the rest.
const GAUSSIAN: [&str; 2] = ["4", "5"];

/// The same in `shaders/wgsl/support/uniform.wgsl`.
const RADIUS: &str = "3";

/// All that shaders are specialised for. Equal specialisations can share pipelines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Specialization {
    /// Falloff of the balls.
    pub kernel: Kernel,
    /// How much of the kernel is compiled in.
    pub kernel_form: KernelForm,
    /// Bits of the support radius that all balls have; `None` where they have radii of their own.
    pub radius_bits: Option<u32>,
    /// Whether balls have strengths of their own.
    pub strengths: bool,
    /// Whether balls have colours.
    pub colors: bool,
    /// Whether work is counted; never while timing.
    pub counting: bool,
    /// Names of the modules that a method chooses where several define one import path, such as
    /// `ray/primary`.
    pub chosen: &'static [&'static str],
}

impl Specialization {
    /// What this scene needs, and no more. `counting` adds work counters.
    pub fn of(scene: &Scene, counting: bool) -> Self {
        Self {
            kernel: scene.kernel(),
            kernel_form: scene.kernel_form(),
            radius_bits: scene.common_radius().map(f32::to_bits),
            strengths: scene.strengths().is_some(),
            colors: scene.colors().is_some(),
            counting,
            chosen: &[],
        }
    }

    /// For passes that read no ball.
    pub fn without_balls() -> Self {
        Self {
            kernel: Kernel::QUARTIC,
            kernel_form: KernelForm::Known,
            radius_bits: None,
            strengths: false,
            colors: false,
            counting: false,
            chosen: &[],
        }
    }

    /// The same with a method's choice of modules where several define one import path.
    #[must_use]
    pub fn choosing(self, chosen: &'static [&'static str]) -> Self {
        Self { chosen, ..self }
    }

    /// The modules that shaders are composed of.
    pub fn variant(&self) -> Variant {
        Variant {
            kernel: match (self.kernel_form, self.kernel) {
                (KernelForm::AnyKernel, _) => KernelModule::Any,
                (KernelForm::AnyExponent, Kernel::Power(_)) => KernelModule::AnyPower,
                (KernelForm::Known, Kernel::Power(_)) => KernelModule::Power,
                (_, Kernel::Wyvill) => KernelModule::Wyvill,
                (_, Kernel::Perlin) => KernelModule::Perlin,
                (_, Kernel::CubicSpline) => KernelModule::CubicSpline,
                (_, Kernel::QuinticSpline) => KernelModule::QuinticSpline,
                (_, Kernel::WendlandC2) => KernelModule::WendlandC2,
                (_, Kernel::WendlandC4) => KernelModule::WendlandC4,
                (_, Kernel::WendlandC6) => KernelModule::WendlandC6,
                (_, Kernel::Gaussian(_)) => KernelModule::Gaussian,
            },
            radii: self.radius_bits.is_none(),
            strengths: self.strengths,
            colors: self.colors,
            counting: self.counting,
            chosen: self.chosen,
        }
    }

    /// Values of the shared modules' override constants, by id.
    pub fn constants(&self) -> Vec<(&'static str, f64)> {
        let mut constants = match self.kernel {
            Kernel::Power(exponent) => vec![(EXPONENT, f64::from(exponent.get()))],
            Kernel::Gaussian(cut) => {
                let gaussian = cut.profile();
                GAUSSIAN.into_iter().zip([gaussian.exponent(), gaussian.scale()]).collect()
            }
            _ => Vec::new(),
        };
        constants.extend(self.radius_bits.map(|bits| (RADIUS, f32::from_bits(bits).into())));
        constants
    }
}

/// Composes a module of `metaball-shaders`, by its name, and makes a compute pipeline of one of its
/// entry points. `layouts` are those of groups 0, 1, …; `extra_constants` the override constants of
/// the method, by id from 16 on.
///
/// # Errors
/// When the module does not compose, or wgpu refuses it.
pub fn compute_pipeline(
    gpu: &Gpu,
    label: &str,
    module: &str,
    entry: &str,
    spec: &Specialization,
    layouts: &[&wgpu::BindGroupLayout],
    extra_constants: &[(&str, f64)],
) -> Result<wgpu::ComputePipeline, RenderError> {
    Shader::new(gpu, label, module, spec)?.compute(
        gpu,
        label,
        entry,
        spec,
        layouts,
        extra_constants,
    )
}

/// A composed module on the device, for pipelines of one or several of its entry points.
#[derive(Debug)]
pub struct Shader {
    /// The module, for render pipelines.
    pub module: wgpu::ShaderModule,
    ids: Vec<u16>,
}

impl Shader {
    /// Composes a module of `metaball-shaders`, by its name.
    ///
    /// # Errors
    /// When the module does not compose, or wgpu refuses it.
    pub fn new(
        gpu: &Gpu,
        label: &str,
        module: &str,
        spec: &Specialization,
    ) -> Result<Self, RenderError> {
        Self::of_composed(gpu, label, compose(module, &spec.variant())?, own_module)
    }

    /// Composes a module of the caller's, which may import those of `metaball-shaders`. It is checked
    /// whatever the device's [`ShaderChecks`](super::ShaderChecks).
    ///
    /// # Errors
    /// As [`Shader::new`].
    pub fn of_module(
        gpu: &Gpu,
        module: &Module,
        spec: &Specialization,
    ) -> Result<Self, RenderError> {
        let composed = compose_module(module, &spec.variant())?;
        Self::of_composed(gpu, module.name, composed, foreign_module)
    }

    fn of_composed(
        gpu: &Gpu,
        label: &str,
        composed: naga::Module,
        make: impl FnOnce(&Gpu, &str, naga::Module) -> wgpu::ShaderModule,
    ) -> Result<Self, RenderError> {
        let ids = override_ids(&composed);
        gpu.count_code(code_size(&composed));
        let module = gpu.checked(|| make(gpu, label, composed))?;
        Ok(Self { module, ids })
    }

    /// A compute pipeline of one entry point. `layouts` are those of groups 0, 1, …;
    /// `extra_constants` the override constants of the method, by id from 16 on.
    ///
    /// # Errors
    /// When wgpu refuses it.
    pub fn compute(
        &self,
        gpu: &Gpu,
        label: &str,
        entry: &str,
        spec: &Specialization,
        layouts: &[&wgpu::BindGroupLayout],
        extra_constants: &[(&str, f64)],
    ) -> Result<wgpu::ComputePipeline, RenderError> {
        let constants = self.constants(spec, extra_constants);
        gpu.checked(|| {
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(label),
                layout: Some(&pipeline_layout(gpu, label, layouts)),
                module: &self.module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..wgpu::PipelineCompilationOptions::default()
                },
                cache: None,
            })
        })
    }

    /// Values of the override constants that this module has: the specialisation's, and `extra`. For
    /// render pipelines.
    pub fn constants<'a>(
        &self,
        spec: &Specialization,
        extra: &[(&'a str, f64)],
    ) -> Vec<(&'a str, f64)> {
        let used =
            |key: &str| self.ids.iter().any(|id| key.parse().is_ok_and(|key: u16| key == *id));
        let shared = spec.constants().into_iter().filter(|(key, _)| used(key));
        shared.chain(extra.iter().copied()).collect()
    }
}

/// The layout of pipelines with groups of these layouts, from group 0 on.
pub fn pipeline_layout(
    gpu: &Gpu,
    label: &str,
    layouts: &[&wgpu::BindGroupLayout],
) -> wgpu::PipelineLayout {
    let groups: Vec<_> = layouts.iter().copied().map(Some).collect();
    gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

/// Columns and rows of a dispatch of so many workgroups, or a few more, at least one: a device promises
/// no more than 65,535 of either. Invocations are `id.x + id.y * num_workgroups.x * workgroup_size`.
pub fn workgroup_grid(workgroups: u32) -> (u32, u32) {
    const COLUMNS: u32 = 32_768;
    (workgroups.clamp(1, COLUMNS), workgroups.div_ceil(COLUMNS).max(1))
}

fn override_ids(module: &naga::Module) -> Vec<u16> {
    module.overrides.iter().filter_map(|(_, constant)| constant.id).collect()
}
