//! Subtrees under construction, and how they become one tree.

use std::iter;

use bytemuck::Zeroable;
use metaball_core::Aabb;

use super::error::BuildError;
use crate::Tree;
use crate::node::{EMPTY, LEAF, Leaf, Node};
use crate::options::Kind;

/// A subtree: what different threads have made of it, one piece behind the other.
pub(super) struct Branch {
    pieces: Vec<Piece>,
}

/// Nodes and leaves in preorder. References count from the piece's own first node and first leaf,
/// and may reach into the pieces behind.
#[derive(Default)]
struct Piece {
    /// A node of whose parts none or only one turns out to hold surface stays vacant and is removed in
    /// the end.
    nodes: Vec<Node>,
    /// Until [`Branch::finish`], `first` is the length of the leaf's list.
    leaves: Vec<Leaf>,
    lists: Vec<u32>,
}

const VACANT: Node = Node {
    left_min: [0.0; 3],
    left: EMPTY,
    left_max: [0.0; 3],
    right: EMPTY,
    right_min: [0.0; 3],
    axis: 0,
    right_max: [0.0; 3],
    first_right_leaf: 0,
};

/// A reference, shifted by so many nodes and leaves.
fn shifted(reference: u32, nodes: usize, leaves: usize) -> u32 {
    if reference & LEAF != 0 { reference + leaves as u32 } else { reference + nodes as u32 }
}

impl Branch {
    pub(super) fn new() -> Self {
        Self { pieces: vec![Piece::default()] }
    }

    /// The piece that grows. Once others lie behind it, only its vacant nodes are filled.
    fn first(&mut self) -> &mut Piece {
        &mut self.pieces[0]
    }

    /// Leaves of all pieces.
    pub(super) fn leaf_count(&self) -> usize {
        self.pieces.iter().map(|piece| piece.leaves.len()).sum()
    }

    fn node_count(&self) -> usize {
        self.pieces.iter().map(|piece| piece.nodes.len()).sum()
    }

    /// Reserves the next node in preorder, and returns its index.
    pub(super) fn push_vacant(&mut self) -> usize {
        let nodes = &mut self.first().nodes;
        nodes.push(VACANT);
        nodes.len() - 1
    }

    /// Fills a reserved node, and returns the reference to it.
    pub(super) fn fill(&mut self, index: usize, node: Node) -> u32 {
        self.first().nodes[index] = node;
        index as u32
    }

    /// Adds a leaf, and returns the reference to it.
    pub(super) fn push_leaf(
        &mut self,
        bounds: &Aabb,
        own: impl Iterator<Item = u32>,
        split: impl Iterator<Item = u32>,
    ) -> u32 {
        let Piece { leaves, lists, .. } = self.first();
        let start = lists.len();
        lists.extend(own);
        let own = lists.len() - start;
        lists.extend(split);
        leaves.push(Leaf {
            min: bounds.min.into(),
            first: (lists.len() - start) as u32,
            max: bounds.max.into(),
            own: own as u32,
        });
        LEAF | (leaves.len() - 1) as u32
    }

    /// Makes one leaf of a node's two parts if both are solid, that is leaves without lists, and fill
    /// one box.
    pub(super) fn merge_solids(
        &mut self,
        node: usize,
        axis: usize,
        left: &Aabb,
        right: &Aabb,
    ) -> Option<(u32, Aabb)> {
        let is_last = self.pieces.len() == 1 && self.first().nodes.len() == node + 1;
        let [.., before, last] = self.first().leaves.as_slice() else { return None };
        if !is_last || before.first > 0 || last.first > 0 || left.max[axis] < right.min[axis] {
            return None;
        }
        let across = |side: &Aabb| {
            let (mut min, mut max) = (side.min, side.max);
            (min[axis], max[axis]) = (0.0, 0.0);
            (min, max)
        };
        if across(left) != across(right) {
            return None;
        }
        let Piece { nodes, leaves, .. } = self.first();
        nodes.pop();
        leaves.truncate(leaves.len() - 2);
        let whole = left.union(right);
        Some((self.push_leaf(&whole, iter::empty(), iter::empty()), whole))
    }

    /// Appends a subtree to this one, and returns its root's new reference.
    pub(super) fn append(&mut self, other: Self, root: Option<(u32, Aabb)>) -> Option<(u32, Aabb)> {
        let (nodes, leaves) = (self.node_count(), self.leaf_count());
        self.pieces.extend(other.pieces);
        root.map(|(root, bounds)| (shifted(root, nodes, leaves), bounds))
    }

    /// Lays the pieces out as one tree, without the vacant nodes, and with the lengths of lists
    /// turned into their starts. Checks that the indices are wide enough.
    pub(super) fn finish(self, root: Option<(u32, Aabb)>, kind: Kind) -> Result<Tree, BuildError> {
        let pieces = self.pieces;
        let total = |count: fn(&Piece) -> usize| pieces.iter().map(count).sum::<usize>();
        let entries = total(|piece| piece.lists.len());
        check("leaves", total(|piece| piece.leaves.len()), (LEAF - 1) as usize)?;
        check("list entries", entries, u32::MAX as usize)?;

        let lists = || {
            let mut lists = Vec::with_capacity(entries);
            pieces.iter().for_each(|piece| lists.extend_from_slice(&piece.lists));
            lists
        };
        let (nodes, (leaves, lists)) =
            rayon::join(|| lay_nodes(&pieces), || (lay_leaves(&pieces), lists()));
        let (nodes, numbers) = nodes;
        let (root, bounds) = root.unwrap_or((EMPTY, Aabb::EMPTY));
        let root = if root & LEAF != 0 { root } else { numbers[root as usize] };
        Ok(Tree { nodes, leaves, lists, root, bounds, kind })
    }
}

/// All nodes but the vacant ones, and the new number of each.
fn lay_nodes(pieces: &[Piece]) -> (Vec<Node>, Vec<u32>) {
    let all = || pieces.iter().flat_map(|piece| &piece.nodes);
    let mut numbers = Vec::with_capacity(pieces.iter().map(|piece| piece.nodes.len()).sum());
    let mut kept = 0;
    numbers.extend(all().map(|node| {
        let number = kept;
        kept += u32::from(node.left != EMPTY);
        number
    }));

    let mut nodes = Vec::with_capacity(kept as usize);
    let (mut first_node, mut first_leaf) = (0, 0);
    for piece in pieces {
        let renumbered = |reference: u32| match shifted(reference, first_node, first_leaf) {
            leaf if leaf & LEAF != 0 => leaf,
            node => numbers[node as usize],
        };
        nodes.extend(piece.nodes.iter().filter(|node| node.left != EMPTY).map(|node| Node {
            left: renumbered(node.left),
            right: renumbered(node.right),
            first_right_leaf: node.first_right_leaf + first_leaf as u32,
            ..*node
        }));
        first_node += piece.nodes.len();
        first_leaf += piece.leaves.len();
    }
    (nodes, numbers)
}

/// All leaves and the sentinel, with the starts of their lists.
fn lay_leaves(pieces: &[Piece]) -> Vec<Leaf> {
    let mut first = 0;
    let mut leaves =
        Vec::with_capacity(pieces.iter().map(|piece| piece.leaves.len()).sum::<usize>() + 1);
    for leaf in pieces.iter().flat_map(|piece| &piece.leaves) {
        leaves.push(Leaf { first, ..*leaf });
        first += leaf.first;
    }
    leaves.push(Leaf { first, ..Leaf::zeroed() });
    leaves
}

fn check(what: &'static str, found: usize, limit: usize) -> Result<(), BuildError> {
    if found <= limit { Ok(()) } else { Err(BuildError::TooMany { what, found, limit }) }
}
