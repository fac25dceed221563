//! Building a tree from the root down: divide a node, build its parts, number the nodes.
//!
//! The three structures differ in how they divide a node (`builder/modified.rs`, `builder/fitted.rs`,
//! `builder/classified.rs`); recursion, threads and numbering are common.

mod ball;
mod branch;
mod classified;
mod error;
mod field_range;
mod fit;
mod fitted;
mod modified;
mod part;
mod plane;
mod pool;

use std::sync::atomic::{AtomicBool, Ordering};

use metaball_core::{Aabb, Kernel, Metaball, NegativeBall, SceneError, check_ball, check_field};
use rayon::prelude::*;

use self::ball::{Ball, bounds_of};
use self::branch::{Branch, GrownPieces};
pub use self::error::BuildError;
use self::part::{Cell, Division, Halves, Part};
use self::plane::MAX_BINS;
use self::pool::Pool;
use crate::node::{MAX_DEPTH, Node};
use crate::options::{Options, Structure};
use crate::{Field, Tree};

/// Nodes of at least this many balls may build their parts on two threads. The limit depends on the
/// balls alone, never on the number of threads, so neither does the tree.
const FORK_FROM: usize = 2048;

/// The level from which planes go through the middle ball: each halves the own balls, and 32 more
/// levels halve any number that an index of 32 bits can name.
const MEDIAN_FROM: usize = MAX_DEPTH / 2;

impl Tree {
    /// Builds the structure that the options describe. Runs on rayon's current pool; the result is
    /// the same bit for bit whatever the number of threads.
    ///
    /// # Errors
    /// [`BuildError`]: names the ball that is not legal or not in such a tree, the option that is out of range, or
    /// how many list entries were too many.
    pub fn build(field: &impl Field, options: &Options) -> Result<Self, BuildError> {
        Self::build_while(field, options, || true)
    }

    /// The same as long as `goes_on` says so. It is asked at every node, on any thread.
    ///
    /// # Errors
    /// As [`build`](Tree::build), and [`BuildError::BrokenOff`].
    pub fn build_while(
        field: &impl Field,
        options: &Options,
        goes_on: impl Fn() -> bool + Sync,
    ) -> Result<Self, BuildError> {
        if !(2..=MAX_BINS as u32).contains(&options.bins) {
            return Err(BuildError::Bins { found: options.bins });
        }
        let mut balls = copy(field)?;
        let has_negative = balls.par_iter().any(Ball::is_negative);
        if has_negative {
            options.check_negative(&balls)?;
            balls.par_sort_by_key(|ball| !ball.is_negative());
        }
        let builder = Builder {
            kernel: field.kernel(),
            threshold: field.threshold(),
            max_depth: options.max_depth.min(MAX_DEPTH),
            radius: common(&balls, Ball::radius),
            strength: common(&balls, |ball| ball.strength),
            greatest_strength: greatest_strength(&balls),
            has_negative,
            options: *options,
            grown: GrownPieces::default(),
            goes_on: &goes_on,
            broken_off: AtomicBool::new(false),
        };
        let mut branch = Branch::new();
        let root = if balls.is_empty() { None } else { builder.root(balls, &mut branch) };
        if builder.broken_off.into_inner() {
            return Err(BuildError::BrokenOff);
        }
        branch.finish(root, options.kind())
    }
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

/// The value of a property that is the same for all balls.
fn common(balls: &[Ball], value: impl Fn(&Ball) -> f32 + Sync) -> Option<f32> {
    let first = value(balls.first()?);
    balls.par_iter().all(|ball| value(ball) == first).then_some(first)
}

fn greatest_strength(balls: &[Ball]) -> f32 {
    balls.par_iter().map(|ball| ball.strength.abs()).reduce(|| 0.0, f32::max)
}

/// What the divisions of all nodes share. Lists hold negative balls before the others.
struct Builder<'a> {
    kernel: Kernel,
    threshold: f32,
    max_depth: usize,
    /// The radius of all balls, where it is the same for all.
    radius: Option<f32>,
    /// Their strength, likewise.
    strength: Option<f32>,
    /// The greatest of their sizes.
    greatest_strength: f32,
    /// Whether any ball is negative.
    has_negative: bool,
    options: Options,
    grown: GrownPieces,
    goes_on: &'a (dyn Fn() -> bool + Sync),
    broken_off: AtomicBool,
}

impl Options {
    /// Whether a tree with these options can be built of balls some of which are negative.
    fn check_negative(&self, balls: &[Ball]) -> Result<(), BuildError> {
        let kind = self.kind();
        let negative = balls.iter().find(|ball| ball.is_negative());
        match negative.filter(|_| kind.is_published()) {
            Some(ball) => {
                let source = NegativeBall { index: ball.index as usize, found: ball.strength };
                Err(BuildError::NegativeOfPublished { kind, source })
            }
            None => Ok(()),
        }
    }
}

impl Builder<'_> {
    /// Those of a list that take away from the field, and those that add to it.
    fn by_sign<'b>(&self, list: &'b [Ball]) -> (&'b [Ball], &'b [Ball]) {
        let negative = if self.has_negative { list.partition_point(Ball::is_negative) } else { 0 };
        list.split_at(negative)
    }

    /// Builds the tree of all balls, if there is any surface.
    fn root(&self, mut balls: Vec<Ball>, branch: &mut Branch) -> Option<(u32, Aabb)> {
        let bounds = bounds_of(&balls);
        let whole = Part { list: 0..0, bounds, cell: Cell::ALL, depth: 0 };
        let all = Part { list: 0..balls.len(), ..whole.clone() };
        match self.options.structure {
            Structure::ModifiedBvh => self.grow(&mut balls, &mut Pool::default(), whole, branch),
            Structure::Fitted(fitting) => {
                let mut pool = Pool::new(balls);
                let root = self.fit(&fitting, &mut pool, &all)?;
                self.grow(&mut [], &mut pool, root, branch)
            }
            Structure::Certified(_) => {
                let mut pool = Pool::new(balls);
                let root = self.classify(&mut pool, &all)?;
                self.grow(&mut [], &mut pool, root, branch)
            }
        }
    }

    /// Builds the subtree of a node, and returns its reference and box if it has any leaf. The pool
    /// is a stack: above lists that are still to be divided, which stay, lies the node's list.
    fn grow(
        &self,
        own: &mut [Ball],
        pool: &mut Pool,
        mut part: Part,
        branch: &mut Branch,
    ) -> Option<(u32, Aabb)> {
        let height = pool.top();
        let subtree = loop {
            if self.is_broken_off() {
                break None;
            }
            let division = match self.options.structure {
                Structure::ModifiedBvh => self.divide_modified(own, pool, &part),
                Structure::Fitted(fitting) => self.divide_fitted(&fitting, pool, &part),
                Structure::Certified(classes) => self.divide_classified(&classes, pool, &part),
            };
            match division {
                Division::Leaf(list) => {
                    break Some((self.leaf(own, pool.list(&list), &part, branch), part.bounds));
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

    /// Whether the tree is not wanted any more: then all parts are nothing.
    fn is_broken_off(&self) -> bool {
        if !self.broken_off.load(Ordering::Relaxed) && !(self.goes_on)() {
            self.broken_off.store(true, Ordering::Relaxed);
        }
        self.broken_off.load(Ordering::Relaxed)
    }

    /// Builds both parts of a node, on two threads if that is worth it, and joins them.
    fn fork(
        &self,
        own: &mut [Ball],
        pool: &mut Pool,
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
        // No part has more balls than its node. So below a node that is built on one thread all are,
        // and in a forked one only its own vacant node precedes the pieces of its parts.
        let (left, right) = if balls >= FORK_FROM {
            let mut left_pool = pool.split_off(&left.list, right_end);
            left.list = 0..left_pool.top();
            let ((left_branch, left), (right_branch, right)) = rayon::join(
                || self.grown.grow(|branch| self.grow(left_own, &mut left_pool, left, branch)),
                || self.grown.grow(|branch| self.grow(right_own, pool, right, branch)),
            );
            let left = branch.append(left_branch, left);
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
