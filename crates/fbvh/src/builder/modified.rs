//! Dividing a node of the modified BVH: section 4.1, algorithm 1.

use std::ops::Range;

use super::ball::{Ball, bounds_of, partition};
use super::part::{Division, Halves, Part};
use super::plane::{centers_of, cut_centers, longest_axis};
use super::pool::Pool;
use super::{Builder, MEDIAN_FROM};

/// Split balls of nodes with at most this many own balls are tested against each of them; above,
/// against the box around the own balls. The leaves' lists are the same either way, since a ball that
/// meets one of the leaf's own balls meets every box above it.
const EXACT_UP_TO: usize = 32;

impl Builder<'_> {
    /// Distributes own balls by their centres, and finds each part's split balls.
    pub(super) fn divide_modified(
        &self,
        own: &mut [Ball],
        pool: &mut Pool,
        part: &Part,
    ) -> Division {
        let Some((axis, middle)) = self.part_centers(own, part) else {
            return Division::Leaf(exact_splits(own, pool, &part.list));
        };
        let (left_own, right_own) = own.split_at(middle);
        let side = |pool: &mut Pool, own: &[Ball], others: &[Ball]| {
            let start = pool.top();
            let bounds = bounds_of(own);
            gather(pool, &part.list, others, |ball| {
                ball.reaches(&bounds) && (own.len() > EXACT_UP_TO || meets_any(ball, own))
            });
            Part { list: start..pool.top(), bounds, cell: part.cell, depth: part.depth + 1 }
        };
        let left = side(pool, left_own, right_own);
        let right = side(pool, right_own, left_own);
        Division::Two(Halves { axis, left, right, left_own: middle })
    }

    /// Moves the balls that belong to the left to the front, and returns the axis and how many they
    /// are; `None` where a leaf is cheaper.
    fn part_centers(&self, own: &mut [Ball], part: &Part) -> Option<(usize, usize)> {
        let options = &self.options;
        if part.depth >= self.max_depth || own.len() <= options.leaf_size as usize {
            return None;
        }
        let centers = centers_of(own);
        let longest = longest_axis(&centers);
        if centers.extent()[longest] <= 0.0 {
            return None;
        }
        let (axis, at) = if part.depth >= MEDIAN_FROM {
            (longest, f32::NAN)
        } else if own.len() > options.halve_above as usize {
            (longest, centers.center()[longest])
        } else {
            let plane = cut_centers(own, &part.bounds, options.bins as usize, options.cost)?;
            if options.traversal_cost + plane.cost >= options.cost.of(own.len() as f32) {
                return None;
            }
            (plane.axis, plane.at)
        };
        let left = partition(own, |ball| ball.center()[axis] < at);
        if left > 0 && left < own.len() {
            return Some((axis, left));
        }
        // No plane, or one that rounding moved past the last centre: halve by number.
        let middle = own.len() / 2;
        own.select_nth_unstable_by(middle, |a, b| {
            a.center()[axis].total_cmp(&b.center()[axis]).then(a.index.cmp(&b.index))
        });
        Some((axis, middle))
    }
}

/// The split balls of a leaf, tested against each own ball unless its node was small enough for that.
fn exact_splits(own: &[Ball], pool: &mut Pool, splits: &Range<usize>) -> Range<usize> {
    if own.len() <= EXACT_UP_TO {
        return splits.clone();
    }
    let start = pool.top();
    gather(pool, splits, &[], |ball| meets_any(ball, own));
    start..pool.top()
}

fn meets_any(ball: &Ball, own: &[Ball]) -> bool {
    own.iter().any(|other| ball.overlaps(other))
}

/// Appends to the pool those of a list in it and of `others` that satisfy the test.
fn gather(pool: &mut Pool, list: &Range<usize>, others: &[Ball], test: impl Fn(&Ball) -> bool) {
    for at in list.clone() {
        let ball = pool.ball(at);
        if test(&ball) {
            pool.push(ball);
        }
    }
    others.iter().filter(|ball| test(ball)).for_each(|ball| pool.push(*ball));
}
