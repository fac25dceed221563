//! What peeling keeps for each pixel: two sets of lists that change places after every layer.

use metaball_core::NO_LIMIT;
use metaball_core::gpu::{Gpu, RenderError};

use crate::pipelines::{DEPTH_FORMAT, LIST_FORMAT, Layouts, POINT_FORMAT};

/// Pixels on a side of a tile: `TILE` of `tile.wgsl`.
const TILE: u32 = 16;

/// Textures and flags of one picture size.
pub(crate) struct Layers {
    pub(crate) size: (u32, u32),
    lists: [ListSet; 2],
    points: wgpu::TextureView,
    point_depth: wgpu::TextureView,
    kernel_depth: wgpu::TextureView,
    /// Group 3 of the pass that flags the balls seen.
    pub(crate) seeing: wgpu::BindGroup,
}

/// ListBufA or ListBufB of the paper's figure 6, with the groups 3 of the passes that read it.
struct ListSet {
    targets: Vec<wgpu::TextureView>,
    /// Which tiles have a ray left.
    tiles: wgpu::Buffer,
    peeling: wgpu::BindGroup,
    testing: wgpu::BindGroup,
}

impl Layers {
    pub(crate) fn new(
        gpu: &Gpu,
        (width, height): (u32, u32),
        targets: u32,
        layouts: &Layouts,
    ) -> Result<Self, RenderError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if width > limit || height > limit {
            return Err(RenderError::PictureSize { width, height, limit });
        }
        let texture = |label, format, layers| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        let plain = |label, format| texture(label, format, 1).create_view(&Default::default());
        let tiles = u64::from(width.div_ceil(TILE)) * u64::from(height.div_ceil(TILE));
        let flags = || gpu.storage("tiles left", 4 * tiles, wgpu::BufferUsages::empty());
        let tiles = [flags()?, flags()?];
        gpu.checked(|| {
            let points = plain("peeled points", POINT_FORMAT);
            let kernel_depth = plain("kernel spheres", DEPTH_FORMAT);
            let list_set = |label, own: usize| {
                let lists = texture(label, LIST_FORMAT, targets);
                let all = lists.create_view(&wgpu::TextureViewDescriptor {
                    dimension: Some(wgpu::TextureViewDimension::D2Array),
                    ..Default::default()
                });
                let layer = |layer| {
                    lists.create_view(&wgpu::TextureViewDescriptor {
                        dimension: Some(wgpu::TextureViewDimension::D2),
                        base_array_layer: layer,
                        array_layer_count: Some(1),
                        ..Default::default()
                    })
                };
                ListSet {
                    targets: (0..targets).map(layer).collect(),
                    peeling: group(gpu, &layouts.peeling, &[view(&all)]),
                    testing: group(
                        gpu,
                        &layouts.testing,
                        &[
                            view(&all),
                            view(&points),
                            view(&kernel_depth),
                            tiles[own].as_entire_binding(),
                            tiles[1 - own].as_entire_binding(),
                        ],
                    ),
                    tiles: tiles[own].clone(),
                }
            };
            Self {
                size: (width, height),
                lists: [list_set("lists A", 0), list_set("lists B", 1)],
                point_depth: plain("peeled depth", DEPTH_FORMAT),
                seeing: group(gpu, &layouts.seeing, &[view(&kernel_depth)]),
                points,
                kernel_depth,
            }
        })
    }

    /// The depth of the nearest kernel spheres, empty.
    pub(crate) fn kernels(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        depth(&self.kernel_depth, Some(1.0))
    }

    /// The same, to be read.
    pub(crate) fn kernels_done(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        depth(&self.kernel_depth, None)
    }

    /// TmpTex of figure 6, no point anywhere.
    pub(crate) fn points(&self) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        Some(target(&self.points, wgpu::Color::TRANSPARENT))
    }

    /// Nearest first.
    pub(crate) fn point_depth(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        depth(&self.point_depth, Some(1.0))
    }

    /// Empties the flags of the lists before a layer, which are about to be written.
    pub(crate) fn clear_tiles(&self, encoder: &mut wgpu::CommandEncoder, layer: u32) {
        encoder.clear_buffer(&self.lists[layer as usize % 2].tiles, 0, None);
    }

    /// The lists before a layer, to be written. Rays of tiles that are left out have their answer.
    pub(crate) fn written_before(
        &self,
        layer: u32,
    ) -> Vec<Option<wgpu::RenderPassColorAttachment<'_>>> {
        let answered = wgpu::Color { r: NO_LIMIT.into(), ..wgpu::Color::TRANSPARENT };
        let targets = self.lists[layer as usize % 2].targets.iter();
        targets.map(|view| Some(target(view, answered))).collect()
    }

    /// Group 3 of the peeling pass of a layer.
    pub(crate) fn peeling(&self, layer: u32) -> &wgpu::BindGroup {
        &self.lists[layer as usize % 2].peeling
    }

    /// Group 3 of the test of a layer.
    pub(crate) fn testing(&self, layer: u32) -> &wgpu::BindGroup {
        &self.lists[layer as usize % 2].testing
    }
}

fn target(view: &wgpu::TextureView, clear: wgpu::Color) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
    }
}

/// A depth target: cleared and written, or only read.
fn depth(
    view: &wgpu::TextureView,
    clear: Option<f32>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: clear.map(|value| wgpu::Operations {
            load: wgpu::LoadOp::Clear(value),
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}

fn view(view: &wgpu::TextureView) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::TextureView(view)
}

fn group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0u32..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("kanamori layers"),
        layout,
        entries: &entries,
    })
}
