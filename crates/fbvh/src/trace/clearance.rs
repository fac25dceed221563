//! How far from a hit secondary rays start.
//!
//! A secondary ray must start on the side of the surface that it leaves to, or it would find the surface
//! it comes from; started too far off it would step over thin gaps. How far is enough follows from how
//! far the hit can be from the surface, u = 2⁻²³:
//!
//! - *Uncertainty of the field.* The search knows F at the hit to ± δ, δ = Σ |qᵢ|k′(vᵢ)·δvᵢ plus the
//!   tolerance of the search (0 for the certified tree, tolerance·T for the published ones). δvᵢ is
//!   u(26 + (24·D + 2⁻⁸·t)/Rᵢ) in a leaf of diagonal D, which no margin of the search itself exceeds.
//!   So the surface is within δ/|∇F| of the hit. The start's own field is bounded with the same margins,
//!   to ± δ again, and the gradient may halve in between: 4δ/|∇F| along the normal put the start where
//!   the search is certain of its side.
//! - *Where the field is flat* a first-order step would be long, but there the field falls by
//!   curvature, q·k″/R² per unit squared: δ of 2⁻¹⁶ is made up for within 2⁻⁸R, and no step is longer.
//! - *Rounding of the point.* o + t·d errs by u(|o| + 2t + |o + t·d|) at the most, and the moved start is
//!   rounded again: twice that, and twice more since d is unit to rounding only.
//!
//! The sum is the hit's clearance. All its terms scale with the scene, and with the coordinates' size
//! only as f32 resolves them; nothing is tuned. A start whose side is still uncertain is answered
//! *undecided*.
//!
//! These are the margins of f32 on an adapter (`shaders/wgsl/fbvh/trace.wgsl`, the twin of this). Searches
//! in f64 need less; but with the same clearance the same picture follows, and the search for the next
//! hit is decided in f32 where it starts.

use glam::Vec3;
use metaball_core::{Ray, SurfaceHit};

use super::field_tree::FieldTree;
use crate::Field;

const UNIT: f32 = f32::EPSILON;

impl<F: Field> FieldTree<'_, F> {
    /// The clearance of a hit; where none was found, what rounding alone does to its point. `tolerance`
    /// is the part of T within which the search ends.
    pub(super) fn clearance(&self, ray: &Ray, found: &SurfaceHit, tolerance: Option<f32>) -> f32 {
        let t = found.hit.t;
        let rounding = rounding_at(ray, t);
        let Some(leaf) = self.leaf_of(found) else { return rounding };
        let bounds = self.tree.leaves[leaf].bounds();
        let diagonal = bounds.extent().length();
        let depth_error = |distance: f32, radius: f32| match tolerance {
            None => UNIT * (26.0 + (24.0 * diagonal + t / 256.0) / radius),
            Some(_) => UNIT * (6.0 + 4.0 * (2.0 * t + distance) / radius),
        };
        let kernel = self.field.kernel();
        let along = t * ray.direction;
        let mut slope = Vec3::ZERO;
        let mut error = tolerance.unwrap_or(0.0) * self.field.threshold();
        let mut smallest = f32::MAX;
        for &ball in self.tree.list(leaf) {
            let support = self.field.support(ball as usize);
            let radius = support.radius;
            let square = radius * radius;
            let offset = (ray.origin - support.center) + along;
            let v = 1.0 - offset.length_squared() / square;
            if v > 0.0 {
                let steepness = self.field.strength(ball as usize) * kernel.slope_at_depth(v);
                slope += offset * (2.0 * steepness / square);
                error += steepness.abs() * depth_error(offset.length(), radius);
                smallest = smallest.min(radius);
            }
        }
        let flattest = slope.length().max(error / (smallest * (1.0 / 1024.0)));
        4.0 * error / flattest.max(f32::MIN_POSITIVE) + rounding
    }

    /// The leaf that a hit was found in.
    pub(super) fn leaf_of(&self, found: &SurfaceHit) -> Option<usize> {
        let leaf = found.place as usize;
        (leaf < self.tree.leaf_count()).then_some(leaf)
    }
}

/// Four times what rounding may do to the point of a ray at t.
pub(super) fn rounding_at(ray: &Ray, t: f32) -> f32 {
    let end = ray.origin + t * ray.direction;
    4.0 * UNIT * (ray.origin.length() + 2.0 * t + end.length())
}
