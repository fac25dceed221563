//! What peeling keeps for each pixel: two sets of lists, read and written in turn.

use metaball_core::gpu::{Gpu, RenderError, bind_group};

use crate::layouts::{DEPTH_FORMAT, LIST_FORMAT, Layouts, POINT_FORMAT};

/// Textures of one picture size, and the groups 3 that bind them.
pub(crate) struct Layers {
    pub(crate) size: (u32, u32),
    bytes: u64,
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
    peeling: wgpu::BindGroup,
    testing: wgpu::BindGroup,
}

impl ListSet {
    fn new(
        gpu: &Gpu,
        label: &str,
        lists: &wgpu::Texture,
        (points, kernel_depth): (&wgpu::TextureView, &wgpu::TextureView),
        layouts: &Layouts,
    ) -> Self {
        let all = lists.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let target = |layer| {
            lists.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        Self {
            targets: (0..lists.depth_or_array_layers()).map(target).collect(),
            peeling: bind_group(gpu, label, &layouts.peeling, &[(0, &all)]),
            testing: bind_group(
                gpu,
                label,
                &layouts.testing,
                &[(0, &all), (1, points), (2, kernel_depth)],
            ),
        }
    }
}

impl Layers {
    pub(crate) fn new(
        gpu: &Gpu,
        (width, height): (u32, u32),
        targets: u32,
        layouts: &Layouts,
    ) -> Result<Self, RenderError> {
        let texture = |label, format, layers| {
            gpu.render_target(
                label,
                format,
                (width, height),
                layers,
                wgpu::TextureUsages::TEXTURE_BINDING,
            )
        };
        let view = |label, format| {
            Ok::<_, RenderError>(texture(label, format, 1)?.create_view(&Default::default()))
        };
        let points = view("peeled points", POINT_FORMAT)?;
        let point_depth = view("peeled depth", DEPTH_FORMAT)?;
        let kernel_depth = view("kernel spheres", DEPTH_FORMAT)?;
        let list_set = |label| {
            let lists = texture(label, LIST_FORMAT, targets)?;
            gpu.checked(|| ListSet::new(gpu, label, &lists, (&points, &kernel_depth), layouts))
        };
        let lists = [list_set("lists A")?, list_set("lists B")?];
        let seeing = gpu
            .checked(|| bind_group(gpu, "kernel depth", &layouts.seeing, &[(0, &kernel_depth)]))?;
        // Each of the two sets has as many textures as a list has targets.
        let texels = [(LIST_FORMAT, 2 * targets), (POINT_FORMAT, 1), (DEPTH_FORMAT, 2)];
        let pixel: u64 =
            texels.iter().map(|&(format, textures)| texel(format) * u64::from(textures)).sum();
        Ok(Self {
            size: (width, height),
            bytes: pixel * u64::from(width) * u64::from(height),
            lists,
            points,
            point_depth,
            kernel_depth,
            seeing,
        })
    }

    /// Bytes on the adapter.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The depth of the nearest kernel spheres, cleared.
    pub(crate) fn kernels(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        depth(&self.kernel_depth, Some(wgpu::LoadOp::Clear(1.0)))
    }

    /// The same, to be read.
    pub(crate) fn kernels_done(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        depth(&self.kernel_depth, None)
    }

    /// A layer's points: TmpTex of figure 6. A ray for which the layer finds none keeps the last one.
    pub(crate) fn points(&self, layer: u32) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        Some(target(&self.points, clear_at_first(layer, wgpu::Color::TRANSPARENT)))
    }

    /// The depth of a layer's points; the test before has set it back for the rays that go on.
    pub(crate) fn point_depth(&self, layer: u32) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        depth(&self.point_depth, Some(clear_at_first(layer, 1.0)))
    }

    /// The same, to be set back.
    pub(crate) fn point_depth_after(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        depth(&self.point_depth, Some(wgpu::LoadOp::Load))
    }

    /// The lists after a layer, written for the rays that go on; the others' are never read.
    pub(crate) fn lists_after(
        &self,
        layer: u32,
    ) -> Vec<Option<wgpu::RenderPassColorAttachment<'_>>> {
        let targets = self.lists[(layer as usize + 1) % 2].targets.iter();
        targets.map(|view| Some(target(view, wgpu::LoadOp::Load))).collect()
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

/// Layers are counted from 0.
fn clear_at_first<T>(layer: u32, value: T) -> wgpu::LoadOp<T> {
    if layer == 0 { wgpu::LoadOp::Clear(value) } else { wgpu::LoadOp::Load }
}

fn target(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
    }
}

/// A depth target: written, or only read.
fn depth(
    view: &wgpu::TextureView,
    written: Option<wgpu::LoadOp<f32>>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: written.map(|load| wgpu::Operations { load, store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

/// Bytes of a texel.
fn texel(format: wgpu::TextureFormat) -> u64 {
    format.block_copy_size(None).map_or(0, u64::from)
}
