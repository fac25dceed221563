//! Dividing a node of the Fitted BVH: section 5.1, algorithm 2.

use super::ball::{Ball, partition};
use super::fit::{Reach, discard, keep_reaching};
use super::part::{Division, Halves, Part};
use super::plane::{Plane, centers_of, cut, cut_space, face, longest_axis, weigh};
use super::pool::Pool;
use super::{Builder, MEDIAN_FROM};
use crate::options::{Boxes, Fitting};

impl Builder<'_> {
    /// Cuts the node's box, gives each part the balls that reach it, and fits it to them.
    pub(super) fn divide_fitted(
        &self,
        fitting: &Fitting,
        pool: &mut Pool,
        part: &Part,
    ) -> Division {
        let Some(plane) = self.plane(pool.list_mut(&part.list), part) else {
            return Division::Leaf(part.list.clone());
        };
        let (left, right) = pool.divide(&part.list, &plane, &face(&part.bounds, &plane));
        let (left_bounds, right_bounds) = cut(&part.bounds, plane.axis, plane.at);
        let (left_cell, right_cell) = part.cell.cut(&plane);
        let depth = part.depth + 1;
        let left = Part { list: left, bounds: left_bounds, cell: left_cell, depth };
        let right = Part { list: right, bounds: right_bounds, cell: right_cell, depth };
        match (self.fit(fitting, pool, &left), self.fit(fitting, pool, &right)) {
            (None, None) => Division::Nothing,
            (Some(only), None) | (None, Some(only)) => Division::One(only),
            (Some(left), Some(right)) => {
                Division::Two(Halves { axis: plane.axis, left, right, left_own: 0 })
            }
        }
    }

    /// Fits a part, cut from the node above, to its balls. `None` where no surface can be.
    pub(super) fn fit(&self, fitting: &Fitting, pool: &mut Pool, part: &Part) -> Option<Part> {
        let list = pool.list_mut(&part.list);
        let reach = Reach::of(fitting.boxes, self.kernel, self.threshold, list)?;
        let bounds = match fitting.boxes {
            Boxes::Cut => part.bounds,
            _ => reach.clip(list, &part.bounds),
        };
        if bounds.is_empty() {
            return None;
        }
        // A box fitted to the supports still meets all of them; a tighter one may not.
        let mut kept = list.len();
        if matches!(fitting.boxes, Boxes::PerNode | Boxes::PerBall) && bounds != part.bounds {
            kept = keep_reaching(list, &bounds);
        }
        if kept <= fitting.discard_up_to as usize {
            let list = &mut list[..kept];
            let reach = self.discarding_reach(fitting, reach, list)?;
            kept = discard(reach, &bounds, list, |ball| part.cell.owns(ball));
        }
        (kept > 0).then(|| Part { list: part.list.start..part.list.start + kept, bounds, ..*part })
    }

    /// Discarding needs the radii of section 5.3.1 even where the boxes are not fitted to them.
    fn discarding_reach(&self, fitting: &Fitting, reach: Reach, list: &[Ball]) -> Option<Reach> {
        match fitting.boxes {
            Boxes::PerNode | Boxes::PerBall => Some(reach),
            Boxes::Cut | Boxes::Support => {
                Reach::of(Boxes::PerNode, self.kernel, self.threshold, list)
            }
        }
    }

    /// The plane to cut the node at; `None` where a leaf is cheaper.
    fn plane(&self, list: &mut [Ball], part: &Part) -> Option<Plane> {
        let options = &self.options;
        let cost = options.cost.of(list.len() as f32);
        if part.depth >= self.max_depth
            || list.len() <= options.leaf_size as usize
            || cost <= options.traversal_cost
        {
            return None;
        }
        let plane = if part.depth >= MEDIAN_FROM {
            let own = partition(list, |ball| part.cell.owns(ball));
            let through = middle_of(&mut list[..own])?;
            weigh(list, &part.bounds, through, options.cost)
        } else if list.len() > options.halve_above as usize {
            let axis = longest_axis(&part.bounds);
            weigh(list, &part.bounds, (axis, part.bounds.center()[axis]), options.cost)
        } else {
            cut_space(list, &part.bounds, options.bins as usize, options.cost)
        };
        plane.filter(|plane| options.traversal_cost + plane.cost < cost)
    }
}

/// The axis along which the centres are farthest apart, and the middle one of them along it.
fn middle_of(own: &mut [Ball]) -> Option<(usize, f32)> {
    let axis = longest_axis(&centers_of(own));
    let by_axis = |a: &Ball, b: &Ball| {
        a.center()[axis].total_cmp(&b.center()[axis]).then(a.index.cmp(&b.index))
    };
    let middle = own.len() / 2;
    if own.is_empty() {
        return None;
    }
    Some((axis, own.select_nth_unstable_by(middle, by_axis).1.center()[axis]))
}
