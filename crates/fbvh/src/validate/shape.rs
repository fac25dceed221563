//! The order of nodes and leaves, and boxes inside boxes.

use metaball_core::Aabb;

use super::flaw::Flaw;
use crate::node::MAX_DEPTH;
use crate::tree::Child;
use crate::{Kind, Tree};

impl Tree {
    pub(super) fn check_shape(&self) -> Result<(), Flaw> {
        let (mut nodes, mut leaves) = (0, 0);
        let mut flaw = None;
        self.visit(|child, bounds, depth| {
            if flaw.is_some() {
                return false;
            }
            flaw = match *child {
                Child::Node(found) if found != nodes => {
                    Some(Flaw::NodeOrder { needed: nodes, found })
                }
                Child::Node(node) => {
                    nodes += 1;
                    self.check_children(node, bounds)
                }
                Child::Leaf(found) if found != leaves => {
                    Some(Flaw::LeafOrder { needed: leaves, found })
                }
                Child::Leaf(leaf) => {
                    leaves += 1;
                    if depth > MAX_DEPTH {
                        Some(Flaw::TooDeep { leaf, found: depth })
                    } else {
                        (self.leaves[leaf].bounds() != *bounds).then_some(Flaw::Leaf { leaf })
                    }
                }
            };
            true
        });
        if let Some(flaw) = flaw {
            return Err(flaw);
        }
        if nodes != self.nodes.len() || leaves != self.leaf_count() {
            return Err(Flaw::Leaf { leaf: leaves });
        }
        (0..self.nodes.len()).try_for_each(|node| self.check_first_right_leaf(node))
    }

    fn check_children(&self, node: usize, bounds: &Aabb) -> Option<Flaw> {
        let children = &self.nodes[node];
        let (left, right) = (children.left_bounds(), children.right_bounds());
        let inside = |child: &Aabb| !child.is_empty() && bounds.union(child) == *bounds;
        let axis = children.axis;
        if !inside(&left) || !inside(&right) {
            Some(Flaw::ChildOutside { node })
        } else if axis > 2
            || self.kind != Kind::ModifiedBvh && left.max[axis as usize] > right.min[axis as usize]
        {
            Some(Flaw::ChildrenOverlap { node, axis })
        } else {
            None
        }
    }

    fn check_first_right_leaf(&self, node: usize) -> Result<(), Flaw> {
        let mut leftmost = self.nodes[node].right;
        let needed = loop {
            match Child::read(leftmost) {
                Some(Child::Node(node)) => leftmost = self.nodes[node].left,
                Some(Child::Leaf(leaf)) => break leaf,
                None => return Err(Flaw::ChildOutside { node }),
            }
        };
        let found = self.nodes[node].first_right_leaf as usize;
        if needed == found { Ok(()) } else { Err(Flaw::FirstRightLeaf { node, needed, found }) }
    }
}
