//! What the adapter keeps for pictures of one size.

use bytemuck::{Pod, Zeroable};
use metaball_core::gpu::{Gpu, RayList, RenderError, Resource, Targets, TileBins, bind_group};

use crate::layouts::{CORE_FORMAT, DEPTH_FORMAT, Layouts};
use crate::lists::Lists;

/// How far a ray that waits is: WGSL's `Progress` of
/// `shaders/wgsl/illes_fraglist/waiting.wgsl`. The host only needs its size.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Progress {
    pub(crate) stage: u32,
    pub(crate) node: u32,
    pub(crate) position: f32,
    pub(crate) fallback: u32,
}

/// What a canvas holds at most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Capacities {
    /// List nodes.
    pub(crate) nodes: u32,
    /// Entries of all tiles; `None`: no tiles.
    pub(crate) entries: Option<u32>,
}

/// Core depth, lists and progress of a picture of one size.
pub(crate) struct Canvas {
    width: u32,
    height: u32,
    capacities: Capacities,
    pub(crate) lists: Lists,
    /// Where lists are gathered by tiles.
    pub(crate) tiles: Option<Tiles>,
    /// Distance along each pixel's ray to the nearest core, scene units.
    pub(crate) core: wgpu::TextureView,
    pub(crate) depth: wgpu::TextureView,
    progress: wgpu::Buffer,
    /// The running sums of rays that wait, four coefficients a pixel.
    sums: wgpu::Buffer,
    /// What dispatches of the cast write and read in turn. The gathering is bound to either.
    pub(crate) turns: [Turn; 2],
}

/// A dispatch of the cast, which resumes the rays that wait after the one before it.
pub(crate) struct Turn {
    /// The rays that wait after it.
    pub(crate) waiting: RayList,
    /// Group 3 of the passes that gather and cast.
    pub(crate) bind_group: wgpu::BindGroup,
}

/// Balls over each tile of the picture.
pub(crate) struct Tiles {
    pub(crate) bins: TileBins,
    /// Group 3 of the passes over tiles.
    pub(crate) bind_group: wgpu::BindGroup,
}

impl Canvas {
    /// A canvas of the targets' size.
    pub(crate) fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        targets: &Targets,
        capacities: Capacities,
    ) -> Result<Self, RenderError> {
        let (width, height) = (targets.width(), targets.height());
        let none = wgpu::TextureUsages::empty();
        // Passes over tiles write core distances, raster passes draw them.
        let writer = match capacities.entries {
            Some(_) => wgpu::TextureUsages::STORAGE_BINDING,
            None => none,
        };
        let texture = |label, format, usages| {
            let usages = wgpu::TextureUsages::TEXTURE_BINDING | usages;
            let texture = gpu.render_target(label, format, (width, height), 1, usages)?;
            Ok::<_, RenderError>(texture.create_view(&Default::default()))
        };
        let core = texture("illes core distance", CORE_FORMAT, writer)?;
        let depth = texture("illes core depth", DEPTH_FORMAT, none)?;
        let pixels = u64::from(width) * u64::from(height);
        let lists = Lists::new(gpu, pixels, capacities.nodes)?;
        let progress_bytes = pixels * size_of::<Progress>() as u64;
        let progress =
            gpu.storage("illes progress", progress_bytes, wgpu::BufferUsages::empty())?;
        let sum_bytes = pixels * size_of::<[f32; 4]>() as u64;
        let sums = gpu.storage("illes sums", sum_bytes, wgpu::BufferUsages::empty())?;
        let waiting = [RayList::new(gpu, pixels)?, RayList::new(gpu, pixels)?];
        let group = |resumed: &RayList, waiting: &RayList| {
            let resources: [(u32, Resource<'_>); 7] = [
                (0, (&lists.heads).into()),
                (1, (&lists.pool).into()),
                (2, (&core).into()),
                (3, (&progress).into()),
                (7, resumed.buffer().into()),
                (8, waiting.buffer().into()),
                (9, (&sums).into()),
            ];
            gpu.checked(|| bind_group(gpu, "illes lists", &layouts.lists, &resources))
        };
        let [first, second] = &waiting;
        let groups = [group(second, first)?, group(first, second)?];
        let tiles = capacities
            .entries
            .map(|entries| Tiles::new(gpu, layouts, entries, &lists, &core))
            .transpose()?;
        let [first, second] = waiting;
        let [of_first, of_second] = groups;
        let turns = [
            Turn { waiting: first, bind_group: of_first },
            Turn { waiting: second, bind_group: of_second },
        ];
        Ok(Self { width, height, capacities, lists, tiles, core, depth, progress, sums, turns })
    }

    /// Whether this is a canvas for such targets with such capacities.
    pub(crate) fn fits(&self, targets: &Targets, capacities: Capacities) -> bool {
        (self.width, self.height) == (targets.width(), targets.height())
            && self.capacities == capacities
    }

    /// Empties the lists of pixels and tiles, at the start of a frame.
    pub(crate) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        self.lists.clear(encoder);
        if let Some(tiles) = &self.tiles {
            tiles.bins.clear(encoder);
        }
    }

    /// Bytes on the adapter: 52 a pixel, the nodes, and what the tiles take.
    pub(crate) fn bytes(&self) -> u64 {
        let textures = 8 * u64::from(self.width) * u64::from(self.height);
        let tiles = self.tiles.as_ref().map_or(0, |tiles| tiles.bins.bytes());
        let waiting: u64 = self.turns.iter().map(|turn| turn.waiting.buffer().size()).sum();
        self.lists.bytes() + self.progress.size() + self.sums.size() + waiting + textures + tiles
    }
}

impl Tiles {
    /// Tiles with so many entries, bound together with the picture's lists and core distances.
    fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        entries: u32,
        lists: &Lists,
        core: &wgpu::TextureView,
    ) -> Result<Self, RenderError> {
        // An entry is a ball's rank.
        let bins = TileBins::new(gpu, entries, size_of::<u32>())?;
        let bind_group = gpu.checked(|| {
            let resources: [(u32, Resource<'_>); 5] = [
                (0, (&lists.heads).into()),
                (1, (&lists.pool).into()),
                (4, bins.marks().into()),
                (5, bins.entries().into()),
                (6, core.into()),
            ];
            bind_group(gpu, "illes tiles", &layouts.tiles, &resources)
        })?;
        Ok(Self { bins, bind_group })
    }
}

#[cfg(test)]
mod tests {
    use metaball_core::gpu::Specialization;
    use metaball_shaders::{compose, host_layout, struct_layout};

    use super::*;
    use crate::Options;

    #[test]
    fn progress_is_that_of_the_shader() {
        let spec = Specialization::without_balls().choosing(Options::PUBLISHED.modules());
        let module = compose("illes_fraglist/cast", &spec.variant()).expect("composes");
        let progress = host_layout!(Progress { stage, node, position, fallback });
        assert_eq!(struct_layout(&module, "Progress"), Some(progress));
    }
}
