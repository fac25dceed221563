//! The pipelines, and what they are specialised for.

use metaball_core::gpu::{
    Binding, Gpu, RenderError, Shader, Specialization, bind_group_layout, frame_layout,
    pipeline_layout, scene_layout,
};
use metaball_core::{Kernel, KernelForm};

use crate::{Clipping, Options, Outline};

/// Lists of active balls: "32-bit floats" of section 4.2.
pub(crate) const LIST_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// t and index of a layer's point.
pub(crate) const POINT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;
/// Distances times a power of two: exact.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Bind group layouts: groups 0 and 1 of all passes, then the four that group 2 can be, then the
/// three of group 3.
pub(crate) struct Layouts {
    frame: wgpu::BindGroupLayout,
    scene: wgpu::BindGroupLayout,
    pub(crate) arranging: wgpu::BindGroupLayout,
    pub(crate) registering: wgpu::BindGroupLayout,
    pub(crate) turning: wgpu::BindGroupLayout,
    pub(crate) drawing: wgpu::BindGroupLayout,
    pub(crate) seeing: wgpu::BindGroupLayout,
    pub(crate) peeling: wgpu::BindGroupLayout,
    pub(crate) testing: wgpu::BindGroupLayout,
}

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
    pub(crate) begin: wgpu::RenderPipeline,
    pub(crate) peel: wgpu::RenderPipeline,
    pub(crate) test: wgpu::RenderPipeline,
    pub(crate) account: wgpu::ComputePipeline,
}

/// What the search of an interval depends on: the modules with the kernel's Bernstein form and with
/// the way of clipping. `None` for a kernel that is no polynomial along a ray. A kernel that shaders
/// are not made for keeps the form of its family, which has a degree of its own.
pub(crate) fn searching(
    kernel: Kernel,
    form: KernelForm,
    clipping: Clipping,
) -> Option<&'static [&'static str]> {
    const SHORT_STACK: &str = "kanamori_peel/clipping/short_stack";
    const ITERATIVE: &str = "kanamori_peel/clipping/iterative";
    const ORIGINAL: &str = "kanamori_peel/clipping/original";
    macro_rules! with {
        ($form:literal) => {
            match clipping {
                Clipping::ShortStack => &[$form, SHORT_STACK],
                Clipping::Iterative => &[$form, ITERATIVE],
                Clipping::Original => &[$form, ORIGINAL],
            }
        };
    }
    match kernel {
        Kernel::QUARTIC if form == KernelForm::Known => {
            Some(with!("kanamori_peel/bernstein/quartic"))
        }
        Kernel::Power(_) => Some(with!("kanamori_peel/bernstein/power")),
        Kernel::Wyvill => Some(with!("kanamori_peel/bernstein/wyvill")),
        Kernel::Perlin => None,
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

    fn triangles(self) -> wgpu::PrimitiveState {
        match self {
            Self::Rectangle => STRIP,
            Self::Tessellation => wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleList,
                cull_mode: Some(wgpu::Face::Front),
                ..wgpu::PrimitiveState::default()
            },
        }
    }
}

/// Two triangles of four vertices.
const STRIP: wgpu::PrimitiveState = wgpu::PrimitiveState {
    topology: wgpu::PrimitiveTopology::TriangleStrip,
    strip_index_format: None,
    front_face: wgpu::FrontFace::Ccw,
    cull_mode: None,
    unclipped_depth: false,
    polygon_mode: wgpu::PolygonMode::Fill,
    conservative: false,
};

/// A raster pipeline in short.
struct Raster<'a> {
    label: &'static str,
    shader: &'a Shader,
    vertex: &'static str,
    fragment: &'static str,
    triangles: wgpu::PrimitiveState,
    constants: &'a [(&'a str, f64)],
    layouts: &'a [&'a wgpu::BindGroupLayout],
    targets: &'a [Option<wgpu::ColorTargetState>],
    depth: Option<Depth>,
}

/// What a raster pass does with its depth target.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Depth {
    KeepNearest,
    Ignore,
}

impl Pipelines {
    pub(crate) fn new(
        gpu: &Gpu,
        method: &'static str,
        specialization: Specialization,
        options: &Options,
    ) -> Result<Self, RenderError> {
        let Specialization { kernel, kernel_form, .. } = specialization;
        let Some(modules) = searching(kernel, kernel_form, options.clipping) else {
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
        let test = Shader::new(gpu, "test", "kanamori_peel/test", &spec.choosing(modules))?;

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
        let raster = |pass| raster_pipeline(gpu, &spec, &pass);
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
            kernels: raster(Raster {
                label: "kernel spheres",
                shader: &kernels,
                vertex: "bound_kernel",
                fragment: "kernel_sphere",
                triangles: options.outline.triangles(),
                constants: &[],
                layouts: &bottom,
                targets: &[],
                depth: Some(Depth::KeepNearest),
            })?,
            see: raster(Raster {
                label: "balls seen",
                shader: &kernels,
                vertex: "bound_ball",
                fragment: "mark_seen",
                triangles: options.outline.triangles(),
                constants: &[],
                layouts: &[frame, scene, drawing, &layouts.seeing],
                targets: &[],
                depth: Some(Depth::Ignore),
            })?,
            begin: raster(Raster {
                label: "begin",
                shader: &test,
                vertex: "cover_picture",
                fragment: "begin",
                triangles: STRIP,
                constants: &searching,
                layouts: &[frame, scene, drawing, &layouts.testing],
                targets: &lists,
                depth: None,
            })?,
            peel: raster(Raster {
                label: "peel",
                shader: &peel,
                vertex: "bound_ball",
                fragment: "next_point",
                triangles: options.outline.triangles(),
                constants: &[],
                layouts: &[frame, scene, drawing, &layouts.peeling],
                targets: &[Some(POINT_FORMAT.into())],
                depth: Some(Depth::KeepNearest),
            })?,
            test: raster(Raster {
                label: "test",
                shader: &test,
                vertex: "cover_tile",
                fragment: "test_layer",
                triangles: STRIP,
                constants: &searching,
                layouts: &[frame, scene, drawing, &layouts.testing],
                targets: &lists,
                depth: None,
            })?,
            account: test.compute(gpu, "account", "account", &spec, &[frame], &searching)?,
            layouts,
        })
    }
}

impl Layouts {
    fn new(gpu: &Gpu, spec: &Specialization) -> Result<Self, RenderError> {
        use Binding::{Depth, Read, Texture, TextureArray, Uniform, Write};
        let layout = |label, bindings: &[(u32, Binding)]| bind_group_layout(gpu, label, bindings);
        gpu.checked(|| Self {
            frame: frame_layout(gpu, spec),
            scene: scene_layout(gpu, spec),
            // Placed, seen, arranged, blocks.
            arranging: layout(
                "kanamori arranging",
                &[(1, Write), (2, Read), (3, Write), (4, Write)],
            ),
            // Placed, tiles, registered, tallies.
            registering: layout(
                "kanamori registering",
                &[(0, Read), (1, Write), (2, Write), (3, Write)],
            ),
            // Tiles, rays left, draws.
            turning: layout("kanamori turning", &[(0, Write), (1, Write), (2, Write)]),
            // Constants, placed, arranged, kernel radii, seen, tiles, registered, rays left.
            drawing: layout(
                "kanamori drawing",
                &[
                    (0, Uniform),
                    (1, Read),
                    (2, Read),
                    (3, Read),
                    (4, Write),
                    (5, Read),
                    (6, Read),
                    (7, Write),
                ],
            ),
            // The nearest kernel spheres.
            seeing: layout("kanamori seeing", &[(0, Depth)]),
            // The lists.
            peeling: layout("kanamori peeling", &[(0, TextureArray)]),
            // The lists, the points, the nearest kernel spheres.
            testing: layout("kanamori testing", &[(0, TextureArray), (1, Texture), (2, Depth)]),
        })
    }
}

fn raster_pipeline(
    gpu: &Gpu,
    spec: &Specialization,
    pass: &Raster<'_>,
) -> Result<wgpu::RenderPipeline, RenderError> {
    let Raster { label, shader, vertex, fragment, triangles, constants, layouts, targets, depth } =
        *pass;
    let constants = shader.constants(spec, constants);
    let options = || wgpu::PipelineCompilationOptions {
        constants: &constants,
        ..wgpu::PipelineCompilationOptions::default()
    };
    gpu.checked(|| {
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: Some(&pipeline_layout(gpu, label, layouts)),
            vertex: wgpu::VertexState {
                module: &shader.module,
                entry_point: Some(vertex),
                compilation_options: options(),
                buffers: &[],
            },
            primitive: triangles,
            depth_stencil: depth.map(|depth| wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(depth == Depth::KeepNearest),
                depth_compare: Some(match depth {
                    Depth::KeepNearest => wgpu::CompareFunction::Less,
                    Depth::Ignore => wgpu::CompareFunction::Always,
                }),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &shader.module,
                entry_point: Some(fragment),
                compilation_options: options(),
                targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    })
}
