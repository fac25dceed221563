//! A tree that proves itself.

use glam::{DVec3, Vec3};
use metaball_core::{Aabb, Support};
use rayon::prelude::*;
use thiserror::Error;

use crate::node::MAX_DEPTH;
use crate::tree::Child;
use crate::{Field, Kind, Stats, Tree};

/// What is wrong with a tree. Every one of them is a bug of the builder, or a tree of another field.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Flaw {
    /// Nodes are not in preorder, each below one parent.
    #[error("node {found}: needed node {needed} at this place of the preorder")]
    NodeOrder {
        /// The node due.
        needed: usize,
        /// The node found.
        found: usize,
    },
    /// Leaves are not numbered from left to right.
    #[error("leaf {found}: needed leaf {needed} at this place from the left")]
    LeafOrder {
        /// The leaf due.
        needed: usize,
        /// The leaf found.
        found: usize,
    },
    /// `first_right_leaf` is not the leftmost leaf of the right child.
    #[error("node {node}: needed first_right_leaf {needed}, found {found}")]
    FirstRightLeaf {
        /// The node.
        node: usize,
        /// The leftmost leaf of its right child.
        needed: usize,
        /// The field's value.
        found: usize,
    },
    /// Arrays hold more than the root leads to, or a leaf's box differs from its parent's copy.
    #[error("leaf {leaf}: box or list differs from what its parent and neighbours say")]
    Leaf {
        /// The leaf; the number of leaves where some are out of reach.
        leaf: usize,
    },
    /// More nodes above a leaf than a stack holds.
    #[error("leaf {leaf}: needed at most {MAX_DEPTH} nodes above it, found {found}")]
    TooDeep {
        /// The leaf.
        leaf: usize,
        /// Nodes above it.
        found: usize,
    },
    /// A child's box reaches beyond its parent's, or is empty.
    #[error("node {node}: a child's box is empty or reaches beyond the node's")]
    ChildOutside {
        /// The parent.
        node: usize,
    },
    /// Children of a Fitted BVH overlap.
    #[error("node {node}: children overlap along axis {axis}")]
    ChildrenOverlap {
        /// The parent.
        node: usize,
        /// The axis of its plane.
        axis: u32,
    },
    /// A list names a ball that does not exist, or one twice.
    #[error("leaf {leaf}: ball {ball} is unknown or listed twice")]
    Listing {
        /// The leaf.
        leaf: usize,
        /// The ball.
        ball: u32,
    },
    /// A ball is own in more leaves than one, or, in the modified BVH, in none.
    #[error("ball {ball}: needed to be own in one leaf, found {found}")]
    Ownership {
        /// The ball.
        ball: u32,
        /// Leaves in which it is own.
        found: usize,
    },
    /// In the modified BVH: an own ball's support reaches beyond the leaf's box.
    #[error("leaf {leaf}: own ball {ball} reaches beyond the box")]
    OwnOutside {
        /// The leaf.
        leaf: usize,
        /// The ball.
        ball: u32,
    },
    /// A list lacks a ball that makes a difference to the surface.
    #[error("leaf {leaf}: ball {ball} is missing from the list")]
    Incomplete {
        /// The leaf.
        leaf: usize,
        /// The ball.
        ball: u32,
    },
    /// In the certified tree: a leaf without a list has a point where the field is at T or below.
    #[error("leaf {leaf}: needed a field above T everywhere, found less at {point}")]
    NotSolid {
        /// The leaf.
        leaf: usize,
        /// The point, world space, scene units.
        point: DVec3,
    },
    /// A point of the surface is in no leaf's box.
    #[error("ball {ball}: the surface at {point} is in no leaf")]
    SurfaceOutside {
        /// The ball from whose centre the point was found.
        ball: u32,
        /// The point, world space, scene units.
        point: DVec3,
    },
}

/// Overlaps smaller than this part of the radii are rounding.
const ROUNDING: f64 = 1e-6;

impl Tree {
    /// Checks everything that tracing relies on: the order of nodes and leaves, boxes inside boxes,
    /// children apart in the Fitted BVH, who owns a ball, lists complete up to balls that do not
    /// matter to the surface in the leaf (sampled), the surface inside leaves (sampled: from each
    /// ball's centre outwards), and solid leaves solid (sampled). Slow, in f64, and with neighbours
    /// found without the tree.
    ///
    /// # Errors
    /// The first flaw found.
    pub fn validate(&self, field: &impl Field) -> Result<Stats, Flaw> {
        self.check_shape()?;
        self.check_lists(field)?;
        self.check_completeness(field)?;
        self.check_surface(field)?;
        self.check_solids(field)?;
        Ok(self.stats())
    }

    fn check_shape(&self) -> Result<(), Flaw> {
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

    fn check_lists(&self, field: &impl Field) -> Result<(), Flaw> {
        let mut owners = vec![0usize; field.ball_count()];
        let mut seen = vec![usize::MAX; field.ball_count()];
        for leaf in 0..self.leaf_count() {
            let (own, split) = self.leaf_balls(leaf);
            for &ball in own.iter().chain(split) {
                match seen.get_mut(ball as usize) {
                    Some(seen) if *seen != leaf => *seen = leaf,
                    _ => return Err(Flaw::Listing { leaf, ball }),
                }
            }
            let bounds = self.leaves[leaf].bounds();
            for &ball in own {
                owners[ball as usize] += 1;
                let Support { center, radius } = field.support(ball as usize);
                if self.kind == Kind::ModifiedBvh
                    && bounds.union(&Aabb::around_sphere(center, radius)) != bounds
                {
                    return Err(Flaw::OwnOutside { leaf, ball });
                }
            }
        }
        // Where a ball does not reach its own leaf's fitted box, it is nobody's own.
        let legal = match self.kind {
            Kind::ModifiedBvh => 1..=1,
            Kind::Fitted => 0..=1,
            Kind::Certified => 0..=0,
        };
        match owners.iter().position(|found| !legal.contains(found)) {
            Some(ball) => Err(Flaw::Ownership { ball: ball as u32, found: owners[ball] }),
            None => Ok(()),
        }
    }

    fn check_completeness(&self, field: &impl Field) -> Result<(), Flaw> {
        let mut missing = vec![Vec::new(); self.leaf_count()];
        for ball in 0..field.ball_count() {
            let Support { center, radius } = field.support(ball);
            let reach = f64::from(radius) * (1.0 - ROUNDING);
            self.visit(|child, bounds, _| {
                if squared_distance(center, bounds) >= reach * reach {
                    return false;
                }
                if let Child::Leaf(leaf) = *child {
                    let (own, split) = self.leaf_balls(leaf);
                    let due = match self.kind {
                        Kind::ModifiedBvh => own.iter().any(|&other| {
                            overlap(&field.support(ball), &field.support(other as usize))
                        }),
                        Kind::Fitted => true,
                        // A leaf without a list is solid.
                        Kind::Certified => !split.is_empty(),
                    };
                    if due && !own.contains(&(ball as u32)) && !split.contains(&(ball as u32)) {
                        missing[leaf].push(ball as u32);
                    }
                }
                true
            });
        }
        for (leaf, missing) in missing.iter().enumerate() {
            let Some(&ball) = missing.first() else { continue };
            if self.kind == Kind::ModifiedBvh || self.matter(field, leaf, missing) {
                return Err(Flaw::Incomplete { leaf, ball });
            }
        }
        Ok(())
    }

    /// Whether balls that reach a leaf's box but are not listed lift the field to T anywhere there:
    /// on a lattice over the part of the box that each of them reaches.
    fn matter(&self, field: &impl Field, leaf: usize, missing: &[u32]) -> bool {
        let threshold = f64::from(field.threshold());
        let (own, split) = self.leaf_balls(leaf);
        let listed: Vec<u32> = own.iter().chain(split).copied().collect();
        missing.iter().any(|&ball| {
            let Support { center, radius } = field.support(ball as usize);
            let part =
                Aabb::around_sphere(center, radius).intersection(&self.leaves[leaf].bounds());
            lattice(&part).any(|point| {
                let with_list = value(field, &listed, point);
                with_list < threshold * (1.0 - ROUNDING)
                    && with_list + value(field, missing, point) > threshold
            })
        })
    }

    fn check_surface(&self, field: &impl Field) -> Result<(), Flaw> {
        let neighbors = Neighbors::new(field);
        let directions = (0..27)
            .map(|at| DVec3::new((at % 3) as f64, (at / 3 % 3) as f64, (at / 9) as f64) - 1.0)
            .filter(|direction| *direction != DVec3::ZERO)
            .map(DVec3::normalize);
        let directions: Vec<DVec3> = directions.collect();
        let lost = (0..field.ball_count()).into_par_iter().find_map_first(|ball| {
            let near = neighbors.of(field, ball);
            let mut points = directions
                .iter()
                .filter_map(|&direction| surface_from(field, &near, ball, direction));
            let point = points.find(|&point| !self.holds(point))?;
            Some(Flaw::SurfaceOutside { ball: ball as u32, point })
        });
        lost.map_or(Ok(()), Err)
    }

    fn check_solids(&self, field: &impl Field) -> Result<(), Flaw> {
        let threshold = f64::from(field.threshold());
        let is_solid = |leaf: usize| {
            self.kind == Kind::Certified && self.leaves[leaf].first == self.leaves[leaf + 1].first
        };
        for leaf in (0..self.leaf_count()).filter(|&leaf| is_solid(leaf)) {
            let bounds = self.leaves[leaf].bounds();
            let near: Vec<u32> = (0..field.ball_count() as u32)
                .filter(|&ball| {
                    let Support { center, radius } = field.support(ball as usize);
                    squared_distance(center, &bounds) < f64::from(radius).powi(2)
                })
                .collect();
            let low = lattice(&bounds).find(|&point| value(field, &near, point) <= threshold);
            if let Some(point) = low {
                return Err(Flaw::NotSolid { leaf, point });
            }
        }
        Ok(())
    }

    /// Whether the point is in any leaf's closed box.
    fn holds(&self, point: DVec3) -> bool {
        let mut held = false;
        self.visit(|child, bounds, _| {
            let inside = point.cmpge(bounds.min.as_dvec3()).all()
                && point.cmple(bounds.max.as_dvec3()).all();
            held |= inside && matches!(child, Child::Leaf(_));
            inside && !held
        });
        held
    }
}

/// The last point of the solid before the field first falls below T on the way from a ball's centre
/// to the rim of its support; `None` where it starts below or stays above.
fn surface_from(field: &impl Field, near: &[u32], ball: usize, direction: DVec3) -> Option<DVec3> {
    const STEPS: usize = 32;
    let Support { center, radius } = field.support(ball);
    let (start, length) = (center.as_dvec3(), f64::from(radius));
    let at = |part: f64| start + part * length * direction;
    let near: Vec<u32> = near
        .iter()
        .copied()
        .filter(|&other| meets(&field.support(other as usize), start, direction, length))
        .collect();
    // A hair above T: a field that only just touches T at a point has no surface to lose.
    let threshold = f64::from(field.threshold()) * (1.0 + 1e-9);
    let solid = |part: f64| value(field, &near, at(part)) >= threshold;
    if !solid(0.0) {
        return None;
    }
    let first_below = (1..=STEPS).find(|&step| !solid(step as f64 / STEPS as f64))?;
    let (mut inside, mut outside) =
        ((first_below - 1) as f64 / STEPS as f64, first_below as f64 / STEPS as f64);
    for _ in 0..f64::MANTISSA_DIGITS {
        let middle = 0.5 * (inside + outside);
        if solid(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    Some(at(inside))
}

/// Whether a support, grown by more than rounding, holds a point of the line from `start`, `length`
/// long in a unit direction. Balls that do not add nothing there.
fn meets(support: &Support, start: DVec3, direction: DVec3, length: f64) -> bool {
    let to_center = support.center.as_dvec3() - start;
    let nearest = to_center.dot(direction).clamp(0.0, length) * direction;
    let reach = f64::from(support.radius) * (1.0 + ROUNDING);
    to_center.distance_squared(nearest) <= reach * reach
}

/// The field of some balls at a point, f64.
fn value(field: &impl Field, balls: &[u32], point: DVec3) -> f64 {
    balls.iter().fold(0.0, |sum, &ball| {
        let Support { center, radius } = field.support(ball as usize);
        let squared_ratio =
            (center.as_dvec3() - point).length_squared() / f64::from(radius).powi(2);
        sum + f64::from(field.strength(ball as usize)) * field.kernel().value(squared_ratio)
    })
}

/// Whether two supports overlap by more than rounding.
fn overlap(a: &Support, b: &Support) -> bool {
    let reach = (f64::from(a.radius) + f64::from(b.radius)) * (1.0 - ROUNDING);
    a.center.as_dvec3().distance_squared(b.center.as_dvec3()) < reach * reach
}

fn squared_distance(point: Vec3, bounds: &Aabb) -> f64 {
    let point = point.as_dvec3();
    let nearest = point.max(bounds.min.as_dvec3()).min(bounds.max.as_dvec3());
    point.distance_squared(nearest)
}

/// Which supports overlap, found without a tree: balls in the order of their centres' x.
struct Neighbors {
    /// x of the centre, and the ball.
    sorted: Vec<(f32, u32)>,
    largest_radius: f32,
}

impl Neighbors {
    fn new(field: &impl Field) -> Self {
        let supports = || (0..field.ball_count()).map(|ball| field.support(ball));
        let mut sorted: Vec<(f32, u32)> =
            (0..).zip(supports()).map(|(ball, support)| (support.center.x, ball)).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let largest_radius = supports().fold(0.0, |largest, support| support.radius.max(largest));
        Self { sorted, largest_radius }
    }

    /// The balls that overlap a ball, itself included.
    fn of(&self, field: &impl Field, ball: usize) -> Vec<u32> {
        let support = field.support(ball);
        let reach = (support.radius + self.largest_radius) * 1.01;
        let x = support.center.x;
        let first = self.sorted.partition_point(|&(other, _)| other < x - reach);
        self.sorted[first..]
            .iter()
            .take_while(|&&(other, _)| other <= x + reach)
            .map(|&(_, other)| other)
            .filter(|&other| overlap(&support, &field.support(other as usize)))
            .collect()
    }
}

/// Points of a closed box, its corners among them.
fn lattice(bounds: &Aabb) -> impl Iterator<Item = DVec3> + use<> {
    const STEPS: usize = 4;
    let (low, side) = (bounds.min.as_dvec3(), bounds.max.as_dvec3() - bounds.min.as_dvec3());
    (0..(STEPS + 1).pow(3)).map(move |at| {
        let step = |divisor: usize| (at / divisor % (STEPS + 1)) as f64 / STEPS as f64;
        low + side * DVec3::new(step(1), step(STEPS + 1), step((STEPS + 1).pow(2)))
    })
}
