//! A tank of fluid, 2 × 1.2 units wide: particles on a jittered lattice under waves, a crown where a
//! drop fell in, and what it threw up.

use glam::DVec3;

use crate::density::Placed;
use crate::exact::turn;
use crate::random::Random;

/// Half the extent of the tank, x and z, and the depth of the fluid at rest, scene units.
const HALF: (f64, f64) = (1.0, 0.6);
const DEPTH: f64 = 0.35;

/// Where the drop fell, x and z.
const FALL: (f64, f64) = (0.25, 0.1);

pub(super) fn pool(count: usize, random: &mut Random) -> Vec<Placed> {
    let splash = count / 25;
    let mut centers = fluid(count - splash, random);
    centers.extend((0..splash).map(|_| thrown(random)));
    centers.into_iter().map(|center| Placed { center, size: 1.0 }).collect()
}

/// Height of the surface.
fn surface(x: f64, z: f64) -> f64 {
    let swell = 0.045 * turn(0.8 * x + 0.3 * z).x + 0.03 * turn(1.1 * z - 0.5 * x + 0.2).y;
    // Rings around the fall, which die away.
    let away = ((x - FALL.0) * (x - FALL.0) + (z - FALL.1) * (z - FALL.1)).sqrt();
    let rings = 0.09 * turn(3.5 * away).x / (1.0 + 12.0 * away * away);
    DEPTH + swell - rings
}

/// `count` sites of a lattice under the surface, each moved by up to a third of the spacing: the
/// lattice is refined until it has enough, and the highest sites are left out.
fn fluid(count: usize, random: &mut Random) -> Vec<DVec3> {
    let mut layers = 1;
    loop {
        let sites = sites(layers);
        if sites.len() >= count {
            return thin(sites, count, DEPTH / f64::from(layers), random);
        }
        layers += 1;
    }
}

/// Lattice sites under the surface, with so many layers to the depth at rest.
fn sites(layers: u32) -> Vec<DVec3> {
    let spacing = DEPTH / f64::from(layers);
    let steps = |half: f64| (half / spacing) as i32;
    let mut sites = Vec::new();
    for column in -steps(HALF.0)..=steps(HALF.0) {
        for row in -steps(HALF.1)..=steps(HALF.1) {
            let (x, z) = (spacing * f64::from(column), spacing * f64::from(row));
            let height = surface(x, z);
            let layers = (height / spacing) as i32;
            sites.extend(
                (0..layers).map(|layer| DVec3::new(x, spacing * (f64::from(layer) + 0.5), z)),
            );
        }
    }
    sites
}

/// Keeps `count` of the sites, evenly over the tank, and moves them.
fn thin(sites: Vec<DVec3>, count: usize, spacing: f64, random: &mut Random) -> Vec<DVec3> {
    let all = sites.len();
    let kept = sites
        .into_iter()
        .enumerate()
        .filter(|(index, _)| (index + 1) * count / all > index * count / all)
        .map(|(_, site)| site);
    kept.map(|site| site + random.in_box(DVec3::splat(spacing / 3.0))).collect()
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
