//! Sums over the neighbours of points.

use glam::{DVec3, I64Vec3};
use rayon::prelude::*;

/// Weighted points in the order of cells: along z, then y, then x, so that neighbours along x are one after the
/// other.
pub(super) struct Neighbours {
    least: DVec3,
    width: f64,
    /// The cell of each point, in order.
    cells: Vec<[i64; 3]>,
    points: Vec<(DVec3, f64)>,
}

impl Neighbours {
    /// Points and weights, in cells for so large reaches.
    pub(super) fn new(points: impl Iterator<Item = (DVec3, f64)>, reaches: &[f32]) -> Self {
        let points: Vec<(DVec3, f64)> = points.collect();
        let least = points.iter().map(|(at, _)| *at).fold(DVec3::INFINITY, DVec3::min);
        let width = width_for(reaches);
        let mut in_order: Vec<([i64; 3], u32)> = points
            .par_iter()
            .enumerate()
            .map(|(index, (at, _))| (cell_of((*at - least) / width), index as u32))
            .collect();
        in_order.par_sort_unstable();
        let points = in_order.par_iter().map(|(_, index)| points[*index as usize]).collect();
        let cells = in_order.into_par_iter().map(|(cell, _)| cell).collect();
        Self { least, width, cells, points }
    }

    /// For each place the sum of weight·f(d²/reach²) over the points nearer to it than its reach.
    pub(super) fn sums(
        &self,
        places: &[DVec3],
        reaches: &[f32],
        f: impl Fn(f64) -> f64 + Sync,
    ) -> Vec<f64> {
        let sum = |(place, reach): (&DVec3, &f32)| {
            let reach = f64::from(*reach);
            let per_squared = 1.0 / (reach * reach);
            let mut sum = 0.0;
            self.near(*place, reach, |at, weight| {
                let squared_ratio = (at - *place).length_squared() * per_squared;
                if squared_ratio < 1.0 {
                    sum += weight * f(squared_ratio);
                }
            });
            sum
        };
        places.par_iter().zip(reaches).map(sum).collect()
    }

    /// All points nearer than a reach, and some others.
    fn near(&self, place: DVec3, reach: f64, mut visit: impl FnMut(DVec3, f64)) {
        let middle = place - self.least;
        let [from_z, from_y, from_x] = cell_of((middle - reach) / self.width);
        let [to_z, to_y, to_x] = cell_of((middle + reach) / self.width);
        let rows = |from: i64, to: i64| i128::from(to) - i128::from(from) + 1;
        if rows(from_z, to_z).saturating_mul(rows(from_y, to_y)) > self.points.len() as i128 {
            self.points.iter().for_each(|(at, weight)| visit(*at, *weight));
            return;
        }
        for z in from_z..=to_z {
            for y in from_y..=to_y {
                let start = self.cells.partition_point(|cell| *cell < [z, y, from_x]);
                let row = self.cells[start..].iter().take_while(|cell| **cell <= [z, y, to_x]);
                for (at, weight) in &self.points[start..start + row.count()] {
                    visit(*at, *weight);
                }
            }
        }
    }
}

/// The width of cells: the greatest reach, but no more than four times the middle one, so that few points with a
/// large reach do not make many of a small one look far.
fn width_for(reaches: &[f32]) -> f64 {
    let mut reaches: Vec<f32> = reaches.to_vec();
    let middle = reaches.len() / 2;
    if reaches.is_empty() {
        return 1.0;
    }
    let median = *reaches.select_nth_unstable_by(middle, f32::total_cmp).1;
    let most = reaches.into_iter().fold(median, f32::max);
    f64::from(most.min(4.0 * median))
}

/// The cell of a place in widths, as it is ordered.
fn cell_of(place: DVec3) -> [i64; 3] {
    let I64Vec3 { x, y, z } = place.floor().as_i64vec3();
    [z, y, x]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Cells change nothing: all pairs give the same sums, but for the order of summing.
        #[test]
        fn sums_are_those_over_all_pairs(
            points in prop::collection::vec((prop::array::uniform3(-3.0f64..3.0), 0.1f64..2.0), 1..60),
            reaches in prop::collection::vec(
                prop_oneof![8 => 0.1f32..9.0, 1 => Just(f32::MIN_POSITIVE), 1 => Just(f32::MAX)],
                60,
            ),
            shift in prop::sample::select(vec![0.0, -1e9]),
        ) {
            let points: Vec<(DVec3, f64)> = points
                .into_iter()
                .map(|(at, weight)| (DVec3::from_array(at) + shift, weight))
                .collect();
            let places: Vec<DVec3> = points.iter().map(|(at, _)| *at).collect();
            let reaches = &reaches[..places.len()];
            let neighbours = Neighbours::new(points.iter().copied(), reaches);
            let f = |squared: f64| 1.0 - squared;
            let sums = neighbours.sums(&places, reaches, f);
            for (index, place) in places.iter().enumerate() {
                let reach = f64::from(reaches[index]);
                let share = |(at, weight): &(DVec3, f64)| {
                    weight * f((*at - *place).length_squared() / (reach * reach)).max(0.0)
                };
                let expected: f64 = points.iter().map(share).sum();
                prop_assert!((sums[index] - expected).abs() < 1e-9 * (1.0 + expected));
            }
        }
    }
}
