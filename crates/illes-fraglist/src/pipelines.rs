//! The three pipelines, and what they are specialised for.

use metaball_core::Kernel;
use metaball_core::gpu::{
    Gpu, RenderError, Shader, Specialization, frame_layout, pipeline_layout, scene_layout,
};

use crate::canvas::{CORE_FORMAT, DEPTH_FORMAT};
use crate::options::{MOST_ROOM, Options, Piece, exact_degree};

/// The bind group layouts, by group.
pub(crate) struct Layouts {
    frame: wgpu::BindGroupLayout,
    scene: wgpu::BindGroupLayout,
    /// Order and core radii of the balls.
    pub(crate) balls: wgpu::BindGroupLayout,
    /// What a picture's lists are kept in.
    pub(crate) lists: wgpu::BindGroupLayout,
}

/// `illes_fraglist/cores.wgsl`, `gather.wgsl` and `cast.wgsl`.
pub(crate) struct Pipelines {
    pub(crate) specialized: Specialization,
    pub(crate) layouts: Layouts,
    pub(crate) cores: wgpu::RenderPipeline,
    pub(crate) gather: wgpu::RenderPipeline,
    pub(crate) cast: wgpu::ComputePipeline,
}

impl Pipelines {
    pub(crate) fn new(
        gpu: &Gpu,
        specialized: Specialization,
        options: &Options,
    ) -> Result<Self, RenderError> {
        let layouts = Layouts {
            frame: frame_layout(gpu, &specialized),
            scene: scene_layout(gpu, &specialized),
            balls: ball_layout(gpu),
            lists: list_layout(gpu),
        };
        let Layouts { frame, scene, balls, lists } = &layouts;
        let cores = RasterPass {
            module: "illes_fraglist/cores",
            vertex: "bound_core",
            fragment: "draw_core",
            groups: &[frame, scene, balls],
            color: Some(CORE_FORMAT),
            // Depth falls with distance; the clear value is 0.
            depth_compare: wgpu::CompareFunction::Greater,
        };
        // A depth target that nothing is tested against: with a colour target in its place, software
        // Vulkan drops the storage writes of fragments that others cover.
        let gather = RasterPass {
            module: "illes_fraglist/gather",
            vertex: "bound_support",
            fragment: "gather",
            groups: &[frame, scene, balls, lists],
            color: None,
            depth_compare: wgpu::CompareFunction::Always,
        };
        let cast = Shader::new(gpu, "illes cast", "illes_fraglist/cast", &specialized)?.compute(
            gpu,
            "illes cast",
            "cast_rays",
            &specialized,
            &[frame, scene, balls, lists],
            &cast_constants(specialized.kernel, options),
        )?;
        let cores = cores.pipeline(gpu, &specialized)?;
        let gather = gather.pipeline(gpu, &specialized)?;
        Ok(Self { specialized, cores, gather, cast, layouts })
    }
}

/// The ids of the override constants in `illes_fraglist/records.wgsl`, `exact.wgsl` and
/// `bernstein.wgsl`.
fn cast_constants(kernel: Kernel, options: &Options) -> Vec<(&'static str, f64)> {
    let mut constants = vec![("49", f64::from(options.room.clamp(3, MOST_ROOM)))];
    if let (Piece::Exact, Some(degree)) = (options.piece, exact_degree(kernel)) {
        let weight = |power: usize| {
            kernel.coefficients().and_then(|all| all.get(power)).copied().unwrap_or(0.0)
        };
        let weights = [("50", weight(1)), ("51", weight(2)), ("52", weight(3))];
        constants.extend(weights);
        constants.push(("53", f64::from(degree)));
    }
    constants
}

/// A pass that draws a rectangle for each ball.
struct RasterPass<'a> {
    module: &'static str,
    vertex: &'static str,
    fragment: &'static str,
    groups: &'a [&'a wgpu::BindGroupLayout],
    color: Option<wgpu::TextureFormat>,
    depth_compare: wgpu::CompareFunction,
}

impl RasterPass<'_> {
    /// Depth is written where there is colour.
    fn pipeline(
        &self,
        gpu: &Gpu,
        spec: &Specialization,
    ) -> Result<wgpu::RenderPipeline, RenderError> {
        let shader = Shader::new(gpu, self.module, self.module, spec)?;
        let options = wgpu::PipelineCompilationOptions::default();
        let targets: Vec<_> = self.color.map(|format| Some(format.into())).into_iter().collect();
        gpu.checked(|| {
            gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(self.module),
                layout: Some(&pipeline_layout(gpu, self.module, self.groups)),
                vertex: wgpu::VertexState {
                    module: &shader.module,
                    entry_point: Some(self.vertex),
                    compilation_options: options.clone(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState {
                    topology: wgpu::PrimitiveTopology::TriangleStrip,
                    ..wgpu::PrimitiveState::default()
                },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH_FORMAT,
                    depth_write_enabled: Some(self.color.is_some()),
                    depth_compare: Some(self.depth_compare),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &shader.module,
                    entry_point: Some(self.fragment),
                    compilation_options: options,
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            })
        })
    }
}

/// Group 2: ball of each rank, core radius of each ball.
fn ball_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("illes balls"),
        entries: &[storage(0, true), storage(1, true)],
    })
}

/// Group 3: heads, pool, core distance, progress.
fn list_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let core = wgpu::BindGroupLayoutEntry {
        binding: 2,
        visibility: wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("illes lists"),
        entries: &[storage(0, false), storage(1, false), core, storage(3, false)],
    })
}

fn storage(binding: u32, read_only: bool) -> wgpu::BindGroupLayoutEntry {
    let writers = wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE;
    let readers = writers | wgpu::ShaderStages::VERTEX;
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: if read_only { readers } else { writers },
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}
