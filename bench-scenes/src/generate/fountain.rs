//! A fountain: a tall jet in the middle, eight around it, drops that fly on and spread, and the rings
//! they make in a basin of radius 1.

use glam::{DVec2, DVec3};

use crate::density::UnscaledBall;
use crate::exact::turn;
use crate::random::Random;

/// Jets around the middle.
const JETS: f64 = 8.0;

/// Gravity, scene units per unit of time squared.
const GRAVITY: f64 = 2.0;

/// The balls after so many units of time: a drop that falls into the basin leaves its nozzle again.
pub(super) fn fountain(count: usize, random: &mut Random, time: f64) -> Vec<UnscaledBall> {
    (0..count)
        .map(|_| {
            let center = match random.unit() {
                part if part < 0.35 => jet(DVec2::ZERO, DVec2::ZERO, 2.2, random, time),
                part if part < 0.75 => {
                    let direction = turn((JETS * random.unit()).floor() / JETS);
                    jet(0.1 * direction, 0.4 * direction, 1.7, random, time)
                }
                _ => basin(random, time),
            };
            UnscaledBall { center, size: random.between(0.6, 1.4) }
        })
        .collect()
}

/// A drop that left `from` with these speeds, so long after it was somewhere on its way down to the
/// water.
fn jet(from: DVec2, outwards: DVec2, upwards: f64, random: &mut Random, later: f64) -> DVec3 {
    // Speeds scatter by a few hundredths: the jet spreads as it flies.
    let scatter = 0.09 * random.in_ball();
    let upwards = upwards * (1.0 + scatter.z);
    let flight = 2.0 * upwards / GRAVITY;
    let time = flight * random.unit() + later;
    let time = time - flight * (time / flight).floor();
    let across = from + (outwards + DVec2::new(scatter.x, scatter.y)) * time;
    DVec3::new(across.x, upwards * time - 0.5 * GRAVITY * time * time, across.y)
}

/// In the basin's water, where rings go outwards from the drops.
fn basin(random: &mut Random, time: f64) -> DVec3 {
    let across = loop {
        let point = random.in_box(DVec3::ONE).truncate();
        if point.length_squared() <= 1.0 {
            break point;
        }
    };
    let wave = 0.02 * turn(4.0 * across.length() - 1.5 * time).x;
    DVec3::new(across.x, wave - 0.05 * random.unit(), across.y)
}
