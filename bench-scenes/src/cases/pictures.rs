//! Lenses, image sizes, and drawing again.

use glam::Vec3;
use metaball_core::{Camera, Metaball, Scene};

use super::number;
use crate::error::LoadError;
use crate::random::Random;
use crate::small::{Shot, looking, quartic};

/// A field of view before twenty balls.
pub(super) fn lens(degrees: f64) -> Result<Shot, LoadError> {
    let eye = Vec3::new(0.3, 0.2, 6.0);
    Ok((twenty()?, Camera::look_at(eye, Vec3::ZERO, Vec3::Y, degrees as f32)?))
}

/// A camera moved by part of a pixel of a picture 25 high, as measured at the balls.
pub(super) fn nudged(part: f64) -> Result<Shot, LoadError> {
    let (scene, camera) = lens(38.0)?;
    let pixel = 6.0 * 2.0 * camera.half_height() / 25.0;
    Ok((scene, camera.shifted(part as f32 * pixel, 0.0)))
}

/// A lens whose picture, if 128 times as wide as high, just holds twenty balls.
pub(super) fn strip(across: f64) -> Result<Shot, LoadError> {
    lens(38.0 / (across / 64.0).max(1.0))
}

/// Balls of radii from 0.3 to 1 in a ball of radius 2.
pub(super) fn cloud(count: f64) -> Result<Shot, LoadError> {
    let mut random = Random::new(9);
    let balls = (0..number(count)).map(|_| {
        let center = 2.0 * random.in_ball().as_vec3();
        Metaball::new(center, random.between(0.3, 1.0) as f32)
    });
    Ok((quartic(balls.collect::<Vec<_>>())?, looking(Vec3::new(0.3, 0.2, 8.0), Vec3::ZERO)?))
}

fn twenty() -> Result<Scene, LoadError> {
    let mut random = Random::new(7);
    quartic((0..20).map(|_| Metaball::new(2.0 * random.in_ball().as_vec3(), 1.0)))
}
