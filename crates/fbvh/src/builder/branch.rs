//! Subtrees under construction, and how they become one tree.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{iter, mem};

use bytemuck::Zeroable;
use metaball_core::Aabb;
use rayon::prelude::*;

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
#[derive(Default, Clone)]
pub(super) struct Piece {
    /// A node of whose parts none or only one turns out to hold surface stays vacant and is removed in
    /// the end.
    nodes: Vec<Node>,
    /// Until [`Branch::finish`], `first` is the length of the leaf's list.
    leaves: Vec<Leaf>,
    lists: Vec<u32>,
}

impl Piece {
    fn clear(&mut self) {
        self.nodes.clear();
        self.leaves.clear();
        self.lists.clear();
    }
}

/// Pieces that have grown already, for others to grow in without moving.
#[derive(Default)]
pub(super) struct GrownPieces(Mutex<Vec<Piece>>);

impl GrownPieces {
    fn pieces(&self) -> MutexGuard<'_, Vec<Piece>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lets a subtree grow in one of them, and keeps no more of it than the subtree needs.
    pub(super) fn grow<T>(&self, subtree: impl FnOnce(&mut Branch) -> T) -> (Branch, T) {
        let piece = self.pieces().pop().unwrap_or_default();
        let mut branch = Branch { pieces: vec![piece] };
        let root = subtree(&mut branch);
        let first = branch.first();
        let exact = first.clone();
        let mut grown = mem::replace(first, exact);
        grown.clear();
        self.pieces().push(grown);
        (branch, root)
    }
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
        let mut pieces = self.pieces;
        let total = |count: fn(&Piece) -> usize| pieces.iter().map(count).sum::<usize>();
        let entries = total(|piece| piece.lists.len());
        check("leaves", total(|piece| piece.leaves.len()), (LEAF - 1) as usize)?;
        check("list entries", entries, u32::MAX as usize)?;

        // One array after the other, and each piece's goes when it is copied: two trees never exist at
        // once.
        let starts = Start::of(&pieces);
        let lists = lay_lists(&mut pieces);
        let leaves = lay_leaves(&mut pieces, &starts, entries as u32);
        let (nodes, numbers) = lay_nodes(pieces, &starts);
        let (root, bounds) = root.unwrap_or((EMPTY, Aabb::EMPTY));
        let root = if root & LEAF != 0 { root } else { numbers.of_node(root) };
        Ok(Tree { nodes, leaves, lists, root, bounds, kind })
    }
}

/// What lies before a piece.
struct Start {
    nodes: usize,
    leaves: usize,
    entries: usize,
}

impl Start {
    fn of(pieces: &[Piece]) -> Vec<Self> {
        let (mut nodes, mut leaves, mut entries) = (0, 0, 0);
        let start = |piece: &Piece| {
            let start = Self { nodes, leaves, entries };
            nodes += piece.nodes.len();
            leaves += piece.leaves.len();
            entries += piece.lists.len();
            start
        };
        pieces.iter().map(start).collect()
    }
}

/// An array in parts of these lengths.
fn split<T>(mut array: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    let part = |length: usize| {
        let (part, rest) = mem::take(&mut array).split_at_mut(length);
        array = rest;
        part
    };
    lengths.map(part).collect()
}

/// All lists, which are taken from their pieces.
fn lay_lists(pieces: &mut [Piece]) -> Vec<u32> {
    let mut lists = vec![0; pieces.iter().map(|piece| piece.lists.len()).sum()];
    let parts = split(&mut lists, pieces.iter().map(|piece| piece.lists.len()));
    parts.into_par_iter().zip(pieces).for_each(|(part, piece)| {
        part.copy_from_slice(&mem::take(&mut piece.lists));
    });
    lists
}

/// All leaves and the sentinel, with the starts of their lists. The leaves are taken from their pieces.
fn lay_leaves(pieces: &mut [Piece], starts: &[Start], entries: u32) -> Vec<Leaf> {
    let count = pieces.iter().map(|piece| piece.leaves.len()).sum::<usize>();
    let sentinel = Leaf { first: entries, ..Leaf::zeroed() };
    let mut leaves: Vec<_> = (0..=count).into_par_iter().map(|_| sentinel).collect();
    let parts = split(&mut leaves, pieces.iter().map(|piece| piece.leaves.len()));
    parts.into_par_iter().zip(pieces).zip(starts).for_each(|((part, piece), start)| {
        let mut first = start.entries as u32;
        for (to, leaf) in iter::zip(part, mem::take(&mut piece.leaves)) {
            *to = Leaf { first, ..leaf };
            first += leaf.first;
        }
    });
    leaves
}

/// All nodes but the vacant ones, and their new numbers.
fn lay_nodes(pieces: Vec<Piece>, starts: &[Start]) -> (Vec<Node>, Numbers) {
    let numbers = Numbers::of(pieces.iter().flat_map(|piece| &piece.nodes));
    let mut nodes: Vec<_> = (0..numbers.count).into_par_iter().map(|_| VACANT).collect();
    let kept = |piece: &Piece| piece.nodes.iter().filter(|node| node.left != EMPTY).count();
    let parts = split(&mut nodes, pieces.iter().map(kept));
    parts.into_par_iter().zip(pieces).zip(starts).for_each(|((part, piece), start)| {
        let renumbered = |reference: u32| match shifted(reference, start.nodes, start.leaves) {
            leaf if leaf & LEAF != 0 => leaf,
            node => numbers.of_node(node),
        };
        let kept = piece.nodes.iter().filter(|node| node.left != EMPTY);
        for (to, node) in iter::zip(part, kept) {
            *to = Node {
                left: renumbered(node.left),
                right: renumbered(node.right),
                first_right_leaf: node.first_right_leaf + start.leaves as u32,
                ..*node
            };
        }
    });
    (nodes, numbers)
}

/// The numbers of nodes when the vacant ones are removed.
struct Numbers {
    /// Of 64 nodes each: which are kept, and how many before.
    blocks: Vec<(u64, u32)>,
    /// Of all that are kept.
    count: u32,
}

impl Numbers {
    fn of<'a>(nodes: impl Iterator<Item = &'a Node>) -> Self {
        let (mut blocks, mut count) = (Vec::new(), 0);
        for (at, node) in nodes.enumerate() {
            if at % 64 == 0 {
                blocks.push((0, count));
            }
            if node.left != EMPTY {
                blocks[at / 64].0 |= 1 << (at % 64);
                count += 1;
            }
        }
        Self { blocks, count }
    }

    fn of_node(&self, node: u32) -> u32 {
        let (kept, before) = self.blocks[node as usize / 64];
        before + (kept & ((1 << (node % 64)) - 1)).count_ones()
    }
}

fn check(what: &'static str, found: usize, limit: usize) -> Result<(), BuildError> {
    if found <= limit { Ok(()) } else { Err(BuildError::TooMany { what, found, limit }) }
}
