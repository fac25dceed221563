//! Nodes on their way to being divided, and what dividing them makes.

use std::ops::Range;

use glam::Vec3A;
use metaball_core::Aabb;

use super::ball::Ball;
use super::plane::Plane;

/// A node to be divided, without the own balls of the modified BVH, which are kept in a slice.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// Its other balls in the pool: split balls in the modified BVH, all of them elsewhere.
    pub(super) list: Range<usize>,
    pub(super) bounds: Aabb,
    pub(super) cell: Cell,
    pub(super) depth: usize,
}

/// The part of space on a node's side of all planes above it: in the Fitted BVH its own balls are
/// those of its list whose centres are in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cell {
    min: Vec3A,
    end: Vec3A,
}

impl Cell {
    pub(super) const ALL: Self = Self { min: Vec3A::NEG_INFINITY, end: Vec3A::INFINITY };

    pub(super) fn cut(self, plane: &Plane) -> (Self, Self) {
        let (mut left, mut right) = (self, self);
        left.end[plane.axis] = plane.at;
        right.min[plane.axis] = plane.at;
        (left, right)
    }

    pub(super) fn owns(&self, ball: &Ball) -> bool {
        (ball.center().cmpge(self.min) & ball.center().cmplt(self.end)).all()
    }
}

/// What becomes of a node.
pub(super) enum Division {
    /// A leaf with these balls of the pool, after own ones in the modified BVH.
    Leaf(Range<usize>),
    /// There is no surface in the node.
    Nothing,
    /// All of the surface is in one part.
    One(Part),
    /// Left and right of a plane.
    Two(Halves),
}

/// The parts of a node on either side of a plane.
pub(super) struct Halves {
    pub(super) axis: usize,
    pub(super) left: Part,
    pub(super) right: Part,
    /// In the modified BVH: how many of the node's own balls, which have been brought in order, are
    /// the left part's.
    pub(super) left_own: usize,
}
