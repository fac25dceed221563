//! The spacing of particles, from which those get a radius that have none.

use glam::Vec3;

/// The median distance from a particle to its nearest neighbour at another position, over at most 1,001
/// particles picked at equal steps through the list. `None` where all are at one position.
pub(crate) fn median_spacing(centers: &[Vec3]) -> Option<f32> {
    let step = centers.len().div_ceil(1001).max(1);
    let mut distances: Vec<f32> = centers
        .iter()
        .step_by(step)
        .filter_map(|center| {
            let squared = centers
                .iter()
                .map(|other| center.distance_squared(*other))
                .filter(|squared| *squared > 0.0)
                .fold(f32::INFINITY, f32::min);
            squared.is_finite().then(|| squared.sqrt())
        })
        .collect();
    let middle = distances.len() / 2;
    (!distances.is_empty()).then(|| *distances.select_nth_unstable_by(middle, f32::total_cmp).1)
}
