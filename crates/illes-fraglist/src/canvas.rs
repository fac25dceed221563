//! What the lists of one picture are kept in.

use bytemuck::{Pod, Zeroable};
use metaball_core::gpu::{Gpu, RenderError, Targets};

use crate::pipelines::Layouts;
use crate::tiles::TileRoom;

/// A node of a list: WGSL's `Node` of `illes_fraglist/lists.wgsl`. The host only needs its size.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Node {
    pub(crate) rank: u32,
    pub(crate) next: u32,
}

/// What stands before the nodes: the head of WGSL's `Pool` of `illes_fraglist/lists.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct PoolHead {
    /// Nodes asked for.
    pub(crate) asked: u32,
    pub(crate) core_hits: u32,
}

/// Where a pixel stands between two dispatches: WGSL's `Progress` of `illes_fraglist/cast.wgsl`. The
/// host only needs its size.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Progress {
    pub(crate) stage: u32,
    pub(crate) place: u32,
    pub(crate) position: f32,
    pub(crate) fallback: u32,
}

/// What the lists of the last frame were like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ListStats {
    /// Nodes in all lists: pairs of a ray and a support that it meets before the core.
    pub nodes: u32,
    /// Rays that reached a core before the polynomial had a root, and hit there.
    pub core_hits: u32,
}

/// Distances to cores are read as they were written; depth is for the test alone.
pub(crate) const CORE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What a canvas has room for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Rooms {
    /// List nodes.
    pub(crate) nodes: u32,
    /// Entries of all tiles; `None`: no tiles.
    pub(crate) entries: Option<u32>,
}

/// Core depth, lists and progress of a picture of one size.
pub(crate) struct Canvas {
    width: u32,
    height: u32,
    rooms: Rooms,
    /// Where lists are gathered by tiles.
    pub(crate) tiles: Option<TileRoom>,
    pub(crate) core: wgpu::TextureView,
    pub(crate) depth: wgpu::TextureView,
    heads: wgpu::Buffer,
    pool: wgpu::Buffer,
    progress: wgpu::Buffer,
    pub(crate) bind_group: wgpu::BindGroup,
}

impl Canvas {
    /// Room for a picture of the targets' size.
    pub(crate) fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        targets: &Targets,
        rooms: Rooms,
    ) -> Result<Self, RenderError> {
        let (width, height) = (targets.width(), targets.height());
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if width > limit || height > limit {
            return Err(RenderError::PictureSize { width, height, limit });
        }
        let none = wgpu::BufferUsages::empty();
        let pixels = u64::from(width) * u64::from(height);
        // An array without elements cannot be bound: there is always one node.
        let nodes = rooms.nodes.max(1);
        let pool_bytes = size_of::<PoolHead>() as u64 + u64::from(nodes) * size_of::<Node>() as u64;
        let heads = gpu.storage("illes list heads", 4 * pixels, none)?;
        let pool = gpu.storage("illes list nodes", pool_bytes, none)?;
        let progress =
            gpu.storage("illes progress", pixels * size_of::<Progress>() as u64, none)?;
        let writer = match rooms.entries {
            Some(_) => wgpu::TextureUsages::STORAGE_BINDING,
            None => wgpu::TextureUsages::empty(),
        };
        let (core, depth, bind_group) = gpu.checked(|| {
            let core = texture(gpu, "illes core distance", CORE_FORMAT, writer, (width, height));
            let none = wgpu::TextureUsages::empty();
            let depth = texture(gpu, "illes core depth", DEPTH_FORMAT, none, (width, height));
            let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
            let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("illes lists"),
                layout: &layouts.lists,
                entries: &[
                    entry(0, heads.as_entire_binding()),
                    entry(1, pool.as_entire_binding()),
                    entry(2, wgpu::BindingResource::TextureView(&core)),
                    entry(3, progress.as_entire_binding()),
                ],
            });
            (core, depth, bind_group)
        })?;
        let tiles = rooms
            .entries
            .map(|entries| TileRoom::new(gpu, layouts, entries, (&heads, &pool), &core))
            .transpose()?;
        Ok(Self { width, height, rooms, tiles, core, depth, heads, pool, progress, bind_group })
    }

    /// Whether this is a canvas for such targets with such rooms.
    pub(crate) fn fits(&self, targets: &Targets, rooms: Rooms) -> bool {
        (self.width, self.height) == (targets.width(), targets.height()) && self.rooms == rooms
    }

    /// Empties all lists: at the start of a frame.
    pub(crate) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.heads, 0, None);
        encoder.clear_buffer(&self.pool, 0, Some(size_of::<PoolHead>() as u64));
        encoder.clear_buffer(&self.progress, 0, None);
    }

    /// Bytes on the device: 28 a pixel, the nodes, and what the tiles take.
    pub(crate) fn bytes(&self) -> u64 {
        let textures = 8 * u64::from(self.width) * u64::from(self.height);
        self.heads.size()
            + self.pool.size()
            + self.progress.size()
            + textures
            + self.tiles.as_ref().map_or(0, TileRoom::bytes)
    }

    /// Length of each pixel's list, row by row from the top left.
    pub(crate) fn list_lengths(&self, gpu: &Gpu) -> Result<Vec<u32>, RenderError> {
        // The head is as large as a node, and places count from 1.
        const { assert!(size_of::<PoolHead>() == size_of::<Node>()) };
        let nodes = gpu.read::<Node>(&self.pool)?;
        let length = |head: u32| {
            let mut places = std::iter::successors(Some(head), |&place| {
                (place != 0).then(|| nodes[place as usize].next)
            });
            places.by_ref().take_while(|&place| place != 0).count() as u32
        };
        Ok(gpu.read::<u32>(&self.heads)?.into_iter().map(length).collect())
    }

    /// What the last frame left in the head of the pool.
    pub(crate) fn stats(&self, gpu: &Gpu) -> Result<ListStats, RenderError> {
        let bytes = size_of::<PoolHead>() as u64;
        let copy = gpu.storage("illes list statistics", bytes, wgpu::BufferUsages::empty())?;
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.copy_buffer_to_buffer(&self.pool, 0, &copy, 0, bytes);
            gpu.queue.submit([encoder.finish()]);
        })?;
        let head = gpu.read::<PoolHead>(&copy)?[0];
        Ok(ListStats { nodes: head.asked, core_hits: head.core_hits })
    }
}

fn texture(
    gpu: &Gpu,
    label: &str,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
    (width, height): (u32, u32),
) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | usage,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

#[cfg(test)]
mod tests {
    use metaball_shaders::{KernelModule, Variant, compose, host_layout, struct_layout};

    use super::*;

    #[test]
    fn structs_are_those_of_the_shaders() {
        let variant = Variant {
            kernel: KernelModule::Power,
            radii: false,
            strengths: false,
            colors: false,
            counting: false,
            chosen: &["illes_fraglist/piece/cubic", "illes_fraglist/overlap/printed"],
        };
        let module = compose("illes_fraglist/cast", &variant).expect("composes");
        assert_eq!(struct_layout(&module, "Node"), Some(host_layout!(Node { rank, next })));
        let progress = host_layout!(Progress { stage, place, position, fallback });
        assert_eq!(struct_layout(&module, "Progress"), Some(progress));
        let pool = struct_layout(&module, "Pool").expect("lists.wgsl has a pool");
        let head = host_layout!(PoolHead { asked, core_hits });
        assert_eq!(pool.members[..2], head.members[..]);
        assert_eq!(pool.members[2], ("nodes".to_owned(), head.size));
    }
}
