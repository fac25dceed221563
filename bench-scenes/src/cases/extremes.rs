//! Distances, sizes, strengths and thresholds out of the common.
//!
//! No camera stands on the plane between two equal balls, where points of rays coincide: that is
//! another case.

use glam::Vec3;
use metaball_core::{Camera, Metaball};

use super::shapes::pair;
use crate::error::LoadError;
use crate::random::Random;
use crate::small::{Shot, looking, quartic};

pub(super) fn distance(value: f64) -> Result<Shot, LoadError> {
    let fov = 2.0 * (1.6 / value).atan().to_degrees();
    let eye = value as f32 * Vec3::new(0.28, 0.0, 0.96);
    Ok((pair(0.5)?, Camera::look_at(eye, Vec3::ZERO, Vec3::Y, fov as f32)?))
}

pub(super) fn offset(value: f64) -> Result<Shot, LoadError> {
    let offset = Vec3::splat(value as f32);
    let balls = [-0.5, 0.5].map(|x| Metaball::new(offset + Vec3::X * x, 1.0));
    Ok((quartic(balls)?, looking(offset + Vec3::new(1.5, 1.0, 5.0), offset)?))
}

pub(super) fn scale(value: f64) -> Result<Shot, LoadError> {
    let scale = value as f32;
    let balls = [-0.5, 0.5].map(|x| Metaball::new(Vec3::X * (x * scale), scale));
    Ok((quartic(balls)?, looking(scale * Vec3::new(1.5, 1.0, 5.0), Vec3::ZERO)?))
}

pub(super) fn radius_ratio(value: f64) -> Result<Shot, LoadError> {
    let small = value.recip() as f32;
    let surface = std::f32::consts::FRAC_1_SQRT_2;
    let top = Vec3::Z * (surface + 0.5 * small);
    let balls = [Metaball::new(Vec3::ZERO, 1.0), Metaball::new(top, small)];
    let eye = top + small * Vec3::new(1.0, 1.5, 4.0);
    Ok((quartic(balls)?, looking(eye, top)?))
}

pub(super) fn background(value: f64) -> Result<Shot, LoadError> {
    let large = Metaball { center: Vec3::ZERO, radius: value as f32, strength: 0.2 };
    let mut random = Random::new(6);
    let balls = (0..20).map(|_| Metaball::new(2.0 * random.in_ball().as_vec3(), 1.0));
    let scene = quartic([large].into_iter().chain(balls))?;
    Ok((scene, looking(Vec3::new(0.0, 2.0, 8.0), Vec3::ZERO)?))
}

pub(super) fn strength(value: f64) -> Result<Shot, LoadError> {
    let strong = Metaball { center: Vec3::NEG_X * 0.8, radius: 1.0, strength: value as f32 };
    let scene = quartic([strong, Metaball::new(Vec3::X * 0.8, 1.0)])?;
    Ok((scene, looking(Vec3::new(1.5, 1.0, 6.0), Vec3::ZERO)?))
}

pub(super) fn exponent(value: f64) -> Result<Shot, LoadError> {
    let kernel = particle_files::kernel_named("power", Some(value.round() as i64))?;
    Ok((pair(0.4)?.with_kernel(kernel), looking(Vec3::new(1.2, 0.9, 4.0), Vec3::ZERO)?))
}

pub(super) fn threshold_near_zero(value: f64) -> Result<Shot, LoadError> {
    let scene = pair(0.8)?.with_threshold(value as f32)?;
    Ok((scene, looking(Vec3::new(1.5, 1.0, 6.0), Vec3::ZERO)?))
}

pub(super) fn threshold_near_maximum(value: f64) -> Result<Shot, LoadError> {
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0)])?;
    let scene = scene.with_threshold((1.0 - value) as f32)?;
    // The quartic is 1 − 2r²: the speck fills half the picture's height while it is there.
    let speck = (0.5 * value.max(1e-6)).sqrt();
    let fov = 2.0 * (2.0 * speck / 3.0).atan().to_degrees();
    let eye = Vec3::new(0.0, 0.0, 3.0);
    Ok((scene, Camera::look_at(eye, Vec3::ZERO, Vec3::Y, fov as f32)?))
}
