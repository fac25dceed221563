//! Many balls over one point.

use glam::Vec3;
use metaball_core::{Camera, Metaball};

use super::number;
use crate::error::LoadError;
use crate::random::Random;
use crate::small::{Shot, looking, quartic};

pub(super) fn few(value: f64) -> Result<Shot, LoadError> {
    let balls = (0..number(value)).map(|index| Metaball::new(Vec3::X * index as f32, 1.0));
    Ok((quartic(balls)?, looking(Vec3::new(1.0, 0.0, 6.0), Vec3::X)?))
}

pub(super) fn coincident(value: f64) -> Result<Shot, LoadError> {
    let balls = vec![Metaball::new(Vec3::ZERO, 1.0); number(value)];
    Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO)?))
}

pub(super) fn crowd(value: f64) -> Result<Shot, LoadError> {
    let mut random = Random::new(1);
    let balls = (0..number(value))
        .map(|_| Metaball::new(0.1 * random.in_ball().as_vec3(), 1.0))
        .collect::<Vec<_>>();
    Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO)?))
}

pub(super) fn concentric(value: f64) -> Result<Shot, LoadError> {
    let balls = radii(value).map(|radius| Metaball::new(Vec3::ZERO, radius));
    Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 7.0), Vec3::ZERO)?))
}

pub(super) fn common_entry(value: f64) -> Result<Shot, LoadError> {
    let balls = radii(value).map(|radius| Metaball::new(Vec3::NEG_Z * radius, radius));
    Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 6.0), Vec3::NEG_Z)?))
}

pub(super) fn veiled(value: f64) -> Result<Shot, LoadError> {
    // Supports overlap in pairs: the field before the last ball stays at 0.14 or below.
    let last = number(value) as f32;
    let veil = (0..number(value)).map(|index| Metaball {
        center: Vec3::new(0.0, 0.0, last - index as f32 + 0.5),
        radius: 0.7,
        strength: 0.1,
    });
    let balls = veil.chain([Metaball::new(Vec3::NEG_Z, 1.0)]);
    // A lens that keeps the last ball's size.
    let (eye, distance) = (Vec3::Z * (last + 3.0), last + 4.0);
    let fov = 2.0 * (1.4 / distance).atan().to_degrees();
    Ok((quartic(balls)?, Camera::look_at(eye, Vec3::NEG_Z, Vec3::Y, fov)?))
}

/// So many radii at equal steps from 1 to 2.
fn radii(value: f64) -> impl Iterator<Item = f32> {
    let last = (number(value).max(2) - 1) as f32;
    (0..number(value)).map(move |index| 1.0 + index as f32 / last)
}
