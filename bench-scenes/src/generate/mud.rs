//! Mud that has come down a slope and spreads at its foot: a tongue with folds across its flow, and
//! clods that it threw ahead. As the pool, on a jittered lattice.

use glam::DVec3;

use super::lattice::Under;
use crate::density::UnscaledBall;
use crate::exact::turn;
use crate::random::Random;

/// Half the extent over which mud can lie, x (down the slope) and z, scene units.
const HALF: (f64, f64) = (1.0, 0.7);

/// Depth of the mud where it lies deepest, but for the folds.
const DEPTH: f64 = 0.22;

pub(super) fn mud(count: usize, random: &mut Random) -> Vec<UnscaledBall> {
    let clods = count / 50;
    let flow = Under { half: HALF, depth: DEPTH, surface: depth }.fill(count - clods, random);
    let clods = (0..clods).map(|_| thrown(random)).collect::<Vec<_>>();
    let lain = flow.into_iter().chain(clods);
    lain.map(|site| UnscaledBall { center: site + DVec3::Y * ground(site.x), size: 1.0 }).collect()
}

/// Height of the ground: a slope that ends in a plain.
fn ground(x: f64) -> f64 {
    let uphill = (0.2 - x).max(0.0);
    0.35 * uphill * uphill
}

/// Depth of the mud.
fn depth(x: f64, z: f64) -> f64 {
    // From 0 at the upper end to 1 at the foot: the tongue widens.
    let down = 0.5 * (x + 1.0);
    let half_width = 0.22 + 0.4 * down * down;
    let across = z / half_width;
    let front = 1.0 - down * down * down * down;
    let folds = 0.16 * turn(4.0 * (x - 0.35 * across * across)).x * down;
    let veins = 0.05 * turn(2.5 * across + 0.6 * x).y;
    DEPTH * (1.0 - across * across) * front * (1.0 + folds + veins)
}

/// A clod's particle, before the front: height over the ground.
fn thrown(random: &mut Random) -> DVec3 {
    // Eleven clods, at even steps across.
    let clod = (11.0 * random.unit()).floor();
    let (x, z) = (0.86 + 0.06 * turn(0.37 * clod).x, 0.11 * (clod - 5.0));
    DVec3::new(x, 0.05 + 0.03 * turn(0.23 * clod).y, z) + 0.035 * random.in_ball()
}
