//! How large a tree is.

use crate::Tree;
use crate::node::{Leaf, Node};
use crate::tree::Child;

/// How large a tree is: the columns of the paper's tables and plots.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stats {
    /// Interior nodes.
    pub nodes: usize,
    /// Leaves.
    pub leaves: usize,
    /// Entries of all lists, own and split.
    pub list_entries: usize,
    /// Memory of nodes, leaves and lists, bytes: all that is uploaded.
    pub bytes: usize,
    /// Interior nodes on the longest path from the root to a leaf.
    pub depth: usize,
    /// Own balls of the leaves.
    pub own: Spread,
    /// Split balls of the leaves.
    pub split: Spread,
}

/// Mean and maximum over leaves; zeros where there are none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Spread {
    /// The mean.
    pub mean: f64,
    /// The maximum.
    pub max: usize,
}

impl Spread {
    fn of(counts: impl ExactSizeIterator<Item = usize>) -> Self {
        let leaves = counts.len().max(1);
        let (sum, max) =
            counts.fold((0, 0), |(sum, max): (usize, usize), count| (sum + count, max.max(count)));
        Self { mean: sum as f64 / leaves as f64, max }
    }
}

impl Tree {
    /// Counts nodes, leaves and list entries.
    pub fn stats(&self) -> Stats {
        let lists = || (0..self.leaf_count()).map(|leaf| self.leaf_balls(leaf));
        Stats {
            nodes: self.nodes.len(),
            leaves: self.leaf_count(),
            list_entries: self.lists.len(),
            bytes: size_of_val::<[Node]>(&self.nodes)
                + size_of_val::<[Leaf]>(&self.leaves)
                + size_of_val::<[u32]>(&self.lists),
            depth: self.depth(),
            own: Spread::of(lists().map(|(own, _)| own.len())),
            split: Spread::of(lists().map(|(_, split)| split.len())),
        }
    }

    fn depth(&self) -> usize {
        let mut deepest = 0;
        self.visit(|child, _, depth| {
            if let Child::Leaf(_) = child {
                deepest = deepest.max(depth);
            }
            true
        });
        deepest
    }
}
