//! The scene on the device.

use bytemuck::{Pod, Zeroable};

use super::layout::{Binding, bind_group, bind_group_layout};
use super::{Gpu, RenderError, Specialization};
use crate::{Kernel, KernelForm, Scene};

/// A scene on the device: group 1 of the pipelines that read its balls.
///
/// 16 bytes a ball; 4 more where strengths vary, 4 more where there are colours.
#[derive(Debug)]
pub struct SceneBuffers {
    bind_group: wgpu::BindGroup,
    bytes: u64,
}

/// What all balls share: WGSL's `SceneHeader` of `shaders/wgsl/core/scene.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SceneHeader {
    /// T: the field on the surface.
    pub threshold: f32,
    /// Number of balls.
    pub balls: u32,
}

/// The kernel, for shaders that it is not compiled into: WGSL's `KernelRead` of
/// `shaders/wgsl/core/kernel_read.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct KernelRead {
    /// 0: power, 1: Wyvill's, 2: Perlin's, 3 and 4: the cubic and the quintic spline, 5 to 7: Wendland's by
    /// smoothness, 8: a Gaussian.
    pub family: u32,
    /// α of a power kernel, 1 of the others.
    pub exponent: u32,
    /// c = cut²/2 of a Gaussian, 0 of the others.
    pub gaussian_exponent: f32,
    /// 1/(eᶜ − 1) of a Gaussian, 0 of the others.
    pub gaussian_scale: f32,
}

impl From<Kernel> for KernelRead {
    fn from(kernel: Kernel) -> Self {
        let of_family =
            |family| Self { family, exponent: 1, gaussian_exponent: 0.0, gaussian_scale: 0.0 };
        match kernel {
            Kernel::Power(exponent) => Self { exponent: exponent.get().into(), ..of_family(0) },
            Kernel::Wyvill => of_family(1),
            Kernel::Perlin => of_family(2),
            Kernel::CubicSpline => of_family(3),
            Kernel::QuinticSpline => of_family(4),
            Kernel::WendlandC2 => of_family(5),
            Kernel::WendlandC4 => of_family(6),
            Kernel::WendlandC6 => of_family(7),
            Kernel::Gaussian(cut) => Self {
                gaussian_exponent: cut.profile().exponent() as f32,
                gaussian_scale: cut.profile().scale() as f32,
                ..of_family(8)
            },
        }
    }
}

impl SceneBuffers {
    /// Uploads the scene.
    ///
    /// # Errors
    /// When it has more balls than the adapter can bind.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        let uniform = wgpu::BufferUsages::UNIFORM;
        let supports = gpu.upload("support spheres", scene.supports(), none)?;
        let kernel = (scene.kernel_form() != KernelForm::Known)
            .then(|| gpu.upload("kernel", &[KernelRead::from(scene.kernel())], uniform))
            .transpose()?;
        let strengths =
            scene.strengths().map(|all| gpu.upload("strengths", all, none)).transpose()?;
        let colors = scene.colors().map(|all| gpu.upload("colours", all, none)).transpose()?;
        let header = gpu.upload(
            "scene header",
            &[SceneHeader { threshold: scene.threshold(), balls: scene.len() as u32 }],
            uniform,
        )?;

        let mut buffers = vec![(0, &supports), (3, &header)];
        buffers.extend(strengths.as_ref().map(|buffer| (1, buffer)));
        buffers.extend(colors.as_ref().map(|buffer| (2, buffer)));
        buffers.extend(kernel.as_ref().map(|buffer| (4, buffer)));
        let layout = scene_layout(gpu, &Specialization::of(scene, false));
        let bind_group = gpu.checked(|| bind_group(gpu, "scene", &layout, &buffers))?;
        let bytes = buffers.iter().map(|(_, buffer)| buffer.size()).sum();
        Ok(Self { bind_group, bytes })
    }

    /// Group 1, laid out as [`scene_layout`].
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// Bytes on the device, all of them uploaded.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// Layout of group 1. It has no bindings for what the specialisation leaves out.
pub fn scene_layout(gpu: &Gpu, spec: &Specialization) -> wgpu::BindGroupLayout {
    let mut bindings = vec![(0, Binding::Read), (3, Binding::Uniform)];
    bindings.extend(spec.strengths.then_some((1, Binding::Read)));
    bindings.extend(spec.colors.then_some((2, Binding::Read)));
    bindings.extend((spec.kernel_form != KernelForm::Known).then_some((4, Binding::Uniform)));
    bind_group_layout(gpu, "scene", &bindings)
}
