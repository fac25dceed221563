//! What validation can find.

use glam::DVec3;
use thiserror::Error;

use crate::node::MAX_DEPTH;

/// What is wrong with a tree: a bug of the builder, or the tree of another field.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Flaw {
    /// Nodes are not in preorder, each below one parent.
    #[error("node {found}: needed node {needed} here in preorder")]
    NodeOrder {
        /// The node due.
        needed: usize,
        /// The node found.
        found: usize,
    },
    /// Leaves are not numbered from left to right.
    #[error("leaf {found}: needed leaf {needed} here from left to right")]
    LeafOrder {
        /// The leaf due.
        needed: usize,
        /// The leaf found.
        found: usize,
    },
    /// `first_right_leaf` is not the leftmost leaf of the right child.
    #[error("node {node}: needed first_right_leaf {needed}, found {found}")]
    FirstRightLeaf {
        /// The node.
        node: usize,
        /// The leftmost leaf of its right child.
        needed: usize,
        /// The field's value.
        found: usize,
    },
    /// Arrays hold more than can be reached from the root, or a leaf's box differs from its parent's copy.
    #[error("leaf {leaf}: box or list differs from its parent or its neighbours")]
    Leaf {
        /// The leaf; the number of leaves where some are unreachable.
        leaf: usize,
    },
    /// More nodes above a leaf than a stack holds.
    #[error("leaf {leaf}: needed at most {MAX_DEPTH} nodes above it, found {found}")]
    TooDeep {
        /// The leaf.
        leaf: usize,
        /// Nodes above it.
        found: usize,
    },
    /// A child's box reaches beyond its parent's, or is empty.
    #[error("node {node}: a child's box is empty or reaches beyond the node's")]
    ChildOutside {
        /// The parent.
        node: usize,
    },
    /// Children of a Fitted BVH overlap.
    #[error("node {node}: children overlap along axis {axis}")]
    ChildrenOverlap {
        /// The parent.
        node: usize,
        /// The axis of its plane.
        axis: u32,
    },
    /// A list names a ball that does not exist, or one twice.
    #[error("leaf {leaf}: ball {ball} is unknown or listed twice")]
    Listing {
        /// The leaf.
        leaf: usize,
        /// The ball.
        ball: u32,
    },
    /// A ball is own in more leaves than one, or, in the modified BVH, in none.
    #[error("ball {ball}: needed to be own in one leaf, found {found}")]
    Ownership {
        /// The ball.
        ball: u32,
        /// Leaves in which it is own.
        found: usize,
    },
    /// In the modified BVH: an own ball's support reaches beyond the leaf's box.
    #[error("leaf {leaf}: own ball {ball} reaches beyond the box")]
    OwnOutside {
        /// The leaf.
        leaf: usize,
        /// The ball.
        ball: u32,
    },
    /// A list lacks a ball that makes a difference to the surface.
    #[error("leaf {leaf}: ball {ball} is missing from the list")]
    Incomplete {
        /// The leaf.
        leaf: usize,
        /// The ball.
        ball: u32,
    },
    /// In the certified tree: a leaf without a list has a point where the field is at T or below.
    #[error("leaf {leaf}: needed a field above T everywhere, found less at {point}")]
    NotSolid {
        /// The leaf.
        leaf: usize,
        /// The point, world space, scene units.
        point: DVec3,
    },
    /// A point of the surface is in no leaf's box.
    #[error("ball {ball}: the surface at {point} is in no leaf")]
    SurfaceOutside {
        /// The ball from whose centre the point was found.
        ball: u32,
        /// The point, world space, scene units.
        point: DVec3,
    },
}
