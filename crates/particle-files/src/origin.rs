//! Where a scene's coordinates begin: particles far from their file's origin lose digits in f32.

use glam::DVec3;
use rayon::prelude::*;

use crate::balls::{Positions, Radii};
use crate::spacing::picked;

/// Particles that are looked at.
const SAMPLES: usize = 10_001;

/// The point that becomes a scene's origin: the file's own, unless f32 moves a particle near the others'
/// middle by more than a 4,096th of its support radius; then that middle, in whole numbers of the
/// file's unit where that is near enough.
pub(crate) fn origin_of<P: Positions>(positions: &P, radii: &Radii<'_>) -> DVec3 {
    let is_moved = |index: usize| {
        let position = positions.at(index);
        let moved = (position - position.as_vec3().as_dvec3()).abs().max_element();
        moved * 4096.0 > f64::from(radii.get(index))
    };
    if !(0..positions.count()).into_par_iter().any(is_moved) {
        return DVec3::ZERO;
    }
    let middle = middle(positions);
    let whole = middle.round();
    let all = (0..positions.count()).map(|index| positions.at(index));
    let extent = all.map(|position| (position - middle).abs().max_element());
    let is_near = extent.fold(0.0, f64::max) > 16.0;
    if is_near { whole } else { middle }
}

/// The median of the positions along each axis: no outlier moves it.
pub(crate) fn middle<P: Positions>(positions: &P) -> DVec3 {
    let mut samples = picked(positions, SAMPLES);
    let half = samples.len() / 2;
    let mut median = |axis: usize| match samples.len() {
        0 => 0.0,
        _ => samples.select_nth_unstable_by(half, |a, b| a[axis].total_cmp(&b[axis])).1[axis],
    };
    DVec3::new(median(0), median(1), median(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_particles_that_f32_moves_get_an_origin() {
        let at = |shift: DVec3, radius: f32| {
            let positions = [0.0, 0.13, 20.0].map(|x| shift + DVec3::splat(x)).to_vec();
            origin_of(&positions, &Radii::All(radius))
        };
        assert_eq!(at(DVec3::ZERO, 0.1), DVec3::ZERO);
        assert_eq!(at(DVec3::splat(50.0), 1.0), DVec3::ZERO);
        let far = DVec3::new(510_000.3, 5_460_000.7, 100.0);
        assert_eq!(at(far, 1.0), (far + 0.13).round());
        assert_eq!(at(DVec3::ZERO, 1e-9), DVec3::ZERO, "{}", at(DVec3::ZERO, 1e-9));
        assert_eq!(origin_of(&Vec::new(), &Radii::All(1.0)), DVec3::ZERO);
    }
}
