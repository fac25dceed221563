//! Where the eye is.

use glam::Vec3;
use metaball_core::{Camera, Metaball};

use crate::error::LoadError;
use crate::small::{Shot, looking, quartic};

pub(super) fn at_support(value: f64) -> Result<Shot, LoadError> {
    eye_at(1.0 + value)
}

pub(super) fn at_surface(value: f64) -> Result<Shot, LoadError> {
    eye_at(std::f64::consts::FRAC_1_SQRT_2 + value)
}

pub(super) fn behind(value: f64) -> Result<Shot, LoadError> {
    let behind = Metaball { center: Vec3::Z * value as f32, radius: 1.0, strength: 0.2 };
    let balls = [behind, Metaball::new(Vec3::NEG_Z * 1.5, 1.0)];
    Ok((quartic(balls)?, looking(Vec3::ZERO, Vec3::NEG_Z)?))
}

/// One ball seen along −z from so far off its centre.
fn eye_at(distance: f64) -> Result<Shot, LoadError> {
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0)])?;
    let eye = Vec3::Z * distance as f32;
    Ok((scene, Camera::look_at(eye, eye - Vec3::Z, Vec3::Y, 90.0)?))
}
