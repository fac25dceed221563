//! Which of several modules with one import path a shader is made of.

/// The family of a kernel; its exponent is an override constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum KernelModule {
    /// v^α.
    Power,
    /// Wyvill's polynomial.
    Wyvill,
    /// Perlin's polynomial.
    Perlin,
}

/// What a shader is specialised for. What a variant does not need is neither bound nor compiled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Variant {
    /// Falloff of the balls.
    pub kernel: KernelModule,
    /// Whether balls have strengths of their own.
    pub strengths: bool,
    /// Whether balls have colours.
    pub colors: bool,
    /// Whether work is counted.
    pub counting: bool,
    /// Names of further modules to be preferred where several define one import path: the choices
    /// of a method.
    pub chosen: &'static [&'static str],
}

impl Variant {
    /// Every combination, without further choices.
    pub fn all() -> impl Iterator<Item = Self> {
        let kernels = [KernelModule::Power, KernelModule::Wyvill, KernelModule::Perlin];
        kernels.into_iter().flat_map(|kernel| {
            (0..8).map(move |bits| Self {
                kernel,
                strengths: bits & 1 != 0,
                colors: bits & 2 != 0,
                counting: bits & 4 != 0,
                chosen: &[],
            })
        })
    }

    /// Names of the modules this variant chooses.
    pub(crate) fn modules(&self) -> Vec<&'static str> {
        let kernel = match self.kernel {
            KernelModule::Power => "kernel/power",
            KernelModule::Wyvill => "kernel/wyvill",
            KernelModule::Perlin => "kernel/perlin",
        };
        let either = |condition, yes, no| if condition { yes } else { no };
        let mut modules = vec![
            kernel,
            either(self.strengths, "strength/varied", "strength/unit"),
            either(self.colors, "color/blended", "color/none"),
            either(self.colors, "shade/base_blended", "shade/base_white"),
            either(self.counting, "work/counted", "work/off"),
        ];
        modules.extend(self.chosen);
        modules
    }
}
