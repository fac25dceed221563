//! A tornado two units high: a hollow funnel of spiral bands that bends as it rises, and dust where it
//! meets the ground.

use glam::{DVec2, DVec3};

use crate::density::Placed;
use crate::exact::turn;
use crate::random::Random;

/// Spiral bands in the funnel's wall.
const BANDS: f64 = 4.0;

pub(super) fn tornado(count: usize, random: &mut Random) -> Vec<Placed> {
    (0..count)
        .map(|_| {
            let center = match random.unit() {
                part if part < 0.86 => funnel(random),
                part if part < 0.97 => dust(random),
                _ => debris(random),
            };
            Placed { center, size: 1.0 }
        })
        .collect()
}

/// Radius of the funnel at a height from 0 to 1.
fn radius(height: f64) -> f64 {
    0.07 + 0.12 * height + 0.55 * height * height * height
}

/// The funnel's middle at a height from 0 to 1: it leans and winds.
fn axis(height: f64) -> DVec2 {
    0.14 * height * turn(0.1 + 0.7 * height)
}

fn at(height: f64, across: DVec2) -> DVec3 {
    DVec3::new(across.x, 2.0 * height - 1.0, across.y)
}

/// In a band of the wall, as many to a height as its circumference holds.
fn funnel(random: &mut Random) -> DVec3 {
    let height = loop {
        let height = random.unit();
        if random.unit() * radius(1.0) < radius(height) {
            break height;
        }
    };
    let band = (BANDS * random.unit()).floor() / BANDS;
    // Wound tighter towards the ground, and thinned to one side of the band.
    let angle = band + 1.6 * height - 0.6 * height * height + 0.06 * random.triangular();
    let wall = radius(height) * (0.92 + 0.1 * random.triangular());
    at(height, axis(height) + wall * turn(angle))
}

/// In a flat ring on the ground.
fn dust(random: &mut Random) -> DVec3 {
    let outwards = random.unit();
    let across = (0.1 + 0.45 * outwards) * turn(random.unit());
    at(0.1 * random.unit() * (1.0 - outwards), across)
}

/// Thrown out of the funnel.
fn debris(random: &mut Random) -> DVec3 {
    let height = random.unit();
    let away = radius(height) * random.between(1.1, 1.5);
    at(height, axis(height) + away * turn(random.unit()))
}
