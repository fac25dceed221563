//! The pipelines, and what they are specialised for.

use metaball_core::Kernel;
use metaball_core::gpu::{Gpu, RenderError, Shader, Specialization, frame_layout, scene_layout};

use crate::options::{ARRAY_CAPACITY, Gather, Options, Sort, exact_degree};
use crate::radix::RadixSort;
use crate::raster::RasterGather;
use crate::tiles::{TileGather, tile_layout};

/// The bind group layouts, by group.
pub(crate) struct Layouts {
    pub(crate) frame: wgpu::BindGroupLayout,
    pub(crate) scene: wgpu::BindGroupLayout,
    /// Order and core radii of the balls.
    pub(crate) balls: wgpu::BindGroupLayout,
    /// What a picture's lists are kept in.
    pub(crate) lists: wgpu::BindGroupLayout,
    /// What its tiles are kept in, in place of the lists.
    pub(crate) tiles: wgpu::BindGroupLayout,
}

/// The passes before the cast.
pub(crate) enum GatherPasses {
    Raster(RasterGather),
    Tiles(TileGather),
}

/// The gathering, and `illes_fraglist/cast.wgsl`.
pub(crate) struct Pipelines {
    pub(crate) specialized: Specialization,
    pub(crate) layouts: Layouts,
    /// Where balls are sorted on the device.
    pub(crate) radix: Option<RadixSort>,
    pub(crate) gather: GatherPasses,
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
            tiles: tile_layout(gpu),
        };
        let radix = match options.sort {
            Sort::Host => None,
            Sort::Device => Some(RadixSort::new(gpu, &specialized, &layouts)?),
        };
        let gather = match options.gather {
            Gather::Raster => GatherPasses::Raster(RasterGather::new(gpu, &specialized, &layouts)?),
            Gather::Tiles => GatherPasses::Tiles(TileGather::new(gpu, &specialized, &layouts)?),
        };
        let Layouts { frame, scene, balls, lists, .. } = &layouts;
        let cast = Shader::new(gpu, "illes cast", "illes_fraglist/cast", &specialized)?.compute(
            gpu,
            "illes cast",
            "cast_rays",
            &specialized,
            &[frame, scene, balls, lists],
            &cast_constants(specialized.kernel, options),
        )?;
        Ok(Self { specialized, radix, gather, cast, layouts })
    }
}

/// The ids of the override constants in `illes_fraglist/records.wgsl` and
/// `polynomial.wgsl`.
fn cast_constants(kernel: Kernel, options: &Options) -> Vec<(&'static str, f64)> {
    let mut constants = vec![("49", f64::from(options.array_capacity.clamp(3, ARRAY_CAPACITY)))];
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

pub(crate) fn storage(binding: u32, read_only: bool) -> wgpu::BindGroupLayoutEntry {
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
