//! The finished structure.

use metaball_core::Aabb;

use crate::build::{self, BuildError};
use crate::node::{EMPTY, LEAF, Leaf, Node};
use crate::{Field, Kind, Options};

/// A bounding volume hierarchy over the balls of one field, for one kernel and threshold.
///
/// Immutable; it names balls by index and holds no reference to them.
#[derive(Debug, Clone, PartialEq)]
pub struct Tree {
    pub(crate) nodes: Vec<Node>,
    pub(crate) leaves: Vec<Leaf>,
    pub(crate) lists: Vec<u32>,
    pub(crate) root: u32,
    pub(crate) bounds: Aabb,
    pub(crate) kind: Kind,
}

impl Tree {
    /// Builds the structure that the options describe. Runs on rayon's current pool; the result is
    /// the same bit for bit whatever the number of threads.
    ///
    /// # Errors
    /// Names the ball that cannot be placed, or says how many list entries were too many.
    pub fn build(field: &impl Field, options: &Options) -> Result<Self, BuildError> {
        build::build(field, options)
    }

    /// Which of the two structures this is, and so how a ray must go through it.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Interior nodes in preorder; the first one is the root unless the root is a leaf.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Leaves from left to right, and after them the sentinel that ends the last list.
    pub fn leaves(&self) -> &[Leaf] {
        &self.leaves
    }

    /// The lists of all leaves, one after the other: indices of balls.
    pub fn lists(&self) -> &[u32] {
        &self.lists
    }

    /// Reference to the root: an index of [`Tree::nodes`], or [`LEAF`] plus the number of the only
    /// leaf, or [`EMPTY`] where the field reaches its threshold nowhere.
    pub fn root(&self) -> u32 {
        self.root
    }

    /// Box of the root, world space, scene units. Empty when the root is.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Whether there is no leaf: no ray hits anything.
    pub fn is_empty(&self) -> bool {
        self.root == EMPTY
    }

    /// Number of leaves.
    pub fn leaf_count(&self) -> usize {
        self.leaves.len() - 1
    }

    /// The list of a leaf: its own balls, then its split balls. Panics when there is no such leaf.
    pub fn leaf_balls(&self, leaf: usize) -> (&[u32], &[u32]) {
        let Leaf { first, own, .. } = self.leaves[leaf];
        let end = self.leaves[leaf + 1].first;
        self.lists[first as usize..end as usize].split_at(own as usize)
    }
}

/// What a child reference points at.
pub(crate) enum Child {
    Node(usize),
    Leaf(usize),
}

impl Child {
    /// Reads a reference; `None` for [`EMPTY`].
    pub(crate) fn read(reference: u32) -> Option<Self> {
        match reference {
            EMPTY => None,
            leaf if leaf & LEAF != 0 => Some(Self::Leaf((leaf & !LEAF) as usize)),
            node => Some(Self::Node(node as usize)),
        }
    }
}
