//! Nodes and leaves as they are uploaded to the GPU: the twins of the structs in
//! `shaders/wgsl/fbvh/structure.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use metaball_core::Aabb;

/// The bit of a child reference that marks a leaf; the other bits are the leaf's number.
pub const LEAF: u32 = 1 << 31;

/// The reference to nothing: the root of a tree without leaves.
pub const EMPTY: u32 = u32::MAX;

/// The most interior nodes on a path from the root to a leaf. A traversal keeps at most one sibling
/// for each of them, so a stack of this many entries cannot overflow. The builder guarantees it: see
/// [`Options::max_depth`](crate::Options::max_depth).
pub const MAX_DEPTH: usize = 64;

/// An interior node, 64 bytes: the boxes of both children, so that a traversal reads one record to
/// choose between them. Interior nodes lie in preorder, leaves are numbered in the same order from left
/// to right.
///
/// A child reference is the index of an interior node, or [`LEAF`] plus the number of a leaf.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Node {
    /// Least corner of the left child's box, world space, scene units.
    pub left_min: [f32; 3],
    /// Reference to the left child, the one towards −∞ along `axis`.
    pub left: u32,
    /// Greatest corner of the left child's box.
    pub left_max: [f32; 3],
    /// Reference to the right child.
    pub right: u32,
    /// Least corner of the right child's box.
    pub right_min: [f32; 3],
    /// Axis of the splitting plane: 0, 1 or 2.
    pub axis: u32,
    /// Greatest corner of the right child's box.
    pub right_max: [f32; 3],
    /// Number of the leftmost leaf below the right child: leaves with smaller numbers are below the
    /// left child. A traversal that was interrupted at a leaf descends to it again by this.
    pub first_right_leaf: u32,
}

impl Node {
    /// Box of the left child.
    pub fn left_bounds(&self) -> Aabb {
        Aabb { min: Vec3::from(self.left_min), max: Vec3::from(self.left_max) }
    }

    /// Box of the right child.
    pub fn right_bounds(&self) -> Aabb {
        Aabb { min: Vec3::from(self.right_min), max: Vec3::from(self.right_max) }
    }
}

/// A leaf, 32 bytes: its box and where its list of balls starts.
///
/// The list of leaf i is `lists[leaves[i].first .. leaves[i + 1].first]`; a sentinel closes the
/// array of leaves. The first `own` entries are the leaf's own balls, the rest split balls.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Leaf {
    /// Least corner of the box, world space, scene units.
    pub min: [f32; 3],
    /// Index in the lists of the leaf's first entry.
    pub first: u32,
    /// Greatest corner of the box.
    pub max: [f32; 3],
    /// Number of own balls at the head of the list.
    pub own: u32,
}

impl Leaf {
    /// The leaf's box.
    pub fn bounds(&self) -> Aabb {
        Aabb { min: Vec3::from(self.min), max: Vec3::from(self.max) }
    }
}
