//! The finished structure.

use metaball_core::Aabb;

use crate::Kind;
use crate::node::{EMPTY, LEAF, Leaf, Node};

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
    /// Which of the structures this is, and so how rays are traced through it.
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

    /// The list of a leaf: its own balls, then its split balls, as indices in the field.
    ///
    /// # Panics
    /// When there is no such leaf.
    pub fn leaf_balls(&self, leaf: usize) -> (&[u32], &[u32]) {
        self.list(leaf).split_at(self.leaves[leaf].own as usize)
    }

    /// The whole list of a leaf.
    #[inline]
    pub(crate) fn list(&self, leaf: usize) -> &[u32] {
        let (first, end) = (self.leaves[leaf].first, self.leaves[leaf + 1].first);
        &self.lists[first as usize..end as usize]
    }

    /// Calls the visitor with every node and leaf in preorder, with its box and the number of nodes
    /// above it. Does not descend where the visitor returns false.
    pub(crate) fn visit(&self, mut visitor: impl FnMut(&Child, &Aabb, usize) -> bool) {
        let mut open = vec![(self.root, self.bounds, 0)];
        while let Some((reference, bounds, depth)) = open.pop() {
            let Some(child) = Child::read(reference) else { continue };
            if !visitor(&child, &bounds, depth) {
                continue;
            }
            if let Child::Node(node) = child {
                let node = &self.nodes[node];
                open.push((node.right, node.right_bounds(), depth + 1));
                open.push((node.left, node.left_bounds(), depth + 1));
            }
        }
    }
}

/// What a child reference refers to.
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
