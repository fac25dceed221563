//! Dividing a node of the Fitted BVH: section 5.1, algorithm 2.

use metaball_core::Aabb;

use super::{Builder, Division, MEDIAN_FROM, Part, gather, partition};
use crate::ball::Ball;
use crate::fit::{Reach, discard};
use crate::options::{Boxes, Fitting};
use crate::plane::{Plane, centers_of, cut, cut_space, longest_axis, weigh};

impl Builder {
    /// Cuts the node's box, gives each part the balls that reach it, and fits it to them.
    pub(super) fn divide_fitted(
        &self,
        fitting: &Fitting,
        own: &mut [Ball],
        pool: &mut Vec<Ball>,
        part: &Part,
    ) -> Division {
        let Some(Plane { axis, at, .. }) = self.plane(own, &pool[part.splits.clone()], part) else {
            return Division::Leaf(part.splits.clone());
        };
        let (left_bounds, right_bounds) = cut(&part.bounds, axis, at);
        let middle = partition(own, |ball| ball.center[axis] < at);
        let (left_own, right_own) = own.split_at_mut(middle);

        let start = pool.len();
        gather(pool, &part.splits, right_own, |ball| ball.reaches(&left_bounds));
        let left = self.fit(fitting, left_own, pool, start, left_bounds, part.depth + 1);
        let start = pool.len();
        gather(pool, &part.splits, left_own, |ball| ball.reaches(&right_bounds));
        let right = self.fit(fitting, right_own, pool, start, right_bounds, part.depth + 1);
        match (left, right) {
            (None, None) => Division::Nothing,
            (Some((kept, left)), None) => Division::One(0..kept, left),
            (None, Some((kept, right))) => Division::One(middle..middle + kept, right),
            (Some((left_kept, left)), Some((right_kept, right))) => {
                Division::Two(axis, (0..left_kept, left), (middle..middle + right_kept, right))
            }
        }
    }

    /// Fits a part to its balls: its own, and the split balls that end the pool. Own balls that do
    /// not reach it go to the back of the slice; the number of the others is returned. `None` where
    /// no surface can be.
    pub(super) fn fit(
        &self,
        fitting: &Fitting,
        own: &mut [Ball],
        pool: &mut Vec<Ball>,
        start: usize,
        bounds: Aabb,
        depth: usize,
    ) -> Option<(usize, Part)> {
        let mut kept = partition(own, |ball| ball.reaches(&bounds));
        let balls = || own[..kept].iter().chain(&pool[start..]);
        let reach = Reach::of(fitting.boxes, self.kernel, self.threshold, balls());
        let bounds = match (reach, fitting.boxes) {
            (None, _) => Aabb::EMPTY,
            (Some(_), Boxes::Cut) => bounds,
            (Some(reach), _) => balls()
                .fold(Aabb::EMPTY, |around, ball| around.union(&reach.bounds(ball)))
                .intersection(&bounds),
        };
        let Some(reach) = reach.filter(|_| !bounds.is_empty() && kept + pool.len() > start) else {
            pool.truncate(start);
            return None;
        };

        // A box fitted to the supports still meets all of them; a tighter one may not.
        if !matches!(reach, Reach::Support) {
            kept = partition(&mut own[..kept], |ball| ball.reaches(&bounds));
            let reaching = partition(&mut pool[start..], |ball| ball.reaches(&bounds));
            pool.truncate(start + reaching);
        }
        if kept + pool.len() - start <= fitting.discard_up_to as usize {
            let reach = self.discarding_reach(fitting, reach, &own[..kept], &pool[start..])?;
            let left = discard(reach, &bounds, &own[..kept], &mut pool[start..]);
            pool.truncate(start + left);
        }
        Some((kept, Part { splits: start..pool.len(), bounds, depth }))
    }

    /// Discarding needs the radii of section 5.3.1 even where the boxes are not fitted to them.
    fn discarding_reach(
        &self,
        fitting: &Fitting,
        reach: Reach,
        own: &[Ball],
        splits: &[Ball],
    ) -> Option<Reach> {
        match fitting.boxes {
            Boxes::PerNode | Boxes::PerBall => Some(reach),
            Boxes::Cut | Boxes::Support => {
                let balls = own.iter().chain(splits);
                Reach::of(Boxes::PerNode, self.kernel, self.threshold, balls)
            }
        }
    }

    /// The plane to cut the node at; `None` where it had better be a leaf.
    fn plane(&self, own: &mut [Ball], splits: &[Ball], part: &Part) -> Option<Plane> {
        let options = &self.options;
        let count = own.len() + splits.len();
        let cost = options.cost.of(count);
        if part.depth >= self.max_depth
            || count <= options.leaf_size as usize
            || cost <= options.traversal_cost
        {
            return None;
        }
        let plane = if part.depth >= MEDIAN_FROM {
            let axis = longest_axis(&centers_of(own));
            let middle = own.len() / 2;
            if own.is_empty() {
                return None;
            }
            let by_axis = |a: &Ball, b: &Ball| {
                a.center[axis].total_cmp(&b.center[axis]).then(a.index.cmp(&b.index))
            };
            let at = own.select_nth_unstable_by(middle, by_axis).1.center[axis];
            weigh(own.iter().chain(splits), &part.bounds, (axis, at), options.cost)
        } else if count > options.halve_above as usize {
            let axis = longest_axis(&part.bounds);
            let at = part.bounds.center()[axis];
            weigh(own.iter().chain(splits), &part.bounds, (axis, at), options.cost)
        } else {
            cut_space(own.iter().chain(splits), &part.bounds, options.bins as usize, options.cost)
        };
        plane.filter(|plane| options.traversal_cost + plane.cost < cost)
    }
}
