//! The pipelines, and what they are specialised for.

use metaball_core::Kernel;
use metaball_core::gpu::{
    Gpu, RenderError, Shader, Specialization, frame_layout, pipeline_layout, scene_layout,
};

use crate::Options;

/// Lists of active balls: "32-bit floats" of section 4.2.
pub(crate) const LIST_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// t and index of a layer's point.
pub(crate) const POINT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;
/// Distances times a power of two: exact.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Bind group layouts: groups 0 and 1 of all passes, then the two that group 2 can have, then the
/// three of group 3.
pub(crate) struct Layouts {
    frame: wgpu::BindGroupLayout,
    scene: wgpu::BindGroupLayout,
    pub(crate) arranging: wgpu::BindGroupLayout,
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
    pub(crate) kernels: wgpu::RenderPipeline,
    pub(crate) see: wgpu::RenderPipeline,
    pub(crate) begin: wgpu::RenderPipeline,
    pub(crate) peel: wgpu::RenderPipeline,
    pub(crate) test: wgpu::RenderPipeline,
    pub(crate) account: wgpu::ComputePipeline,
}

/// What depends on the kernel: the module with its Bernstein form, and that module's constants.
/// `None` for a kernel that is no polynomial along a ray.
pub(crate) fn bernstein(kernel: Kernel) -> Option<(&'static [&'static str], Option<f64>)> {
    match kernel {
        Kernel::QUARTIC => Some((&["kanamori_peel/quartic"], None)),
        Kernel::Power(exponent) => {
            Some((&["kanamori_peel/power"], Some(f64::from(exponent.get()))))
        }
        Kernel::Wyvill => Some((&["kanamori_peel/wyvill"], None)),
        Kernel::Perlin => None,
    }
}

/// A raster pipeline in short.
struct Raster<'a> {
    label: &'static str,
    shader: &'a Shader,
    vertex: &'static str,
    fragment: &'static str,
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
        let Some((modules, exponent)) = bernstein(specialization.kernel) else {
            let kernel = specialization.kernel;
            return Err(RenderError::Unsupported {
                method,
                reason: format!(
                    "needed a kernel that is a polynomial along a ray, found {kernel}: Bézier \
                     clipping has no control points for it"
                ),
            });
        };
        let spec = specialization.choosing(modules);
        let layouts = Layouts::new(gpu, &specialization)?;
        let shader = |module| Shader::new(gpu, module, module, &spec);
        let (arrange, kernels) =
            (shader("kanamori_peel/arrange")?, shader("kanamori_peel/kernels")?);
        let (peel, test) = (shader("kanamori_peel/peel")?, shader("kanamori_peel/test")?);

        // The ids of the override constants in the modules.
        let culling = [("32", f64::from(u8::from(options.culling)))];
        let mut searching = vec![
            ("33", f64::from(options.threshold)),
            ("34", f64::from(options.stack_size)),
            ("35", f64::from(options.list_capacity)),
        ];
        let distinct = ("37", f64::from(u8::from(options.distinct_points)));
        searching.push(distinct);
        searching.extend(exponent.map(|exponent| ("36", exponent)));

        let balls = [&layouts.frame, &layouts.scene, &layouts.arranging];
        let over_balls = |entry| arrange.compute(gpu, entry, entry, &spec, &balls, &culling);
        let raster = |pass| raster_pipeline(gpu, &spec, &pass);
        let lists = vec![Some(LIST_FORMAT.into()); options.targets() as usize];
        let bottom = [&layouts.frame, &layouts.scene, &layouts.drawing];
        let [frame, scene, drawing] = bottom;
        Ok(Self {
            specialization,
            place: over_balls("place")?,
            count: over_balls("count")?,
            total: over_balls("total")?,
            spread: over_balls("spread")?,
            kernels: raster(Raster {
                label: "kernel spheres",
                shader: &kernels,
                vertex: "bound_kernel",
                fragment: "kernel_sphere",
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
                constants: &[distinct],
                layouts: &[frame, scene, drawing, &layouts.peeling],
                targets: &[Some(POINT_FORMAT.into())],
                depth: Some(Depth::KeepNearest),
            })?,
            test: raster(Raster {
                label: "test",
                shader: &test,
                vertex: "cover_tile",
                fragment: "test_layer",
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
        use wgpu::{
            BindingType, BufferBindingType, ShaderStages, TextureSampleType, TextureViewDimension,
        };
        let layout = |label, entries: &[(ShaderStages, BindingType)]| {
            let entries: Vec<_> = (0u32..)
                .zip(entries)
                .map(|(binding, &(visibility, ty))| wgpu::BindGroupLayoutEntry {
                    binding,
                    visibility,
                    ty,
                    count: None,
                })
                .collect();
            gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries: &entries,
            })
        };
        let buffer =
            |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        let uniform = buffer(BufferBindingType::Uniform);
        let read = buffer(BufferBindingType::Storage { read_only: true });
        let write = buffer(BufferBindingType::Storage { read_only: false });
        let texture = |sample_type, view_dimension| BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled: false,
        };
        let exact = TextureSampleType::Float { filterable: false };
        let lists = texture(exact, TextureViewDimension::D2Array);
        let points = texture(exact, TextureViewDimension::D2);
        let depth = texture(TextureSampleType::Depth, TextureViewDimension::D2);
        let (compute, fragment) = (ShaderStages::COMPUTE, ShaderStages::FRAGMENT);
        let both = ShaderStages::VERTEX_FRAGMENT;
        gpu.checked(|| Self {
            frame: frame_layout(gpu, spec),
            scene: scene_layout(gpu, spec),
            // Constants, placed, seen, arranged, blocks, draws.
            arranging: layout(
                "kanamori arranging",
                &[uniform, write, read, write, write, write].map(|ty| (compute, ty)),
            ),
            // Constants, placed, arranged, kernel radii, seen, draws.
            drawing: layout(
                "kanamori drawing",
                &[
                    (both, uniform),
                    (both, read),
                    (both, read),
                    (both, read),
                    (fragment, write),
                    (fragment, write),
                ],
            ),
            seeing: layout("kanamori seeing", &[(fragment, depth)]),
            peeling: layout("kanamori peeling", &[(fragment, lists)]),
            testing: layout(
                "kanamori testing",
                &[
                    (fragment, lists),
                    (fragment, points),
                    (fragment, depth),
                    (ShaderStages::VERTEX, read),
                    (fragment, write),
                ],
            ),
        })
    }
}

fn raster_pipeline(
    gpu: &Gpu,
    spec: &Specialization,
    pass: &Raster<'_>,
) -> Result<wgpu::RenderPipeline, RenderError> {
    let Raster { label, shader, vertex, fragment, constants, layouts, targets, depth } = *pass;
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
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                ..wgpu::PrimitiveState::default()
            },
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
