//! What a shader is specialised for: which implementation of each interface it is made of.

/// What a shader knows of the kernel when it is compiled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum KernelModule {
    /// v^α; α is an override constant.
    Power,
    /// v^α; α is read.
    AnyPower,
    /// Wyvill's polynomial.
    Wyvill,
    /// Perlin's polynomial.
    Perlin,
    /// The cubic spline of SPH.
    CubicSpline,
    /// The quintic spline of SPH.
    QuinticSpline,
    /// Wendland's function of smoothness C².
    WendlandC2,
    /// Wendland's function of smoothness C⁴.
    WendlandC4,
    /// Wendland's function of smoothness C⁶.
    WendlandC6,
    /// A cut Gaussian; how far out is an override constant.
    Gaussian,
    /// Nothing: the kernel and its exponent are read.
    Any,
}

impl KernelModule {
    const ALL: [Self; 11] = [
        Self::Power,
        Self::AnyPower,
        Self::Wyvill,
        Self::Perlin,
        Self::CubicSpline,
        Self::QuinticSpline,
        Self::WendlandC2,
        Self::WendlandC4,
        Self::WendlandC6,
        Self::Gaussian,
        Self::Any,
    ];

    /// The modules with the kernel and with its exponent.
    fn modules(self) -> [&'static str; 2] {
        match self {
            Self::Power => ["kernel/power", "exponent/compiled"],
            Self::AnyPower => ["kernel/power", "exponent/read"],
            Self::Wyvill => ["kernel/wyvill", "exponent/compiled"],
            Self::Perlin => ["kernel/perlin", "exponent/compiled"],
            Self::CubicSpline => ["kernel/cubic_spline", "exponent/compiled"],
            Self::QuinticSpline => ["kernel/quintic_spline", "exponent/compiled"],
            Self::WendlandC2 => ["kernel/wendland_c2", "exponent/compiled"],
            Self::WendlandC4 => ["kernel/wendland_c4", "exponent/compiled"],
            Self::WendlandC6 => ["kernel/wendland_c6", "exponent/compiled"],
            Self::Gaussian => ["kernel/gaussian", "exponent/compiled"],
            Self::Any => ["kernel/any", "exponent/read"],
        }
    }
}

/// What a shader is specialised for. What a variant does not need is neither bound nor compiled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Variant {
    /// Falloff of the balls.
    pub kernel: KernelModule,
    /// Whether balls have radii of their own.
    pub radii: bool,
    /// Whether balls have strengths of their own.
    pub strengths: bool,
    /// Whether balls have colours.
    pub colors: bool,
    /// Whether work is counted.
    pub counting: bool,
    /// Names of the modules that implement the interfaces of a method, such as `fbvh/leaf/certified`.
    pub chosen: &'static [&'static str],
}

impl Variant {
    /// Variants to try: every module that a field chooses is in one of them, alone and with all others.
    /// Without further choices.
    pub fn trials() -> impl Iterator<Item = Self> {
        let least = |kernel| Self {
            kernel,
            radii: false,
            strengths: false,
            colors: false,
            counting: false,
            chosen: &[],
        };
        let most = move |kernel| Self {
            radii: true,
            strengths: true,
            colors: true,
            counting: true,
            ..least(kernel)
        };
        let power = least(KernelModule::Power);
        let alone = [
            Self { radii: true, ..power },
            Self { strengths: true, ..power },
            Self { colors: true, ..power },
            Self { counting: true, ..power },
        ];
        KernelModule::ALL
            .into_iter()
            .flat_map(move |kernel| [least(kernel), most(kernel)])
            .chain(alone)
    }

    /// Names of the modules this variant chooses.
    pub(crate) fn modules(&self) -> Vec<&'static str> {
        let [kernel, exponent] = self.kernel.modules();
        let either = |condition, yes, no| if condition { yes } else { no };
        let mut modules = vec![
            kernel,
            exponent,
            either(self.radii, "support/varied", "support/uniform"),
            either(self.strengths, "strength/varied", "strength/unit"),
            either(self.colors, "color/blended", "color/none"),
            either(self.colors, "shade/base/blended", "shade/base/white"),
            either(self.counting, "work/counted", "work/off"),
        ];
        modules.extend(self.chosen);
        modules
    }
}
