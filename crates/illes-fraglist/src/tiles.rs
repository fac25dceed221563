//! Core depth and lists without a rasteriser: the compute twin.

use metaball_core::gpu::{Frame, Gpu, RenderError, Shader, Specialization};

use crate::canvas::CORE_FORMAT;
use crate::pipelines::{Layouts, storage};
use crate::renderer::Built;

/// Tiles of a picture at most: `MOST_TILES` of `illes_fraglist/tiles.wgsl`.
const TILES: u64 = 16384;

/// Invocations of a workgroup of `illes_fraglist/bin.wgsl`, and workgroups of a row of a dispatch.
const BALLS_OF_GROUP: u32 = 64;
const GROUPS_OF_ROW: u32 = 32768;

/// `illes_fraglist/bin.wgsl` and `collect.wgsl`.
pub(crate) struct TileGather {
    count: wgpu::ComputePipeline,
    place: wgpu::ComputePipeline,
    fill: wgpu::ComputePipeline,
    collect: wgpu::ComputePipeline,
}

impl TileGather {
    pub(crate) fn new(
        gpu: &Gpu,
        spec: &Specialization,
        layouts: &Layouts,
    ) -> Result<Self, RenderError> {
        let Layouts { frame, scene, balls, tiles, .. } = layouts;
        let groups = [frame, scene, balls, tiles];
        let bin = Shader::new(gpu, "illes bin", "illes_fraglist/bin", spec)?;
        let collect = Shader::new(gpu, "illes collect", "illes_fraglist/collect", spec)?;
        let binning = |entry| bin.compute(gpu, "illes bin", entry, spec, &groups, &[]);
        Ok(Self {
            count: binning("count_entries")?,
            place: binning("place_tiles")?,
            fill: binning("fill_entries")?,
            collect: collect.compute(gpu, "illes collect", "collect", spec, &groups, &[])?,
        })
    }

    /// The passes `bin` and `gather`.
    pub(crate) fn record(&self, frame: &mut Frame<'_>, built: &Built, room: &TileRoom) {
        let targets = frame.targets();
        frame.encoder().clear_buffer(&room.marks, 0, None);
        let bind = |pass: &mut wgpu::ComputePass<'_>| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, built.scene.bind_group(), &[]);
            pass.set_bind_group(2, &built.bind_group, &[]);
            pass.set_bind_group(3, &room.bind_group, &[]);
        };
        let groups = built.len().div_ceil(BALLS_OF_GROUP).max(1);
        let (columns, rows) = (groups.min(GROUPS_OF_ROW), groups.div_ceil(GROUPS_OF_ROW));
        frame.compute("bin", |pass| {
            bind(pass);
            pass.set_pipeline(&self.count);
            pass.dispatch_workgroups(columns, rows, 1);
            pass.set_pipeline(&self.place);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_pipeline(&self.fill);
            pass.dispatch_workgroups(columns, rows, 1);
        });
        let (columns, rows) = targets.workgroups();
        frame.compute("gather", |pass| {
            bind(pass);
            pass.set_pipeline(&self.collect);
            pass.dispatch_workgroups(columns, rows, 1);
        });
    }
}

/// What the tiles of a picture are kept in.
pub(crate) struct TileRoom {
    marks: wgpu::Buffer,
    ranks: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl TileRoom {
    /// Room for so many entries, bound together with a picture's lists and core distances.
    pub(crate) fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        entries: u32,
        (heads, pool): (&wgpu::Buffer, &wgpu::Buffer),
        core: &wgpu::TextureView,
    ) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        let marks = gpu.storage("illes tile marks", 4 * TILES, none)?;
        let ranks = gpu.storage("illes tile entries", 4 * u64::from(entries), none)?;
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let bind_group = gpu.checked(|| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("illes tiles"),
                layout: &layouts.tiles,
                entries: &[
                    entry(0, heads.as_entire_binding()),
                    entry(1, pool.as_entire_binding()),
                    entry(4, marks.as_entire_binding()),
                    entry(5, ranks.as_entire_binding()),
                    entry(6, wgpu::BindingResource::TextureView(core)),
                ],
            })
        })?;
        Ok(Self { marks, ranks, bind_group })
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.marks.size() + self.ranks.size()
    }
}

/// Group 3 of these passes: heads, pool, marks, entries, core distance.
pub(crate) fn tile_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let core = wgpu::BindGroupLayoutEntry {
        binding: 6,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: CORE_FORMAT,
            view_dimension: wgpu::TextureViewDimension::D2,
        },
        count: None,
    };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("illes tiles"),
        entries: &[
            storage(0, false),
            storage(1, false),
            storage(4, false),
            storage(5, false),
            core,
        ],
    })
}
