//! A tank of fluid, 2 × 1.2 units wide: particles on a jittered lattice under waves, a crown where a
//! drop fell in, and what it threw up.

use glam::DVec3;

use super::lattice::Under;
use crate::density::UnscaledBall;
use crate::exact::turn;
use crate::random::Random;

/// Half the extent of the tank, x and z, and the depth of the fluid at rest, scene units.
const HALF: (f64, f64) = (1.0, 0.6);
const DEPTH: f64 = 0.35;

/// Where the drop fell, x and z.
const FALL: (f64, f64) = (0.25, 0.1);

pub(super) fn pool(count: usize, random: &mut Random) -> Vec<UnscaledBall> {
    let splash = count / 25;
    let mut centers = Under { half: HALF, depth: DEPTH, surface }.fill(count - splash, random);
    centers.extend((0..splash).map(|_| thrown(random)));
    centers.into_iter().map(|center| UnscaledBall { center, size: 1.0 }).collect()
}

/// Height of the surface.
fn surface(x: f64, z: f64) -> f64 {
    let swell = 0.045 * turn(0.8 * x + 0.3 * z).x + 0.03 * turn(1.1 * z - 0.5 * x + 0.2).y;
    // Rings around the fall, which die away.
    let away = ((x - FALL.0) * (x - FALL.0) + (z - FALL.1) * (z - FALL.1)).sqrt();
    let rings = 0.09 * turn(3.5 * away).x / (1.0 + 12.0 * away * away);
    DEPTH + swell - rings
}

/// In the crown around the fall, or a drop above it.
fn thrown(random: &mut Random) -> DVec3 {
    let part = random.unit();
    let (away, height) = if part < 0.6 {
        let rise = random.unit();
        (0.16 + 0.08 * rise * rise, 0.3 * rise)
    } else if part < 0.8 {
        (0.05 * random.unit(), 0.45 * random.unit())
    } else {
        (random.between(0.1, 0.4), random.between(0.1, 0.6))
    };
    let direction = turn(random.unit());
    let across = away * direction + 0.012 * random.in_ball().truncate();
    let (x, z) = (FALL.0 + across.x, FALL.1 + across.y);
    DVec3::new(x, surface(x, z) + height, z)
}
