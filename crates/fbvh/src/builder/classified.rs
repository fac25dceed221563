//! Dividing a node of the certified tree: not in the paper.
//!
//! A box in which the field stays at T or below is dropped; one in which it is above T everywhere is a
//! solid leaf, without a list (`builder/field_range.rs`). Only boxes that could hold surface are divided:
//! the cost follows the surface, not the volume.

use glam::{Vec3, Vec3A};
use metaball_core::Aabb;

use super::Builder;
use super::ball::Ball;
use super::fit::{Reach, keep_reaching};
use super::part::{Division, Halves, Part};
use super::plane::{Plane, centers_of, cut, cut_space, face, longest_axis};
use super::pool::Pool;
use crate::options::{Classes, Cost};

/// A plane whose cost is more than this share of a leaf's saves too little: the middle of the longest
/// side is as good, and separates surface from interior sooner.
const WORTHWHILE: f32 = 0.85;

/// Boxes whose side is fewer least radii than this have no such plane, since most balls reach across
/// the box: none is sought.
const BINNED: f32 = 3.0;

/// A cut that leaves more than this share of the balls on both sides is not worth its two lists in a
/// box of at most twice as many balls as a leaf may have.
const SHARED: f32 = 0.6;

/// A list of more than so many full leaves is long: its box may be cut below the smallest side, by the
/// cube root of the number of leaves that it would fill. Most such boxes turn out to be solid or empty.
const LONG: f32 = 3.0;

/// Balls count as coincident where their centres are in a box of at most this share of the least
/// radius: even in boxes of the smallest side, nearly all of them would be on every list.
const COINCIDENT: f32 = 0.125;

/// A box of more least radii than this is cut whatever its list: in f32 a point of it is known to 2⁻²²
/// of the box, too little for the least ball.
const WIDEST: f32 = 16.0;

/// Lists hold what reaches the box widened by this share of its longest side, and solid boxes are solid
/// in that: rounding may take a tracer so far past its faces (`slack` in
/// `shaders/wgsl/fbvh/relative_ray.wgsl`).
const WIDENED: f32 = 4e-6;

impl Builder<'_> {
    /// Cuts the box of a node if it may hold surface and is too much for a leaf.
    pub(super) fn divide_classified(
        &self,
        classes: &Classes,
        pool: &mut Pool,
        part: &Part,
    ) -> Division {
        let list = pool.list(&part.list);
        // A node that was found solid has no list.
        if list.is_empty() {
            return Division::Leaf(0..0);
        }
        if self.is_empty(list, &part.bounds) {
            return Division::Nothing;
        }
        let radii = self.radii(list);
        let plane = match self.classified_plane(classes, list, part, radii) {
            Some(plane) if part.depth < self.max_depth => plane,
            _ => return Division::Leaf(part.list.clone()),
        };
        let side = part.bounds.extent().max_element();
        let face = widened(&face(&part.bounds, &plane), side);
        let is_wide = side > WIDEST * radii.0;
        let (left, right) = pool.divide(&part.list, &plane, &face);
        let separates_none = left.len().min(right.len()) == part.list.len();
        if separates_none && !is_wide && are_coincident(pool.list(&part.list)) {
            return Division::Leaf(part.list.clone());
        }
        let (left_bounds, right_bounds) = cut(&part.bounds, plane.axis, plane.at);
        let depth = part.depth + 1;
        let left = Part { list: left, bounds: left_bounds, cell: part.cell, depth };
        let right = Part { list: right, bounds: right_bounds, cell: part.cell, depth };
        match (self.classify(pool, &left), self.classify(pool, &right)) {
            (None, None) => Division::Nothing,
            (Some(only), None) | (None, Some(only)) => Division::One(only),
            (Some(left), Some(right)) => {
                Division::Two(Halves { axis: plane.axis, left, right, left_own: 0 })
            }
        }
    }

    /// Drops the list of a part that is solid, and fits any other to where its balls can make a
    /// surface. `None` where they cannot.
    pub(super) fn classify(&self, pool: &mut Pool, part: &Part) -> Option<Part> {
        let list = pool.list_mut(&part.list);
        if self.is_solid(list, &widened(&part.bounds, part.bounds.extent().max_element())) {
            return Some(Part { list: part.list.start..part.list.start, ..*part });
        }
        // Where the field is T, so much at least is added.
        let (_, positive) = self.by_sign(list);
        let strength = match self.strength {
            Some(strength) => f64::from(strength) * positive.len() as f64,
            None => positive.iter().map(|ball| f64::from(ball.strength)).sum(),
        };
        let reach = Reach::per_ball(self.kernel, self.threshold, strength)?;
        let bounds = reach.clip(positive, &part.bounds);
        if bounds.is_empty() {
            return None;
        }
        let mut kept = list.len();
        if bounds != part.bounds {
            kept = keep_reaching(list, &widened(&bounds, bounds.extent().max_element()));
        }
        // No list means solid; so a part that nothing reaches must not stay.
        (kept > 0).then(|| Part { list: part.list.start..part.list.start + kept, bounds, ..*part })
    }

    /// The plane to cut the node at; `None` where it is to be a leaf.
    fn classified_plane(
        &self,
        classes: &Classes,
        list: &[Ball],
        part: &Part,
        (least, largest): (f32, f32),
    ) -> Option<Plane> {
        let axis = longest_axis(&part.bounds);
        let side = part.bounds.extent()[axis];
        let filled = list.len() as f32 / classes.leaf_size.max(1) as f32;
        let smallest = classes.smallest_side / if filled > LONG { filled.cbrt() } else { 1.0 };
        let is_short = |radius: f32| side < smallest * radius;
        let is_wide = side > WIDEST * least;
        // The mean lies between the extremes, and takes longer to compute.
        let is_small = list.len() <= classes.leaf_size as usize
            || is_short(least)
            || is_short(largest) && is_short(self.mean_radius(list, &part.bounds));
        if is_small && !is_wide {
            return None;
        }
        let binned = || {
            let bins = self.options.bins as usize;
            cut_space(list, &part.bounds, bins, Cost::Linear)
                .filter(|plane| plane.cost < WORTHWHILE * list.len() as f32)
        };
        let middle = Plane { axis, at: part.bounds.center()[axis], cost: f32::MAX };
        let plane = if side > BINNED * least { binned().unwrap_or(middle) } else { middle };
        // Neighbouring floats have no middle.
        let (low, high) = (part.bounds.min[plane.axis], part.bounds.max[plane.axis]);
        let is_worthwhile = is_wide || Self::shortens_lists(classes, list, part, &plane);
        (low < plane.at && plane.at < high && is_worthwhile).then_some(plane)
    }

    /// Whether a cut shortens the lists, where a box is almost small enough for a leaf.
    fn shortens_lists(classes: &Classes, list: &[Ball], part: &Part, plane: &Plane) -> bool {
        if list.len() > 2 * classes.leaf_size as usize {
            return true;
        }
        let face = face(&part.bounds, plane);
        let crossing = list.iter().filter(|ball| ball.reaches(&face)).count();
        crossing as f32 <= SHARED * list.len() as f32
    }

    /// The least and the largest radius of a list.
    fn radii(&self, list: &[Ball]) -> (f32, f32) {
        self.radius.map_or_else(|| radii(list), |radius| (radius, radius))
    }

    /// Mean radius of the balls, each weighted by the most that it adds or takes away in the box.
    fn mean_radius(&self, list: &[Ball], bounds: &Aabb) -> f32 {
        let (low, high) = (Vec3A::from(bounds.min), Vec3A::from(bounds.max));
        let (sum, weights) = list.iter().fold((0.0, 0.0), |(sum, weights), ball| {
            let offset = ball.center() - ball.center().clamp(low, high);
            let radius = ball.radius();
            let depth = 1.0 - offset.length_squared() / (radius * radius);
            let weight = ball.strength.abs() * self.kernel.value_at_depth(depth);
            (sum + weight * radius, weights + weight)
        });
        sum / weights.max(f32::MIN_POSITIVE)
    }
}

/// The box grown by [`WIDENED`] of the longest side.
fn widened(bounds: &Aabb, side: f32) -> Aabb {
    let wider = Vec3::splat(WIDENED * side);
    Aabb { min: bounds.min - wider, max: bounds.max + wider }
}

/// Whether the centres almost coincide: every part of the box, however often it is cut, is then
/// reached by all of the balls.
fn are_coincident(list: &[Ball]) -> bool {
    centers_of(list).extent().max_element() <= COINCIDENT * radii(list).0
}

/// The least and the largest radius.
fn radii(list: &[Ball]) -> (f32, f32) {
    list.iter().fold((f32::MAX, 0.0), |(least, largest), ball| {
        (least.min(ball.radius()), largest.max(ball.radius()))
    })
}
