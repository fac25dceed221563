//! Balls at random in a cube of side 1 around the origin.

use glam::DVec3;

use crate::density::UnscaledBall;
use crate::random::Random;

/// Equal balls.
pub(super) fn scattered(count: usize, random: &mut Random) -> Vec<UnscaledBall> {
    cloud(count, random, |_| 1.0)
}

/// Radii from one to four, uniformly.
pub(super) fn random(count: usize, random: &mut Random) -> Vec<UnscaledBall> {
    cloud(count, random, |random| random.between(1.0, 4.0))
}

fn cloud(
    count: usize,
    random: &mut Random,
    mut size: impl FnMut(&mut Random) -> f64,
) -> Vec<UnscaledBall> {
    (0..count)
        .map(|_| UnscaledBall { center: random.in_box(DVec3::splat(0.5)), size: size(random) })
        .collect()
}
