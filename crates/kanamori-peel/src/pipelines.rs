//! The pipelines, and what they are specialised for.

use metaball_core::gpu::{
    DepthTest, Gpu, RasterDescriptor, RenderError, Shader, Specialization, TRIANGLE_STRIP,
};
use metaball_core::{Kernel, KernelForm};

use crate::layouts::{DEPTH_FORMAT, LIST_FORMAT, Layouts, POINT_FORMAT};
use crate::options::{Clipping, Options, Outline};

/// All passes of a frame.
pub(crate) struct Pipelines {
    pub(crate) specialization: Specialization,
    pub(crate) layouts: Layouts,
    pub(crate) place: wgpu::ComputePipeline,
    pub(crate) count: wgpu::ComputePipeline,
    pub(crate) total: wgpu::ComputePipeline,
    pub(crate) spread: wgpu::ComputePipeline,
    pub(crate) tally: wgpu::ComputePipeline,
    pub(crate) assign: wgpu::ComputePipeline,
    pub(crate) fill: wgpu::ComputePipeline,
    pub(crate) turn: wgpu::ComputePipeline,
    pub(crate) kernels: wgpu::RenderPipeline,
    pub(crate) see: wgpu::RenderPipeline,
    pub(crate) peel: wgpu::RenderPipeline,
    pub(crate) test: wgpu::RenderPipeline,
    pub(crate) account: wgpu::ComputePipeline,
}

/// What the search of an interval depends on: the modules with the kernel's Bernstein form, with the
/// way of clipping and with the length of the lists. `None` for a kernel that is no polynomial along a ray. Where shaders are not
/// compiled for the kernel, the quartic has the form of all power kernels.
pub(crate) fn search_modules(
    kernel: Kernel,
    form: KernelForm,
    options: &Options,
) -> Option<&'static [&'static str]> {
    const SHORT_STACK: &str = "kanamori_peel/clipping/short_stack";
    const ITERATIVE: &str = "kanamori_peel/clipping/iterative";
    const ORIGINAL: &str = "kanamori_peel/clipping/original";
    const FOUR: &str = "kanamori_peel/longest/four_targets";
    const EIGHT: &str = "kanamori_peel/longest/eight_targets";
    macro_rules! with {
        ($form:literal) => {
            match (options.clipping, options.targets() <= 4) {
                (Clipping::ShortStack, true) => &[$form, SHORT_STACK, FOUR],
                (Clipping::ShortStack, false) => &[$form, SHORT_STACK, EIGHT],
                (Clipping::Iterative, true) => &[$form, ITERATIVE, FOUR],
                (Clipping::Iterative, false) => &[$form, ITERATIVE, EIGHT],
                (Clipping::Original, true) => &[$form, ORIGINAL, FOUR],
                (Clipping::Original, false) => &[$form, ORIGINAL, EIGHT],
            }
        };
    }
    match kernel {
        Kernel::QUARTIC if form == KernelForm::Known => {
            Some(with!("kanamori_peel/bernstein/quartic"))
        }
        Kernel::Power(_) => Some(with!("kanamori_peel/bernstein/power")),
        Kernel::Wyvill => Some(with!("kanamori_peel/bernstein/wyvill")),
        _ => None,
    }
}

impl Outline {
    /// The WGSL module to choose.
    fn modules(self) -> &'static [&'static str] {
        match self {
            Self::Rectangle => &["kanamori_peel/outline/rectangle"],
            Self::Tessellation => &["kanamori_peel/outline/tessellation"],
        }
    }

    /// Vertices of a ball: `VERTICES` of the module.
    pub(crate) fn vertices(self) -> u32 {
        match self {
            Self::Rectangle => 4,
            Self::Tessellation => 384,
        }
    }

    fn primitive(self) -> wgpu::PrimitiveState {
        match self {
            Self::Rectangle => TRIANGLE_STRIP,
            Self::Tessellation => wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleList,
                cull_mode: Some(wgpu::Face::Front),
                ..wgpu::PrimitiveState::default()
            },
        }
    }
}

/// The nearest fragment stays, and its depth.
const KEEP_NEAREST: DepthTest =
    DepthTest { format: DEPTH_FORMAT, compare: wgpu::CompareFunction::Less, writes: true };

/// Every fragment that is not discarded stays, with its depth.
const SET_BACK: DepthTest =
    DepthTest { format: DEPTH_FORMAT, compare: wgpu::CompareFunction::Always, writes: true };

/// Every fragment is drawn; the depth is there to be read.
const IGNORE: DepthTest =
    DepthTest { format: DEPTH_FORMAT, compare: wgpu::CompareFunction::Always, writes: false };

impl Pipelines {
    pub(crate) fn new(
        gpu: &Gpu,
        method: &'static str,
        specialization: Specialization,
        options: &Options,
    ) -> Result<Self, RenderError> {
        let Specialization { kernel, kernel_form, .. } = specialization;
        let Some(search) = search_modules(kernel, kernel_form, options) else {
            return Err(RenderError::Unsupported {
                method,
                reason: format!(
                    "needed a kernel that is a polynomial along a ray, found {kernel}: Bézier \
                     clipping has no control points for it"
                ),
            });
        };
        let spec = specialization.choosing(options.outline.modules());
        let layouts = Layouts::new(gpu, &specialization)?;
        let shader = |module| Shader::new(gpu, module, module, &spec);
        let (arrange, register) =
            (shader("kanamori_peel/arrange")?, shader("kanamori_peel/register")?);
        let (turn, kernels) = (shader("kanamori_peel/turn")?, shader("kanamori_peel/kernels")?);
        let peel = shader("kanamori_peel/peel")?;
        let test = Shader::new(gpu, "test", "kanamori_peel/test", &spec.choosing(search))?;

        // The ids of the override constants in the modules.
        let culling = ("32", f64::from(u8::from(options.culling)));
        let tiles = ("38", f64::from(options.tiles));
        let mut searching = vec![
            culling,
            ("33", f64::from(options.threshold)),
            ("35", f64::from(options.list_capacity)),
            tiles,
        ];
        if options.clipping == Clipping::ShortStack {
            searching.push(("34", f64::from(options.stack_size)));
        }

        let [frame, scene, drawing] = [&layouts.frame, &layouts.scene, &layouts.drawing];
        let bottom = [frame, scene, drawing];
        let compute = |shader: &Shader, entry, group, constants: &[_]| {
            shader.compute(gpu, entry, entry, &spec, &[frame, scene, group], constants)
        };
        let over_balls = |entry| compute(&arrange, entry, &layouts.arranging, &[culling]);
        let over_tiles = |entry| compute(&register, entry, &layouts.registering, &[tiles]);
        let raster = |shader: &Shader, pass| shader.raster(gpu, &spec, &pass);
        let lists = vec![Some(LIST_FORMAT.into()); options.targets() as usize];
        Ok(Self {
            specialization,
            place: over_balls("place")?,
            count: over_balls("count")?,
            total: over_balls("total")?,
            spread: over_balls("spread")?,
            tally: over_tiles("tally")?,
            assign: over_tiles("assign")?,
            fill: over_tiles("fill")?,
            turn: compute(&turn, "turn", &layouts.turning, &[])?,
            kernels: raster(
                &kernels,
                RasterDescriptor {
                    label: "kernel spheres",
                    vertex: "bound_kernel",
                    fragment: "kernel_sphere",
                    primitive: options.outline.primitive(),
                    constants: &[],
                    layouts: &bottom,
                    targets: &[],
                    depth: Some(KEEP_NEAREST),
                },
            )?,
            see: raster(
                &kernels,
                RasterDescriptor {
                    label: "balls seen",
                    vertex: "bound_ball",
                    fragment: "mark_seen",
                    primitive: options.outline.primitive(),
                    constants: &[],
                    layouts: &[frame, scene, drawing, &layouts.seeing],
                    targets: &[],
                    depth: Some(IGNORE),
                },
            )?,
            peel: raster(
                &peel,
                RasterDescriptor {
                    label: "peel",
                    vertex: "bound_ball",
                    fragment: "next_point",
                    primitive: options.outline.primitive(),
                    constants: &[],
                    layouts: &[frame, scene, drawing, &layouts.peeling],
                    targets: &[Some(POINT_FORMAT.into())],
                    depth: Some(KEEP_NEAREST),
                },
            )?,
            test: raster(
                &test,
                RasterDescriptor {
                    label: "test",
                    vertex: "cover_tile",
                    fragment: "test_layer",
                    primitive: TRIANGLE_STRIP,
                    constants: &searching,
                    layouts: &[frame, scene, drawing, &layouts.testing],
                    targets: &lists,
                    depth: Some(SET_BACK),
                },
            )?,
            account: test.compute(gpu, "account", "account", &spec, &bottom, &searching)?,
            layouts,
        })
    }
}
