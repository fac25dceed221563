//! Dividing a node of the classified tree: not in the paper.
//!
//! Over a box every ball's part of the field is largest at the box's nearest point to the centre and
//! smallest at its farthest, so sums of the two bound the field. A box in which the field stays at T
//! or below is dropped; one in which it is above T everywhere is a solid leaf, without a list. Only
//! boxes that could hold surface are divided: the cost follows the surface, not the volume.

use glam::{DVec3, Vec3};
use metaball_core::Aabb;

use super::{Builder, Division, Part, partition};
use crate::ball::Ball;
use crate::fit::Reach;
use crate::options::{Boxes, Classes, Cost};
use crate::plane::{cut, cut_space, longest_axis};

/// Sums of n ≤ 2³² non-negative f64 terms of a few products each err by less than this share.
const ROUNDING: f64 = 1e-6;

/// A plane that saves less than this share of a leaf's cost tells nothing: the middle of the longest
/// side is as good, and parts surface from interior sooner.
const WORTHWHILE: f32 = 0.85;

/// Lists hold what reaches the box widened by this share of its sides: tracers may look so far past
/// its faces (`widening` in `fbvh/local.wgsl`).
const WIDENED: f32 = 4e-6;

/// What is known of the field in a box.
struct Range {
    least: f64,
    most: f64,
    /// Mean radius of the balls, each weighted by the most that it adds.
    radius: f64,
}

impl Builder {
    /// Classifies the box of a node, and cuts it if it may hold surface and is too much for a leaf.
    pub(super) fn divide_classified(
        &self,
        classes: &Classes,
        pool: &mut Vec<Ball>,
        part: &Part,
    ) -> Division {
        let balls = &pool[part.splits.clone()];
        let range = self.range(balls, &part.bounds);
        let threshold = f64::from(self.threshold);
        if range.most * (1.0 + ROUNDING) <= threshold {
            return Division::Nothing;
        }
        if range.least * (1.0 - ROUNDING) > threshold {
            return Division::Leaf(0..0);
        }
        let axis = longest_axis(&part.bounds);
        let side = part.bounds.extent()[axis];
        if part.depth >= self.max_depth
            || balls.len() <= classes.leaf_size as usize
            || f64::from(side) < f64::from(classes.smallest_side) * range.radius
        {
            return Division::Leaf(part.splits.clone());
        }

        let count = balls.len() as f32;
        let bins = self.options.bins as usize;
        let best = cut_space(balls.iter(), &part.bounds, bins, Cost::Linear)
            .filter(|plane| plane.cost < WORTHWHILE * count);
        let (axis, at) = match best {
            Some(plane) => (plane.axis, plane.at),
            None => (axis, part.bounds.center()[axis]),
        };
        // Neighbouring floats have no middle.
        if !(at > part.bounds.min[axis] && at < part.bounds.max[axis]) {
            return Division::Leaf(part.splits.clone());
        }
        let (left_bounds, right_bounds) = cut(&part.bounds, axis, at);
        let left = self.shrink(pool, part, left_bounds);
        let right = self.shrink(pool, part, right_bounds);
        match (left, right) {
            (None, None) => Division::Nothing,
            (Some(only), None) | (None, Some(only)) => Division::One(0..0, only),
            (Some(left), Some(right)) => Division::Two(axis, (0..0, left), (0..0, right)),
        }
    }

    /// The part of a node inside a box, fitted to where its balls can make a surface.
    pub(super) fn shrink(&self, pool: &mut Vec<Ball>, from: &Part, bounds: Aabb) -> Option<Part> {
        let start = pool.len();
        let wide = widened(&bounds);
        for at in from.splits.clone() {
            let ball = pool[at];
            if ball.reaches(&wide) {
                pool.push(ball);
            }
        }
        let balls = &mut pool[start..];
        let reach = Reach::of(Boxes::PerBall, self.kernel, self.threshold, balls.iter())?;
        let surface =
            balls.iter().fold(Aabb::EMPTY, |bounds, ball| bounds.union(&reach.bounds(ball)));
        let bounds = bounds.intersection(&surface);
        if bounds.is_empty() {
            pool.truncate(start);
            return None;
        }
        let wide = widened(&bounds);
        let kept = partition(balls, |ball| ball.reaches(&wide));
        pool.truncate(start + kept);
        Some(Part { splits: start..pool.len(), bounds, depth: from.depth + 1 })
    }

    fn range(&self, balls: &[Ball], bounds: &Aabb) -> Range {
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let mut range = Range { least: 0.0, most: 0.0, radius: 0.0 };
        for ball in balls {
            let center = ball.center.as_dvec3();
            let (radius, strength) = (f64::from(ball.radius), f64::from(ball.strength));
            let part_at = |offset: DVec3| {
                strength * self.kernel.value(offset.length_squared() / (radius * radius))
            };
            let most = part_at(center - center.clamp(low, high));
            range.most += most;
            range.least += part_at((center - low).abs().max((center - high).abs()));
            range.radius += most * radius;
        }
        range.radius /= range.most.max(f64::MIN_POSITIVE);
        range
    }
}

fn widened(bounds: &Aabb) -> Aabb {
    let wider: Vec3 = WIDENED * bounds.extent();
    Aabb { min: bounds.min - wider, max: bounds.max + wider }
}
