//! A tree together with the field that it was built from.

use glam::Vec3;
use metaball_core::{Hit, Ray, SurfaceHit, Verdict};

use super::certified::Polynomials;
use super::counter::Counter;
use crate::{Field, Tree};

/// What rays are traced through. The field along a ray is summed over the list of one leaf.
#[derive(Debug)]
pub(super) struct FieldTree<'a, F> {
    pub(super) tree: &'a Tree,
    pub(super) field: &'a F,
    /// Of the certified tree's leaves.
    pub(super) polynomials: Polynomials,
}

/// How many balls of a list of the certified tree are negative: these come first.
#[inline]
pub(super) fn negative_balls(field: &impl Field, list: &[u32]) -> usize {
    let is_negative = |&ball: &u32| field.strength(ball as usize) < 0.0;
    if list.first().is_some_and(is_negative) { list.partition_point(is_negative) } else { 0 }
}

impl<F: Field> FieldTree<'_, F> {
    /// F along the ray, by the leaf's list. From the ball's centre to the ray's origin first: that
    /// difference is right to a float.
    pub(super) fn value(&self, leaf: usize, ray: &Ray, t: f32, counter: &mut impl Counter) -> f32 {
        counter.evaluation();
        let kernel = self.field.kernel();
        let along = t * ray.direction;
        self.tree.list(leaf).iter().fold(0.0, |sum, &ball| {
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
        let descent = self.tree.list(leaf).iter().fold(Vec3::ZERO, |sum, &ball| {
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

    /// A verdict about a point of the ray in a leaf, with the normal there.
    pub(super) fn hit_at(&self, verdict: Verdict, leaf: usize, ray: &Ray, t: f32) -> SurfaceHit {
        let hit = Hit { verdict, fallback: false, t, normal: self.normal(leaf, ray, t) };
        SurfaceHit { hit, place: leaf as u32 }
    }
}
