//! Building from the root down, all structures alike: divide a node, go into its parts, number what
//! comes back.

mod branch;
mod classified;
mod fitted;
mod modified;

use std::ops::Range;

use glam::Vec3A;
use metaball_core::{Aabb, Kernel, Metaball, SceneError, check_ball, check_field};
use rayon::prelude::*;
use thiserror::Error;

use self::branch::Branch;
use crate::ball::{Ball, bounds_of};
use crate::node::{MAX_DEPTH, Node};
use crate::options::{Options, Structure};
use crate::plane::{MAX_BINS, Plane};
use crate::{Field, Tree};

/// Why there is no tree.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A ball, the threshold or the number of balls is none that a field may have.
    #[error(transparent)]
    Field(#[from] SceneError),
    /// The number of bins is out of range.
    #[error("bins: needed from 2 to {MAX_BINS}, found {found}")]
    Bins {
        /// The number asked for.
        found: u32,
    },
    /// The balls overlap so much that indices of 32 bits cannot name all list entries or leaves.
    #[error("{what} of the tree: needed at most {limit}, found {found}")]
    TooMany {
        /// `leaves` or `list entries`.
        what: &'static str,
        /// How many there would be.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
}

/// Nodes of at least this many balls hand one of their parts to another thread. It depends on the
/// balls alone, never on the number of threads, so neither does the tree.
const FORK_FROM: usize = 2048;

/// The level from which on planes go through the middle ball: each halves the own balls, and 32 more
/// levels halve any number that an index of 32 bits can name.
const MEDIAN_FROM: usize = MAX_DEPTH / 2;

pub(crate) fn build(field: &impl Field, options: &Options) -> Result<Tree, BuildError> {
    if !(2..=MAX_BINS as u32).contains(&options.bins) {
        return Err(BuildError::Bins { found: options.bins });
    }
    let mut balls = copy(field)?;
    let builder = Builder {
        kernel: field.kernel(),
        threshold: field.threshold(),
        max_depth: options.max_depth.min(MAX_DEPTH),
        radius: common(&balls, Ball::radius),
        strength: common(&balls, |ball| ball.strength),
        options: *options,
    };
    let mut branch = Branch::new();
    let root = if balls.is_empty() { None } else { builder.root(&mut balls, &mut branch) };
    branch.finish(root, options.kind())
}

/// Checks the field and copies its balls.
fn copy(field: &impl Field) -> Result<Vec<Ball>, SceneError> {
    let count = check_field(field.ball_count(), field.threshold())?;
    let ball = |index: u32| {
        let support = field.support(index as usize);
        let strength = field.strength(index as usize);
        Metaball { center: support.center, radius: support.radius, strength }
    };
    let refused = |index: u32| check_ball(index as usize, &ball(index)).err();
    if let Some(refusal) = (0..count).into_par_iter().find_map_first(refused) {
        return Err(refusal);
    }
    let copied = |index: u32| {
        let Metaball { center, radius, strength } = ball(index);
        Ball::new(center, radius, strength, index)
    };
    Ok((0..count).into_par_iter().map(copied).collect())
}

/// What is the same of all balls.
fn common(balls: &[Ball], value: impl Fn(&Ball) -> f32) -> Option<f32> {
    let first = value(balls.first()?);
    balls.iter().all(|ball| value(ball) == first).then_some(first)
}

/// What the divisions of all nodes have in common.
struct Builder {
    kernel: Kernel,
    threshold: f32,
    max_depth: usize,
    /// The radius of all balls, where they have one.
    radius: Option<f32>,
    /// Their strength, likewise.
    strength: Option<f32>,
    options: Options,
}

/// A node to be divided, but for the own balls of the modified BVH, which are kept in a slice.
#[derive(Debug, Clone)]
struct Part {
    /// Its other balls in the pool: split balls in the modified BVH, all of them elsewhere.
    list: Range<usize>,
    bounds: Aabb,
    cell: Cell,
    depth: usize,
}

/// The part of space on a node's side of all planes above it: in the Fitted BVH its own balls are
/// those of its list whose centres are in it.
#[derive(Debug, Clone, Copy)]
struct Cell {
    min: Vec3A,
    end: Vec3A,
}

impl Cell {
    const ALL: Self = Self { min: Vec3A::NEG_INFINITY, end: Vec3A::INFINITY };

    fn cut(self, plane: &Plane) -> (Self, Self) {
        let (mut left, mut right) = (self, self);
        left.end[plane.axis] = plane.at;
        right.min[plane.axis] = plane.at;
        (left, right)
    }

    fn owns(&self, ball: &Ball) -> bool {
        (ball.center().cmpge(self.min) & ball.center().cmplt(self.end)).all()
    }
}

/// What becomes of a node.
enum Division {
    /// A leaf with these balls of the pool, beside own ones in the modified BVH.
    Leaf(Range<usize>),
    /// The surface does not come here.
    Nothing,
    /// All of the surface is in one part.
    One(Part),
    /// Left and right of a plane.
    Two(Halves),
}

/// The parts of a node on either side of a plane.
struct Halves {
    axis: usize,
    left: Part,
    right: Part,
    /// In the modified BVH: how many of the node's own balls, which have been brought in order, are
    /// the left part's.
    left_own: usize,
}

impl Builder {
    /// Builds the tree of all balls, if there is any surface.
    fn root(&self, balls: &mut Vec<Ball>, branch: &mut Branch) -> Option<(u32, Aabb)> {
        let bounds = bounds_of(balls);
        let whole = Part { list: 0..0, bounds, cell: Cell::ALL, depth: 0 };
        let all = Part { list: 0..balls.len(), ..whole.clone() };
        match self.options.structure {
            Structure::ModifiedBvh => self.grow(balls, &mut Vec::new(), whole, branch),
            Structure::Fitted(fitting) => {
                let root = self.fit(&fitting, balls, &all)?;
                self.grow(&mut [], balls, root, branch)
            }
            Structure::Certified(_) => {
                let root = self.classify(balls, &all)?;
                self.grow(&mut [], balls, root, branch)
            }
        }
    }

    /// Builds the subtree of a node, and returns its reference and box if it has any leaf. The pool
    /// holds the node's list and, below it, lists that are still to be divided, which stay.
    fn grow(
        &self,
        own: &mut [Ball],
        pool: &mut Vec<Ball>,
        mut part: Part,
        branch: &mut Branch,
    ) -> Option<(u32, Aabb)> {
        let height = pool.len();
        let subtree = loop {
            let division = match self.options.structure {
                Structure::ModifiedBvh => self.divide_modified(own, pool, &part),
                Structure::Fitted(fitting) => self.divide_fitted(&fitting, pool, &part),
                Structure::Certified(classes) => self.divide_classified(&classes, pool, &part),
            };
            match division {
                Division::Leaf(list) => {
                    break Some((self.leaf(own, &pool[list], &part, branch), part.bounds));
                }
                Division::Nothing => break None,
                Division::One(only) => part = only,
                Division::Two(halves) => {
                    break self.fork(own, pool, &part, halves, branch);
                }
            }
        };
        pool.truncate(height);
        subtree
    }

    /// Grows both parts of a node, on two threads if that is worth it, and joins them.
    fn fork(
        &self,
        own: &mut [Ball],
        pool: &mut Vec<Ball>,
        part: &Part,
        halves: Halves,
        branch: &mut Branch,
    ) -> Option<(u32, Aabb)> {
        let Halves { axis, mut left, right, left_own } = halves;
        let balls = own.len() + part.list.len();
        let (left_own, right_own) = own.split_at_mut(left_own);
        let right_end = right.list.end;

        let index = branch.push_vacant();
        let first_right_leaf;
        // No part has more balls than its node: below a node that is grown on one thread all are, and
        // in one that is not nothing but vacant nodes comes before the pieces of its parts.
        let (left, right) = if balls >= FORK_FROM {
            let mut left_pool = pool[left.list.clone()].to_vec();
            left.list = 0..left_pool.len();
            pool.truncate(right_end);
            let mut right_branch = Branch::new();
            let (left, right) = rayon::join(
                || self.grow(left_own, &mut left_pool, left, branch),
                || self.grow(right_own, pool, right, &mut right_branch),
            );
            first_right_leaf = branch.leaf_count();
            (left, branch.append(right_branch, right))
        } else {
            let left = self.grow(left_own, pool, left, branch);
            first_right_leaf = branch.leaf_count();
            pool.truncate(right_end);
            (left, self.grow(right_own, pool, right, branch))
        };
        let (Some((left, left_bounds)), Some((right, right_bounds))) = (left, right) else {
            return left.or(right);
        };
        let solid = branch.merge_solids(index, axis, &left_bounds, &right_bounds);
        if solid.is_some() {
            return solid;
        }
        let node = Node {
            left_min: left_bounds.min.into(),
            left,
            left_max: left_bounds.max.into(),
            right,
            right_min: right_bounds.min.into(),
            axis: axis as u32,
            right_max: right_bounds.max.into(),
            first_right_leaf: first_right_leaf as u32,
        };
        Some((branch.fill(index, node), part.bounds))
    }

    /// Adds a leaf, own balls before split balls, and returns the reference to it.
    fn leaf(&self, own: &[Ball], list: &[Ball], part: &Part, branch: &mut Branch) -> u32 {
        let is_own = |ball: &&Ball| match self.options.structure {
            Structure::Fitted(_) => part.cell.owns(ball),
            Structure::ModifiedBvh | Structure::Certified(_) => false,
        };
        let index = |ball: &Ball| ball.index;
        branch.push_leaf(
            &part.bounds,
            own.iter().chain(list.iter().filter(is_own)).map(index),
            list.iter().filter(|ball| !is_own(ball)).map(index),
        )
    }
}

/// Divides the list of a node that is cut in two: what reaches the left goes to the end of the pool,
/// what reaches the right takes the node's place. Balls reach the node's box; so each reaches the
/// part on whose side its centre is, and the other one if it reaches the face between them.
fn divide(
    pool: &mut Vec<Ball>,
    list: &Range<usize>,
    plane: &Plane,
    face: &Aabb,
) -> (Range<usize>, Range<usize>) {
    let mut end = Vec3A::INFINITY;
    end[plane.axis] = plane.at;

    let top = pool.len();
    pool.extend_from_within(list.clone());
    let (below, left) = pool.split_at_mut(top);
    let right = &mut below[list.clone()];
    let (mut left_count, mut right_count) = (0, 0);
    for at in 0..list.len() {
        let ball = left[at];
        let is_left = ball.center().cmplt(end).all();
        let crosses = ball.reaches(face);
        left[left_count] = ball;
        right[right_count] = ball;
        left_count += usize::from(is_left | crosses);
        right_count += usize::from(!is_left | crosses);
    }
    pool.truncate(top + left_count);
    (top..top + left_count, list.start..list.start + right_count)
}
