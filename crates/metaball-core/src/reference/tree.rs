//! Which balls may matter: a plain binary tree of boxes.

use glam::DVec3;

use crate::{Aabb, Support};

/// Balls in a leaf. Few enough that a leaf costs less than the boxes it saves.
const LEAF_SIZE: usize = 4;

/// A tree of boxes around support spheres, halved at the median centre along the longest side, so
/// that it is balanced whatever the balls.
#[derive(Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// Indices of balls; each leaf owns a range.
    order: Vec<u32>,
}

#[derive(Debug)]
struct Node {
    min: DVec3,
    max: DVec3,
    content: Content,
}

#[derive(Debug)]
enum Content {
    /// Range of `order`.
    Leaf { start: usize, end: usize },
    /// The first child follows its parent; this is the second.
    Inner { second: usize },
}

impl Tree {
    pub(super) fn new(supports: &[Support]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: Vec::new() };
        // `Scene` holds no more balls than a u32 can name.
        let mut order: Vec<u32> = (0..supports.len() as u32).collect();
        if !supports.is_empty() {
            tree.grow(supports, &mut order, 0);
        }
        tree.order = order;
        tree
    }

    /// Visits every ball in a leaf such that `keep` holds for the leaf's box (least and greatest
    /// corner) and all boxes around it, always in the same order.
    pub(super) fn for_each(
        &self,
        keep: impl Fn(DVec3, DVec3) -> bool,
        mut visit: impl FnMut(usize),
    ) {
        let mut pending = Vec::with_capacity(64);
        pending.extend((!self.nodes.is_empty()).then_some(0));
        while let Some(index) = pending.pop() {
            let node = &self.nodes[index];
            if !keep(node.min, node.max) {
                continue;
            }
            match node.content {
                Content::Inner { second } => pending.extend([second, index + 1]),
                Content::Leaf { start, end } => {
                    self.order[start..end].iter().for_each(|&ball| visit(ball as usize));
                }
            }
        }
    }

    /// Appends the subtree of the balls in `order`, which begins at `start` of the whole order.
    fn grow(&mut self, supports: &[Support], order: &mut [u32], start: usize) {
        let support = |index: u32| supports[index as usize];
        let bounds = order.iter().fold(Aabb::EMPTY, |bounds, &index| {
            bounds.union(&Aabb::around_sphere(support(index).center, support(index).radius))
        });
        let node = self.nodes.len();
        let content = Content::Leaf { start, end: start + order.len() };
        self.nodes.push(Node { min: bounds.min.as_dvec3(), max: bounds.max.as_dvec3(), content });
        if order.len() <= LEAF_SIZE {
            return;
        }

        let centers = order.iter().fold(Aabb::EMPTY, |bounds, &index| {
            bounds.union(&Aabb { min: support(index).center, max: support(index).center })
        });
        let axis = centers.extent().max_position();
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |&a, &b| {
            support(a).center[axis].total_cmp(&support(b).center[axis]).then(a.cmp(&b))
        });
        let (first, second) = order.split_at_mut(half);
        self.grow(supports, first, start);
        self.nodes[node].content = Content::Inner { second: self.nodes.len() };
        self.grow(supports, second, start + half);
    }
}
