//! The lists of a picture: a head for each pixel, and one pool of nodes.

use bytemuck::{Pod, Zeroable};
use metaball_core::gpu::{Gpu, RenderError};

/// A node of a list: WGSL's `Node` of `shaders/wgsl/illes_fraglist/lists.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Node {
    /// The ball, by its position in the frame's order.
    pub(crate) rank: u32,
    /// Index of the next node, counted from 1; 0 ends the list.
    pub(crate) next: u32,
}

/// What the pool has before the nodes: the head of WGSL's `Pool` of
/// `shaders/wgsl/illes_fraglist/lists.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct PoolHead {
    /// Nodes requested, also beyond the capacity.
    pub(crate) requested: u32,
    /// Rays that hit at a core.
    pub(crate) core_hits: u32,
}

/// What the lists of the last frame were like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ListStats {
    /// Nodes in all lists: pairs of a ray and a support that it meets before the core.
    pub nodes: u32,
    /// Rays that reached a core before the polynomial had a root, and hit there.
    pub core_hits: u32,
}

/// Buffers of the lists.
pub(crate) struct Lists {
    /// Index of each pixel's first node, counted from 1, row by row from the top left.
    pub(crate) heads: wgpu::Buffer,
    /// [`PoolHead`], and behind it the nodes.
    pub(crate) pool: wgpu::Buffer,
}

impl Lists {
    /// Lists for so many pixels, of so many nodes together.
    pub(crate) fn new(gpu: &Gpu, pixels: u64, nodes: u32) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        // An array without elements cannot be bound: there is always one node.
        let nodes = u64::from(nodes.max(1)) * size_of::<Node>() as u64;
        Ok(Self {
            heads: gpu.storage("illes list heads", 4 * pixels, none)?,
            pool: gpu.storage("illes list nodes", size_of::<PoolHead>() as u64 + nodes, none)?,
        })
    }

    /// Empties all lists.
    pub(crate) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.heads, 0, None);
        encoder.clear_buffer(&self.pool, 0, Some(size_of::<PoolHead>() as u64));
    }

    /// Bytes on the adapter.
    pub(crate) fn bytes(&self) -> u64 {
        self.heads.size() + self.pool.size()
    }

    /// Length of each pixel's list, row by row from the top left.
    pub(crate) fn lengths(&self, gpu: &Gpu) -> Result<Vec<u32>, RenderError> {
        // The head of the pool is as large as a node, and indices count from 1.
        const { assert!(size_of::<PoolHead>() == size_of::<Node>()) };
        let nodes = gpu.read::<Node>(&self.pool)?;
        let length = |head: u32| {
            let follow = |&node: &u32| (node != 0).then(|| nodes[node as usize].next);
            std::iter::successors(Some(head), follow).take_while(|&node| node != 0).count() as u32
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
        Ok(ListStats { nodes: head.requested, core_hits: head.core_hits })
    }
}

#[cfg(test)]
mod tests {
    use metaball_core::gpu::Specialization;
    use metaball_shaders::{compose, host_layout, struct_layout};

    use super::*;
    use crate::Options;

    #[test]
    fn structs_are_those_of_the_shaders() {
        let spec = Specialization::without_balls().choosing(Options::PUBLISHED.modules());
        let module = compose("illes_fraglist/cast", &spec.variant()).expect("composes");
        assert_eq!(struct_layout(&module, "Node"), Some(host_layout!(Node { rank, next })));
        let pool = struct_layout(&module, "Pool").expect("lists.wgsl has a pool");
        let head = host_layout!(PoolHead { requested, core_hits });
        assert_eq!(pool.members[..2], head.members[..]);
        assert_eq!(pool.members[2], ("nodes".to_owned(), head.size));
    }
}
