//! Small scenes with a purpose, made by hand.

use glam::Vec3;
use metaball_core::{Camera, Color, Kernel, Metaball, Scene};

use crate::error::LoadError;
use crate::random::Random;

/// A scene and the camera that shows it.
pub(crate) type Shot = (Scene, Camera);

/// The threshold of small scenes that do not turn it.
pub(crate) const THRESHOLD: f32 = 0.25;

/// A camera that looks from `eye` at `target`, y up, with the field of view of 38°.
pub(crate) fn looking(eye: Vec3, target: Vec3) -> Result<Camera, LoadError> {
    Ok(Camera::look_at(eye, target, Vec3::Y, 38.0)?)
}

/// Balls under the quartic at the usual threshold.
pub(crate) fn quartic(balls: impl IntoIterator<Item = Metaball>) -> Result<Scene, LoadError> {
    Ok(Scene::new(balls, Kernel::QUARTIC, THRESHOLD)?)
}

/// One ball of radius 1 at the origin.
pub(crate) fn one(kernel: Kernel) -> Result<Shot, LoadError> {
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0)])?;
    Ok((scene.with_kernel(kernel), looking(Vec3::new(0.0, 0.0, 3.5), Vec3::ZERO)?))
}

/// One power ball; `exponent` from 1 to 8.
pub(crate) fn one_power(exponent: i64) -> Result<Shot, LoadError> {
    one(particle_files::kernel_named("power", Some(exponent))?)
}

pub(crate) fn two_merging() -> Result<Shot, LoadError> {
    let scene = quartic([-0.55, 0.55].map(|x| Metaball::new(Vec3::X * x, 1.0)))?;
    Ok((scene, looking(Vec3::new(1.2, 0.9, 4.0), Vec3::ZERO)?))
}

/// Two balls under any kernel, so near that even those that fall fastest have one surface.
pub(crate) fn two(kernel: Kernel) -> Result<Shot, LoadError> {
    let scene = quartic([-0.35, 0.35].map(|x| Metaball::new(Vec3::X * x, 1.0)))?;
    Ok((scene.with_kernel(kernel), looking(Vec3::new(1.2, 0.9, 3.0), Vec3::ZERO)?))
}

pub(crate) fn fifteen_coincident() -> Result<Shot, LoadError> {
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0); 15])?;
    Ok((scene, looking(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO)?))
}

/// Twelve balls around a point so far out that floats there are a thousandth of a radius apart.
pub(crate) fn far_from_origin() -> Result<Shot, LoadError> {
    let middle = Vec3::new(10_000.0, -8_000.0, 12_000.0);
    let mut random = Random::new(2);
    let scene = quartic((0..12).map(|_| Metaball::new(middle + random.in_ball().as_vec3(), 1.0)))?;
    Ok((scene, looking(middle + Vec3::new(1.0, 0.8, 5.0), middle)?))
}

/// A ball of radius 1 with forty of radius 0.001 scattered over the part of its surface that the camera shows from near.
pub(crate) fn radius_ratio_1000() -> Result<Shot, LoadError> {
    // The quartic takes the value ¼ at R/√2.
    let surface = std::f32::consts::FRAC_1_SQRT_2;
    let mut random = Random::new(3);
    let small = (0..40).map(|_| {
        let offset = 0.004 * random.in_ball().as_vec3();
        Metaball::new(Vec3::new(offset.x, offset.y, surface + 0.2 * offset.z), 0.001)
    });
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0)].into_iter().chain(small))?;
    let target = Vec3::Z * surface;
    Ok((scene, looking(target + Vec3::new(0.004, 0.008, 0.012), target)?))
}

/// A hundred balls of radius 1 in a cube of side 5, strengths from 0.3 to 3.
pub(crate) fn strengths() -> Result<Shot, LoadError> {
    let mut random = Random::new(4);
    let balls = (0..100).map(|_| Metaball {
        center: 2.5 * random.in_box(glam::DVec3::ONE).as_vec3(),
        radius: 1.0,
        strength: random.between(0.3, 3.0) as f32,
    });
    Ok((quartic(balls)?, looking(Vec3::new(4.0, 3.0, 9.0), Vec3::ZERO)?))
}

/// The same with a colour for each ball.
pub(crate) fn colors() -> Result<Shot, LoadError> {
    let (scene, camera) = strengths()?;
    let mut random = Random::new(5);
    let mut channel = || random.between(40.0, 255.0) as u8;
    let colors = (0..scene.len()).map(|_| Color::srgb(channel(), channel(), channel())).collect();
    Ok((scene.with_colors(colors)?, camera))
}

/// Four balls whose supports hold the eye: the field there is 4·(1 − 0.95²)² = 0.04, below T = 0.9.
pub(crate) fn eye_inside_support() -> Result<Shot, LoadError> {
    let directions = [(-1.3, -1.0), (-1.3, 1.0), (1.3, -1.0), (1.3, 1.0)];
    let balls =
        directions.map(|(x, y)| Metaball::new(0.95 * Vec3::new(x, y, -1.0).normalize(), 1.0));
    let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 100.0)?;
    Ok((quartic(balls)?.with_threshold(0.9)?, camera))
}

pub(crate) fn eye_inside_surface() -> Result<Shot, LoadError> {
    let scene = quartic([0.0, -0.6].map(|z| Metaball::new(Vec3::Z * z, 1.0)))?;
    Ok((scene, looking(Vec3::ZERO, Vec3::NEG_Z)?))
}

pub(crate) fn empty() -> Result<Shot, LoadError> {
    Ok((quartic([])?, looking(Vec3::Z, Vec3::ZERO)?))
}

/// Two coincident balls give at most 2.
pub(crate) fn threshold_too_high() -> Result<Shot, LoadError> {
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0); 2])?.with_threshold(2.5)?;
    Ok((scene, looking(Vec3::new(0.0, 0.0, 3.5), Vec3::ZERO)?))
}

/// Three overlapping balls so near that they fill pictures up to twice as wide as high. From 1.2 in
/// front of the origin the picture reaches 0.83 to the side at the origin's depth; the bar of balls
/// shows 0.7 high and 1.6 to either side.
pub(crate) fn filling() -> Result<Shot, LoadError> {
    let balls = [-1.0, 0.0, 1.0].map(|x| Metaball::new(Vec3::X * x, 1.2));
    Ok((quartic(balls)?, looking(Vec3::new(0.1, 0.05, 1.6), Vec3::ZERO)?))
}
