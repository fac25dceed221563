//! The search for the surface in one leaf: section 3.

use glam::Vec3;
use metaball_core::Ray;

use super::{Counter, Reading, Tracer};
use crate::{Field, Kind};

/// Two points of a ray and F − T there, between which the field first reaches T. The same point
/// twice where the search starts inside.
pub(super) struct Bracket {
    pub(super) outside: (f32, f32),
    pub(super) inside: (f32, f32),
}

impl<F: Field> Tracer<'_, F> {
    /// The search that belongs to the kind of tree. `stretch` is where the ray is in the leaf's box.
    pub(super) fn search(
        &self,
        leaf: usize,
        ray: &Ray,
        stretch: (f32, f32),
        counter: &mut impl Counter,
    ) -> Option<f32> {
        let Bracket { outside, inside } = self.bracket(leaf, ray, stretch, counter)?;
        Some(self.close_in(leaf, ray, outside, inside, counter))
    }

    /// A point inside, and one outside before it if there is one. Section 4 projects own balls, and
    /// its bracket starts with the ray; section 5.2 projects all.
    pub(super) fn bracket(
        &self,
        leaf: usize,
        ray: &Ray,
        stretch: (f32, f32),
        counter: &mut impl Counter,
    ) -> Option<Bracket> {
        let (own, splits) = self.tree.leaf_balls(leaf);
        counter.leaf_test(own.len() + splits.len());
        let (projected, reading) = match self.tree.kind {
            Kind::ModifiedBvh => (own, Reading::Literal),
            Kind::Fitted | Kind::Certified => (self.list(leaf), self.options.reading),
        };
        let (start, stop) = match reading {
            Reading::Literal => (0.0, ray.t_max),
            Reading::Clipped => stretch,
        };
        if reading == Reading::Clipped {
            let outside = (start, self.excess(leaf, ray, start, counter));
            if outside.1 >= 0.0 {
                return Some(Bracket { outside, inside: outside });
            }
            let inside = self.bracket_end(leaf, projected, ray, (start, stop), reading, counter)?;
            return Some(Bracket { outside, inside });
        }
        let inside = self.bracket_end(leaf, projected, ray, (start, stop), reading, counter)?;
        let outside = (start, self.excess(leaf, ray, start, counter));
        Some(Bracket { outside, inside })
    }

    /// b of the paper, and the field's excess over T there: the first projection in the stretch
    /// where there is any. The end of the stretch counts as one where a projection lies beyond it,
    /// and always when clipping.
    fn bracket_end(
        &self,
        leaf: usize,
        projected: &[u32],
        ray: &Ray,
        (start, stop): (f32, f32),
        reading: Reading,
        counter: &mut impl Counter,
    ) -> Option<(f32, f32)> {
        let mut beyond = reading == Reading::Clipped;
        let mut end = None;
        let mut nearest = stop;
        for &ball in projected {
            let center = self.field.support(ball as usize).center;
            let t = (center - ray.origin).dot(ray.direction);
            beyond |= t >= stop;
            if t > start && t < nearest {
                let excess = self.excess(leaf, ray, t, counter);
                if excess >= 0.0 {
                    nearest = t;
                    end = Some((t, excess));
                }
            }
        }
        if end.is_none() && beyond {
            let excess = self.excess(leaf, ray, stop, counter);
            end = (excess >= 0.0).then_some((stop, excess));
        }
        end
    }

    /// The secant search between a point outside and one inside, kept a bracket: false position,
    /// with the weight of an end halved that stays twice in a row (Illinois).
    fn close_in(
        &self,
        leaf: usize,
        ray: &Ray,
        (mut outside, mut below): (f32, f32),
        (mut inside, mut above): (f32, f32),
        counter: &mut impl Counter,
    ) -> f32 {
        let close = self.options.tolerance * self.field.threshold();
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
            let excess = self.excess(leaf, ray, t, counter);
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
    fn excess(&self, leaf: usize, ray: &Ray, t: f32, counter: &mut impl Counter) -> f32 {
        self.value(leaf, ray, t, counter) - self.field.threshold()
    }

    /// F along the ray, by the leaf's list. From the ball's centre to the ray's origin first: that
    /// difference is right to a float.
    pub(super) fn value(&self, leaf: usize, ray: &Ray, t: f32, counter: &mut impl Counter) -> f32 {
        counter.evaluation();
        let kernel = self.field.kernel();
        let along = t * ray.direction;
        self.list(leaf).iter().fold(0.0, |sum, &ball| {
            let support = self.field.support(ball as usize);
            let offset = (ray.origin - support.center) + along;
            let depth = 1.0 - offset.length_squared() / (support.radius * support.radius);
            sum + self.field.strength(ball as usize) * kernel.value_at_depth(depth)
        })
    }

    /// The unit vector against the field's gradient; against the ray where the gradient is zero.
    pub(super) fn normal(&self, leaf: usize, ray: &Ray, t: f32) -> Vec3 {
        let kernel = self.field.kernel();
        let along = t * ray.direction;
        let descent = self.list(leaf).iter().fold(Vec3::ZERO, |sum, &ball| {
            let support = self.field.support(ball as usize);
            let offset = (ray.origin - support.center) + along;
            let square = support.radius * support.radius;
            let slope = kernel.slope_at_depth(1.0 - offset.length_squared() / square);
            sum + offset * (self.field.strength(ball as usize) * slope / square)
        });
        // Scaled first: the squares of tiny components would be lost.
        let scaled = descent / descent.abs().max_element();
        scaled.try_normalize().unwrap_or_else(|| (-ray.direction).normalize_or_zero())
    }

    /// All balls of a leaf.
    pub(super) fn list(&self, leaf: usize) -> &[u32] {
        let (first, end) = (self.tree.leaves[leaf].first, self.tree.leaves[leaf + 1].first);
        &self.tree.lists[first as usize..end as usize]
    }
}
