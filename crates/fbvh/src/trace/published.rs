//! Rays through the published trees: sections 4 and 5.2, in f32.

use metaball_core::{Hit, Ray, SurfaceHit, Verdict};

use super::counter::Counter;
use super::field_tree::FieldTree;
use super::secant::{LeafSearch, SecantSearch};
use crate::{Field, Kind};

/// A published tree, and how its leaves are searched.
pub(super) struct Published<'a, F> {
    pub(super) tree: &'a FieldTree<'a, F>,
    pub(super) options: &'a SecantSearch,
}

impl<F: Field> Published<'_, F> {
    /// Where the ray first enters the solid.
    pub(super) fn hit(&self, ray: &Ray, counter: &mut impl Counter) -> SurfaceHit {
        if let Some(leaf) = self.start_inside(ray, counter) {
            return self.tree.hit_at(Verdict::Inside, leaf, ray, ray.t_min);
        }
        let tree = self.tree.tree;
        let found = if tree.kind == Kind::ModifiedBvh {
            // The search sees beyond the nearest hit so far: its bracket ends at a projection, which
            // may lie behind it though the surface is in front.
            tree.nearest_of_all(ray, counter, |leaf, counter| {
                self.leaf(leaf, ray).root((ray.t_min, ray.t_max), counter)
            })
        } else {
            tree.first_in_order(ray, counter, |leaf, interval, counter| {
                let t = self.leaf(leaf, ray).root(interval, counter)?;
                Some((leaf, t))
            })
        };
        found.map_or(SurfaceHit::MISS, |(leaf, t)| self.tree.hit_at(Verdict::Hit, leaf, ray, t))
    }

    /// Whether there is solid on the ray: the paper's bracket ends at a point inside.
    pub(super) fn any(&self, ray: &Ray) -> SurfaceHit {
        let found = |verdict| SurfaceHit { hit: Hit { verdict, ..Hit::MISS }, ..SurfaceHit::MISS };
        if self.start_inside(ray, &mut ()).is_some() {
            return found(Verdict::Inside);
        }
        let bracket = self.tree.tree.first_in_order(ray, &mut (), |leaf, interval, counter| {
            self.leaf(leaf, ray).bracket(interval, counter)
        });
        bracket.map_or(SurfaceHit::MISS, |_| found(Verdict::Hit))
    }

    /// A leaf by whose list the ray starts inside the solid.
    ///
    /// Lists of the Fitted BVH are complete in the leaf's box. Those of the modified BVH are so in
    /// the supports of the leaf's own balls.
    fn start_inside(&self, ray: &Ray, counter: &mut impl Counter) -> Option<usize> {
        if ray.is_empty() {
            return None;
        }
        let FieldTree { tree, field, .. } = *self.tree;
        let start = ray.origin + ray.t_min * ray.direction;
        let is_complete = |leaf| {
            let mut own = tree.leaf_balls(leaf).0.iter();
            tree.kind == Kind::Fitted
                || own.any(|&ball| {
                    let support = field.support(ball as usize);
                    support.center.distance_squared(start) <= support.radius.powi(2)
                })
        };
        tree.leaf_around(|bounds| bounds.contains(start), is_complete)
            .filter(|&leaf| self.tree.value(leaf, ray, ray.t_min, counter) >= field.threshold())
    }

    fn leaf<'a>(&'a self, leaf: usize, ray: &'a Ray) -> LeafSearch<'a, F> {
        LeafSearch { tree: self.tree, options: self.options, leaf, ray }
    }
}
