//! A tornado two units high: a hollow funnel of spiral bands that bends as it rises, and dust where it
//! meets the ground.

use glam::{DVec2, DVec3};

use crate::density::UnscaledBall;
use crate::exact::turn;
use crate::random::Random;

/// Spiral bands in the funnel's wall.
const BANDS: f64 = 4.0;

/// Turns a second: of the bands, of the dust at its inner rim, and of the funnel's lean.
const SPIN: (f64, f64, f64) = (0.3, 0.4, 0.08);

/// Share of the funnel's wall that passes a height in a second, upwards.
const RISE: f64 = 0.06;

/// The balls after so many seconds. What leaves the funnel at the top is as much as enters it at the
/// ground, and the bands keep their shape.
pub(super) fn tornado(count: usize, random: &mut Random, time: f64) -> Vec<UnscaledBall> {
    (0..count)
        .map(|_| {
            let center = match random.unit() {
                part if part < 0.86 => funnel(random, time),
                part if part < 0.97 => dust(random, time),
                _ => debris(random, time),
            };
            UnscaledBall { center, size: 1.0 }
        })
        .collect()
}

/// Radius of the funnel at a height from 0 to 1.
fn radius(height: f64) -> f64 {
    0.07 + 0.12 * height + 0.55 * height * height * height
}

/// The share of the wall below a height: the integral of the radius.
fn below(height: f64) -> f64 {
    let integral = |height: f64| height * (0.07 + height * (0.06 + 0.1375 * height * height));
    integral(height) / integral(1.0)
}

/// The height with that share of the wall below it, by halving.
fn height_above(share: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if below(middle) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Where what was at a height is so many seconds later; it enters again at the ground.
fn risen(height: f64, time: f64) -> f64 {
    let share = below(height) + RISE * time;
    // At the start this is the height itself, to the bit.
    height + (height_above(share - share.floor()) - height_above(below(height)))
}

/// The funnel's middle at a height from 0 to 1: it leans and winds.
fn axis(height: f64, time: f64) -> DVec2 {
    0.14 * height * turn(0.1 + 0.7 * height + SPIN.2 * time)
}

fn at(height: f64, across: DVec2) -> DVec3 {
    DVec3::new(across.x, 2.0 * height - 1.0, across.y)
}

/// In a band of the wall, as many to a height as its circumference holds.
fn funnel(random: &mut Random, time: f64) -> DVec3 {
    let height = loop {
        let height = random.unit();
        if random.unit() * radius(1.0) < radius(height) {
            break height;
        }
    };
    let band = (BANDS * random.unit()).floor() / BANDS;
    // Wound tighter towards the ground, and thinned to one side of the band.
    let thinned = 0.06 * random.triangular();
    let layer = 0.92 + 0.1 * random.triangular();
    let height = risen(height, time);
    let angle = band + 1.6 * height - 0.6 * height * height + thinned + SPIN.0 * time;
    at(height, axis(height, time) + radius(height) * layer * turn(angle))
}

/// In a flat ring on the ground, faster further in.
fn dust(random: &mut Random, time: f64) -> DVec3 {
    let outwards = random.unit();
    let angle = random.unit() + SPIN.1 * time / (1.0 + 4.5 * outwards);
    let across = (0.1 + 0.45 * outwards) * turn(angle);
    at(0.1 * random.unit() * (1.0 - outwards), across)
}

/// Thrown out of the funnel, and carried around it.
fn debris(random: &mut Random, time: f64) -> DVec3 {
    let height = random.unit();
    let away = radius(height) * random.between(1.1, 1.5);
    at(height, axis(height, time) + away * turn(random.unit() + SPIN.0 * time))
}
