//! Orders in which a ray visits the leaves of a tree.

use metaball_core::{Aabb, Ray};

use super::counter::Counter;
use super::slabs::Slabs;
use crate::Tree;
use crate::node::{EMPTY, MAX_DEPTH};
use crate::tree::Child;

impl Tree {
    /// Where leaves do not overlap: the first find in the order of the ray. `search` is given a leaf
    /// and the interval of the ray in its box.
    pub(super) fn first_in_order<C: Counter, T>(
        &self,
        ray: &Ray,
        counter: &mut C,
        search: impl FnMut(usize, (f32, f32), &mut C) -> Option<T>,
    ) -> Option<T> {
        Slabs::new(ray).crossing(&self.bounds, ray.t_max)?;
        self.first_below(self.root, ray, counter, search)
    }

    /// The same in a subtree whose box the ray meets.
    pub(super) fn first_below<C: Counter, T>(
        &self,
        reference: u32,
        ray: &Ray,
        counter: &mut C,
        mut search: impl FnMut(usize, (f32, f32), &mut C) -> Option<T>,
    ) -> Option<T> {
        let slabs = Slabs::new(ray);
        let mut stack = Stack::new();
        let mut next = reference;
        loop {
            match Child::read(next)? {
                Child::Node(node) => {
                    counter.node();
                    let node = &self.nodes[node];
                    let left = slabs.crossing(&node.left_bounds(), ray.t_max);
                    let right = slabs.crossing(&node.right_bounds(), ray.t_max);
                    next = match (left, right) {
                        (Some(_), Some(_)) => {
                            if ray.direction[node.axis as usize] >= 0.0 {
                                stack.push(node.right, 0.0);
                                node.left
                            } else {
                                stack.push(node.left, 0.0);
                                node.right
                            }
                        }
                        (Some(_), None) => node.left,
                        (None, Some(_)) => node.right,
                        (None, None) => stack.pop().0,
                    };
                }
                Child::Leaf(leaf) => {
                    let bounds = self.leaves[leaf].bounds();
                    if let Some(interval) = slabs.crossing(&bounds, ray.t_max)
                        && let Some(find) = search(leaf, interval, counter)
                    {
                        return Some(find);
                    }
                    next = stack.pop().0;
                }
            }
        }
    }

    /// Where leaves overlap: the leaf with the nearest find, and its t. A leaf that the ray enters
    /// beyond the nearest find so far is not searched.
    pub(super) fn nearest_of_all<C: Counter>(
        &self,
        ray: &Ray,
        counter: &mut C,
        mut search: impl FnMut(usize, &mut C) -> Option<f32>,
    ) -> Option<(usize, f32)> {
        let slabs = Slabs::new(ray);
        let mut limit = ray.t_max;
        let mut found = None;
        let mut stack = Stack::new();
        slabs.crossing(&self.bounds, limit)?;
        let mut next = self.root;
        loop {
            match Child::read(next) {
                None => return found,
                Some(Child::Node(node)) => {
                    counter.node();
                    let node = &self.nodes[node];
                    let left = slabs.crossing(&node.left_bounds(), limit);
                    let right = slabs.crossing(&node.right_bounds(), limit);
                    next = match (left, right) {
                        (Some((left, _)), Some((right, _))) => {
                            if left <= right {
                                stack.push(node.right, right);
                                node.left
                            } else {
                                stack.push(node.left, left);
                                node.right
                            }
                        }
                        (Some(_), None) => node.left,
                        (None, Some(_)) => node.right,
                        (None, None) => stack.pop_before(limit),
                    };
                }
                Some(Child::Leaf(leaf)) => {
                    if let Some(t) = search(leaf, counter)
                        && (t < limit || found.is_none())
                    {
                        limit = t;
                        found = Some((leaf, t));
                    }
                    next = stack.pop_before(limit);
                }
            }
        }
    }

    /// A leaf that satisfies the test, of those whose boxes contain a point.
    pub(super) fn leaf_around(
        &self,
        contains: impl Fn(&Aabb) -> bool,
        test: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        if !contains(&self.bounds) {
            return None;
        }
        let mut stack = Stack::new();
        let mut next = self.root;
        loop {
            match Child::read(next)? {
                Child::Node(node) => {
                    let node = &self.nodes[node];
                    let left = contains(&node.left_bounds());
                    let right = contains(&node.right_bounds());
                    next = match (left, right) {
                        (true, true) => {
                            stack.push(node.right, 0.0);
                            node.left
                        }
                        (true, false) => node.left,
                        (false, true) => node.right,
                        (false, false) => stack.pop().0,
                    };
                }
                Child::Leaf(leaf) if test(leaf) => return Some(leaf),
                Child::Leaf(_) => next = stack.pop().0,
            }
        }
    }
}

/// Siblings still to be visited, with the distance at which the ray enters them. [`MAX_DEPTH`] says
/// why it cannot overflow.
struct Stack {
    entries: [(u32, f32); MAX_DEPTH],
    height: usize,
}

impl Stack {
    fn new() -> Self {
        Self { entries: [(EMPTY, 0.0); MAX_DEPTH], height: 0 }
    }

    fn push(&mut self, reference: u32, entry: f32) {
        self.entries[self.height] = (reference, entry);
        self.height += 1;
    }

    /// The last sibling; [`EMPTY`] when there is none left.
    fn pop(&mut self) -> (u32, f32) {
        if self.height == 0 {
            return (EMPTY, 0.0);
        }
        self.height -= 1;
        self.entries[self.height]
    }

    /// The last sibling that the ray enters before the limit.
    fn pop_before(&mut self, limit: f32) -> u32 {
        loop {
            let (reference, entry) = self.pop();
            if reference == EMPTY || entry <= limit {
                return reference;
            }
        }
    }
}
