//! The search for the surface in one leaf of a published tree: section 3.

use metaball_core::Ray;

use super::counter::Counter;
use super::field_tree::FieldTree;
use crate::{Field, Kind};

/// How the leaves of published trees are searched for the surface: section 3. Certified trees have no
/// such options.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecantSearch {
    /// How the leaf test of the Fitted BVH is read.
    pub reading: Reading,
    /// The search ends where |F − T| is at most this part of T. An f32 sum of a dozen kernels is
    /// right to about 1e-6, so smaller tolerances gain nothing.
    pub tolerance: f32,
    /// The search ends after this many steps, with the nearest point known to be inside.
    pub max_iterations: u32,
}

impl SecantSearch {
    /// Clipped, to 1e-5. False position gains half a bracket at the least in two steps when its
    /// weights are halved (Illinois), so 64 steps take 2³² off the longest bracket, more than an
    /// f32 holds; a handful is typical.
    pub const DEFAULT: Self =
        Self { reading: Reading::Clipped, tolerance: 1e-5, max_iterations: 64 };
}

impl Default for SecantSearch {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// How section 5.2's leaf test of the Fitted BVH is read, which says neither what happens when
/// projections lie outside the leaf's box nor where the bracket starts. The modified BVH is not
/// affected: section 4 leaves no choice, and it is always read as [`Reading::Literal`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Reading {
    /// Projections count wherever they fall, the bracket starts where the ray does, and the leaf's
    /// list is used even outside its box, where it is incomplete.
    Literal,
    /// Only the ray's interval inside the box counts: the field is tested at both of its ends and at
    /// the projections in between, and the bracket starts at the entry. T or more at the entry is a
    /// hit there.
    Clipped,
}

/// A leaf and the ray along which it is searched.
pub(super) struct LeafSearch<'a, F> {
    pub(super) tree: &'a FieldTree<'a, F>,
    pub(super) options: &'a SecantSearch,
    pub(super) leaf: usize,
    pub(super) ray: &'a Ray,
}

/// Two points of a ray and F − T there, between which the field first reaches T. The same point
/// twice where the search starts inside.
pub(super) struct Bracket {
    outside: (f32, f32),
    inside: (f32, f32),
}

impl<F: Field> LeafSearch<'_, F> {
    /// The t of the surface. `interval` is where the ray is in the leaf's box.
    pub(super) fn root(&self, interval: (f32, f32), counter: &mut impl Counter) -> Option<f32> {
        let bracket = self.bracket(interval, counter)?;
        Some(self.close_in(&bracket, counter))
    }

    /// A point inside, and one outside before it if there is one. Section 4 projects own balls, and
    /// its bracket starts with the ray; section 5.2 projects all.
    pub(super) fn bracket(
        &self,
        interval: (f32, f32),
        counter: &mut impl Counter,
    ) -> Option<Bracket> {
        let Self { leaf, ray, .. } = *self;
        let tree = self.tree.tree;
        let list = tree.list(leaf);
        counter.leaf_test(list.len());
        let (projected, reading) = match tree.kind {
            Kind::ModifiedBvh => (tree.leaf_balls(leaf).0, Reading::Literal),
            Kind::Fitted | Kind::Certified => (list, self.options.reading),
        };
        match reading {
            Reading::Literal => {
                let (start, stop) = (ray.t_min, ray.t_max);
                let inside = self.bracket_end(projected, (start, stop), false, counter)?;
                let outside = (start, self.excess(start, counter));
                Some(Bracket { outside, inside })
            }
            Reading::Clipped => {
                let outside = (interval.0, self.excess(interval.0, counter));
                if outside.1 >= 0.0 {
                    return Some(Bracket { outside, inside: outside });
                }
                let inside = self.bracket_end(projected, interval, true, counter)?;
                Some(Bracket { outside, inside })
            }
        }
    }

    /// b of the paper, and the field's excess over T there: the first projection in the interval
    /// where there is any. The end of the interval counts as one where a projection lies beyond it,
    /// and always if it is `clipped` to the leaf's box.
    fn bracket_end(
        &self,
        projected: &[u32],
        (start, stop): (f32, f32),
        clipped: bool,
        counter: &mut impl Counter,
    ) -> Option<(f32, f32)> {
        let ray = self.ray;
        let mut beyond = clipped;
        let mut end = None;
        let mut nearest = stop;
        for &ball in projected {
            let center = self.tree.field.support(ball as usize).center;
            let t = (center - ray.origin).dot(ray.direction);
            beyond |= t >= stop;
            if t > start && t < nearest {
                let excess = self.excess(t, counter);
                if excess >= 0.0 {
                    nearest = t;
                    end = Some((t, excess));
                }
            }
        }
        if end.is_none() && beyond {
            let excess = self.excess(stop, counter);
            end = (excess >= 0.0).then_some((stop, excess));
        }
        end
    }

    /// The secant search between a point outside and one inside, kept a bracket: false position,
    /// with the weight of an end halved that stays twice in a row (Illinois).
    fn close_in(&self, bracket: &Bracket, counter: &mut impl Counter) -> f32 {
        let (mut outside, mut below) = bracket.outside;
        let (mut inside, mut above) = bracket.inside;
        let close = self.options.tolerance * self.tree.field.threshold();
        if above <= close || inside <= outside {
            return inside;
        }
        let mut last_moved_inside = None;
        for _ in 0..self.options.max_iterations {
            counter.iteration();
            let secant = inside - (inside - outside) * (above / (above - below));
            let t = if secant > outside && secant < inside {
                secant
            } else {
                outside + 0.5 * (inside - outside)
            };
            if !(t > outside && t < inside) {
                break;
            }
            let excess = self.excess(t, counter);
            if excess.abs() <= close {
                return t;
            }
            let moves_inside = excess > 0.0;
            let stays_twice = last_moved_inside == Some(moves_inside);
            if moves_inside {
                (inside, above) = (t, excess);
                below *= if stays_twice { 0.5 } else { 1.0 };
            } else {
                (outside, below) = (t, excess);
                above *= if stays_twice { 0.5 } else { 1.0 };
            }
            last_moved_inside = Some(moves_inside);
        }
        inside
    }

    /// F − T along the ray, by the leaf's list.
    fn excess(&self, t: f32, counter: &mut impl Counter) -> f32 {
        self.tree.value(self.leaf, self.ray, t, counter) - self.tree.field.threshold()
    }
}
