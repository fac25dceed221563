//! The spacing of particles, from which those get a radius that have none.

use std::collections::HashMap;

use glam::{DVec3, I64Vec3};
use rayon::prelude::*;

use crate::balls::Positions;

/// Particles whose nearest neighbours are looked for.
const SAMPLES: usize = 1001;

/// The median distance from a particle to its nearest neighbour at another position, over at most 1,001
/// particles picked at equal steps through the list. `None` where all are at one position.
///
/// Distances to a few of the others bound those to all. Where half of the bounds are at most b, so is the
/// median, and only neighbours nearer than b count: they are found in cells of that size.
pub(crate) fn median_spacing<P: Positions>(positions: &P) -> Option<f64> {
    let count = positions.count();
    if (1..count).all(|index| positions.at(index) == positions.at(0)) {
        return None;
    }
    let samples = picked(positions, SAMPLES);
    let mut bounds = nearest(&samples, &picked(positions, 10 * SAMPLES));
    let middle = samples.len() / 2;
    let bound = *bounds.select_nth_unstable_by(middle, f64::total_cmp).1;
    let mut distances = if bound.is_finite() {
        nearest_within(&samples, positions, bound)
    } else {
        nearest(&samples, positions)
    };
    Some(*distances.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// At most so many of them, at equal steps.
pub(crate) fn picked<P: Positions>(positions: &P, most: usize) -> Vec<DVec3> {
    let count = positions.count();
    let step = count.div_ceil(most).max(1);
    (0..count).step_by(step).map(|index| positions.at(index)).collect()
}

/// For each sample the least distance above 0 to any of the positions.
fn nearest<P: Positions>(samples: &[DVec3], positions: &P) -> Vec<f64> {
    let nearest = |sample: &DVec3| {
        let all = (0..positions.count()).map(|index| positions.at(index));
        let distances = all.map(|position| sample.distance(position));
        distances.filter(|distance| *distance > 0.0).fold(f64::INFINITY, f64::min)
    };
    samples.par_iter().map(nearest).collect()
}

/// The same where it is at most `bound`; where it is more, anything from it to infinity.
fn nearest_within<P: Positions>(samples: &[DVec3], positions: &P, bound: f64) -> Vec<f64> {
    let cell = |position: DVec3| (position / bound).floor().as_i64vec3();
    let mut near: HashMap<I64Vec3, Vec<usize>> = HashMap::new();
    for (index, sample) in samples.iter().enumerate() {
        let middle = cell(*sample);
        for neighbour in 0..27 {
            let step = I64Vec3::new(neighbour % 3, neighbour / 3 % 3, neighbour / 9) - I64Vec3::ONE;
            near.entry(middle.saturating_add(step)).or_default().push(index);
        }
    }
    let infinite = || vec![f64::INFINITY; samples.len()];
    let nearer = |mut distances: Vec<f64>, position: usize| {
        let position = positions.at(position);
        for index in near.get(&cell(position)).into_iter().flatten() {
            let distance = samples[*index].distance(position);
            if distance > 0.0 && distance < distances[*index] {
                distances[*index] = distance;
            }
        }
        distances
    };
    let least = |mut mine: Vec<f64>, others: Vec<f64>| {
        mine.iter_mut().zip(others).for_each(|(mine, other)| *mine = mine.min(other));
        mine
    };
    (0..positions.count()).into_par_iter().fold(infinite, nearer).reduce(infinite, least)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn particles_at_one_position_have_no_spacing() {
        assert_eq!(median_spacing(&Vec::new()), None);
        assert_eq!(median_spacing(&vec![DVec3::ONE; 3]), None);
        assert_eq!(median_spacing(&vec![DVec3::ZERO, DVec3::ZERO, DVec3::X]), Some(1.0));
    }

    proptest! {
        /// The median over bounded neighbours is the one over all.
        #[test]
        fn bounds_change_nothing(
            points in prop::collection::vec(prop::array::uniform3(-3i32..3), 1..60),
            outlier in 0..2_i32,
        ) {
            let mut positions: Vec<DVec3> =
                points.iter().map(|point| DVec3::from_array(point.map(f64::from))).collect();
            positions.push(DVec3::X * 1e12 * f64::from(outlier));
            let mut all = nearest(&positions, &positions);
            all.retain(|distance| distance.is_finite());
            let middle = positions.len() / 2;
            let expected = (!all.is_empty())
                .then(|| *all.select_nth_unstable_by(middle, f64::total_cmp).1);
            prop_assert_eq!(median_spacing(&positions), expected);
        }
    }
}
