//! Building from the root down, both structures alike: divide a node, go into its parts, number
//! what comes back.

mod classified;
mod fitted;
mod modified;

use std::ops::Range;

use bytemuck::Zeroable;
use metaball_core::{Aabb, RADIUS_LIMITS, SceneError};
use rayon::prelude::*;
use thiserror::Error;

use crate::ball::Ball;
use crate::node::{EMPTY, LEAF, Leaf, MAX_DEPTH, Node};
use crate::options::{Options, Structure};
use crate::plane::MAX_BINS;
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
const FORK_FROM: usize = 4096;

/// The level from which on planes go through the middle ball: each halves the own balls, and 32 more
/// levels halve any number that an index of 32 bits can name.
const MEDIAN_FROM: usize = MAX_DEPTH / 2;

pub(crate) fn build(field: &impl Field, options: &Options) -> Result<Tree, BuildError> {
    if !(2..=MAX_BINS as u32).contains(&options.bins) {
        return Err(BuildError::Bins { found: options.bins });
    }
    let mut own = copy(field)?;
    let builder = Builder {
        kernel: field.kernel(),
        threshold: field.threshold(),
        max_depth: options.max_depth.min(MAX_DEPTH),
        options: *options,
    };
    let mut branch = Branch::default();
    let mut pool = Vec::new();
    let root = builder
        .root(&mut own, &mut pool)
        .and_then(|(own, part)| builder.grow(own, &mut pool, part, &mut branch));
    branch.finish(root, options)
}

/// Checks the field and copies its balls.
fn copy(field: &impl Field) -> Result<Vec<Ball>, SceneError> {
    let threshold = field.threshold();
    if !(threshold > 0.0 && threshold.is_finite()) {
        return Err(SceneError::Threshold { found: threshold });
    }
    let count = u32::try_from(field.ball_count())
        .map_err(|_| SceneError::TooManyBalls { found: field.ball_count() })?;
    (0..count)
        .into_par_iter()
        .map(|index| {
            let at = index as usize;
            let support = field.support(at);
            let strength = field.strength(at);
            if !support.center.abs().cmple(glam::Vec3::splat(RADIUS_LIMITS.1)).all() {
                return Err(SceneError::Center { index: at, found: support.center });
            }
            if !(RADIUS_LIMITS.0..=RADIUS_LIMITS.1).contains(&support.radius) {
                return Err(SceneError::Radius { index: at, found: support.radius });
            }
            if !(strength > 0.0 && strength.is_finite()) {
                return Err(SceneError::Strength { index: at, found: strength });
            }
            Ok(Ball { center: support.center, radius: support.radius, strength, index })
        })
        .collect()
}

/// What the divisions of all nodes have in common.
struct Builder {
    kernel: metaball_core::Kernel,
    threshold: f32,
    max_depth: usize,
    options: Options,
}

/// A node to be divided, but for its own balls.
#[derive(Debug, Clone)]
struct Part {
    /// Its split balls in the pool.
    splits: Range<usize>,
    bounds: Aabb,
    depth: usize,
}

/// What becomes of a node. Parts name their own balls by a range of the node's.
enum Division {
    /// A leaf with these split balls of the pool.
    Leaf(Range<usize>),
    /// The surface does not come here.
    Nothing,
    /// All of the surface is in one part.
    One(Range<usize>, Part),
    /// Left and right of a plane across the axis.
    Two(usize, (Range<usize>, Part), (Range<usize>, Part)),
}

/// A subtree under construction. References count from its own first node and leaf.
#[derive(Default)]
struct Branch {
    /// In preorder. A node whose parts turned out to hold no surface, or only one of them, stays
    /// vacant and is taken out in the end.
    nodes: Vec<Node>,
    /// `first` holds the length of the leaf's list for now.
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

impl Builder {
    /// The node of all balls, if there is any surface.
    fn root<'a>(
        &self,
        own: &'a mut [Ball],
        pool: &mut Vec<Ball>,
    ) -> Option<(&'a mut [Ball], Part)> {
        let bounds = own.iter().fold(Aabb::EMPTY, |bounds, ball| bounds.union(&ball.bounds()));
        if own.is_empty() {
            return None;
        }
        match self.options.structure {
            Structure::ModifiedBvh => Some((own, Part { splits: 0..0, bounds, depth: 0 })),
            Structure::Fitted(fitting) => {
                let (kept, part) = self.fit(&fitting, own, pool, 0, bounds, 0)?;
                Some((&mut own[..kept], part))
            }
            // One list, in the pool: there is no difference between own and split balls.
            Structure::Certified(_) => {
                pool.extend_from_slice(own);
                Some((&mut own[..0], Part { splits: 0..pool.len(), bounds, depth: 0 }))
            }
        }
    }

    /// Builds the subtree of a node, and returns its reference and box if it has any leaf. The pool
    /// holds the split balls of this node and, below it, those of the nodes above; it is left as it
    /// was.
    fn grow(
        &self,
        mut own: &mut [Ball],
        pool: &mut Vec<Ball>,
        mut part: Part,
        branch: &mut Branch,
    ) -> Option<(u32, Aabb)> {
        let height = pool.len();
        let subtree = loop {
            let division = match self.options.structure {
                Structure::ModifiedBvh => self.divide_modified(own, pool, &part),
                Structure::Fitted(fitting) => self.divide_fitted(&fitting, own, pool, &part),
                Structure::Certified(classes) => self.divide_classified(&classes, pool, &part),
            };
            match division {
                Division::Leaf(splits) => {
                    break Some((branch.push_leaf(own, &pool[splits], &part.bounds), part.bounds));
                }
                Division::Nothing => break None,
                Division::One(range, only) => {
                    own = &mut own[range];
                    part = only;
                }
                Division::Two(axis, left, right) => {
                    break self.fork(own, pool, &part, axis, left, right, branch);
                }
            }
        };
        pool.truncate(height);
        subtree
    }

    /// Grows both parts of a node, on two threads if that is worth it, and joins them.
    #[expect(clippy::too_many_arguments, reason = "a node and its two parts, used once")]
    fn fork(
        &self,
        own: &mut [Ball],
        pool: &mut Vec<Ball>,
        part: &Part,
        axis: usize,
        (left_range, left): (Range<usize>, Part),
        (right_range, mut right): (Range<usize>, Part),
        branch: &mut Branch,
    ) -> Option<(u32, Aabb)> {
        let balls = own.len() + part.splits.len();
        let (left_own, right_own) = own.split_at_mut(right_range.start);
        let left_own = &mut left_own[left_range];
        let right_own = &mut right_own[..right_range.len()];

        let index = branch.nodes.len();
        branch.nodes.push(VACANT);
        let first_right_leaf;
        let (left, right) = if balls >= FORK_FROM {
            let mut right_pool = pool[right.splits.clone()].to_vec();
            right.splits = 0..right_pool.len();
            let mut right_branch = Branch::default();
            let (left, right) = rayon::join(
                || self.grow(left_own, pool, left, branch),
                || self.grow(right_own, &mut right_pool, right, &mut right_branch),
            );
            first_right_leaf = branch.leaves.len();
            (left, branch.append(right_branch, right))
        } else {
            let left = self.grow(left_own, pool, left, branch);
            first_right_leaf = branch.leaves.len();
            (left, self.grow(right_own, pool, right, branch))
        };
        let (Some((left, left_bounds)), Some((right, right_bounds))) = (left, right) else {
            return left.or(right);
        };
        branch.nodes[index] = Node {
            left_min: left_bounds.min.into(),
            left,
            left_max: left_bounds.max.into(),
            right,
            right_min: right_bounds.min.into(),
            axis: axis as u32,
            right_max: right_bounds.max.into(),
            first_right_leaf: first_right_leaf as u32,
        };
        Some((index as u32, part.bounds))
    }
}

impl Branch {
    /// Adds a leaf and returns the reference to it.
    fn push_leaf(&mut self, own: &[Ball], splits: &[Ball], bounds: &Aabb) -> u32 {
        let reference = LEAF | self.leaves.len() as u32;
        self.lists.extend(own.iter().chain(splits).map(|ball| ball.index));
        self.leaves.push(Leaf {
            min: bounds.min.into(),
            first: (own.len() + splits.len()) as u32,
            max: bounds.max.into(),
            own: own.len() as u32,
        });
        reference
    }

    /// Adds a subtree behind this one and returns its root's new reference.
    fn append(&mut self, other: Self, root: Option<(u32, Aabb)>) -> Option<(u32, Aabb)> {
        let nodes = self.nodes.len() as u32;
        let leaves = self.leaves.len() as u32;
        let moved = |reference: u32| match reference {
            EMPTY => EMPTY,
            leaf if leaf & LEAF != 0 => leaf + leaves,
            node => node + nodes,
        };
        self.nodes.extend(other.nodes.into_iter().map(|node| Node {
            left: moved(node.left),
            right: moved(node.right),
            first_right_leaf: node.first_right_leaf + leaves,
            ..node
        }));
        self.leaves.extend(other.leaves);
        self.lists.extend(other.lists);
        root.map(|(root, bounds)| (moved(root), bounds))
    }

    /// Takes the vacant nodes out, turns the lengths of lists into their starts, and checks that the
    /// indices were wide enough.
    fn finish(mut self, root: Option<(u32, Aabb)>, options: &Options) -> Result<Tree, BuildError> {
        check("leaves", self.leaves.len(), (LEAF - 1) as usize)?;
        check("list entries", self.lists.len(), u32::MAX as usize)?;
        let (mut root, bounds) = root.unwrap_or((EMPTY, Aabb::EMPTY));

        if self.nodes.iter().any(|node| node.left == EMPTY) {
            let mut kept = 0;
            let numbers: Vec<u32> = self
                .nodes
                .iter()
                .map(|node| {
                    let number = kept;
                    kept += u32::from(node.left != EMPTY);
                    number
                })
                .collect();
            let moved = |reference: u32| {
                if reference & LEAF != 0 { reference } else { numbers[reference as usize] }
            };
            self.nodes.retain(|node| node.left != EMPTY);
            for node in &mut self.nodes {
                node.left = moved(node.left);
                node.right = moved(node.right);
            }
            root = moved(root);
        }

        let mut first = 0;
        for leaf in &mut self.leaves {
            first += std::mem::replace(&mut leaf.first, first);
        }
        self.leaves.push(Leaf { first, ..Leaf::zeroed() });
        Ok(Tree {
            nodes: self.nodes,
            leaves: self.leaves,
            lists: self.lists,
            root,
            bounds,
            kind: options.kind(),
        })
    }
}

fn check(what: &'static str, found: usize, limit: usize) -> Result<(), BuildError> {
    if found <= limit { Ok(()) } else { Err(BuildError::TooMany { what, found, limit }) }
}

/// Moves the balls that satisfy the test to the front, and returns how many they are.
fn partition(balls: &mut [Ball], mut test: impl FnMut(&Ball) -> bool) -> usize {
    let mut front = 0;
    for at in 0..balls.len() {
        if test(&balls[at]) {
            balls.swap(front, at);
            front += 1;
        }
    }
    front
}

/// Appends to the pool those of its own range and of `others` that satisfy the test.
fn gather(
    pool: &mut Vec<Ball>,
    splits: &Range<usize>,
    others: &[Ball],
    test: impl Fn(&Ball) -> bool,
) {
    for at in splits.clone() {
        let ball = pool[at];
        if test(&ball) {
            pool.push(ball);
        }
    }
    pool.extend(others.iter().filter(|ball| test(ball)));
}
