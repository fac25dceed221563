//! What is thin, near, or only just touched. Cameras stand beside planes of symmetry, where points of
//! rays would coincide.

use glam::{DVec3, Vec3};
use metaball_core::{Camera, Kernel, Metaball, Scene};

use crate::error::LoadError;
use crate::small::{Shot, THRESHOLD, looking, quartic};

/// Two balls so far to either side of the origin along x.
pub(super) fn pair(half_distance: f64) -> Result<Scene, LoadError> {
    let center = Vec3::X * half_distance as f32;
    quartic([-center, center].map(|center| Metaball::new(center, 1.0)))
}

/// One ball, whose silhouette stands upright in the middle of a picture `2 value` high.
pub(super) fn grazing(value: f64) -> Result<Shot, LoadError> {
    const DISTANCE: f64 = 3.0;
    let core = Kernel::QUARTIC.ratio_at(f64::from(THRESHOLD)).unwrap_or(1.0);
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0)])?;
    let silhouette = Vec3::X * core as f32;
    let eye = silhouette + Vec3::Z * DISTANCE as f32;
    let fov = 2.0 * (value / DISTANCE).atan().to_degrees();
    Ok((scene, Camera::look_at(eye, silhouette, Vec3::Y, fov as f32)?))
}

pub(super) fn neck(value: f64) -> Result<Shot, LoadError> {
    // Each ball gives half of the field in the middle.
    let each = 0.5 * f64::from(THRESHOLD) * (1.0 + value);
    let ratio = Kernel::QUARTIC.ratio_at(each).unwrap_or(1.0);
    Ok((pair(ratio)?, looking(Vec3::new(0.3, 0.2, 2.0), Vec3::ZERO)?))
}

pub(super) fn sheet(value: f64) -> Result<Shot, LoadError> {
    // So wide that the field is least in the middle of four balls.
    const SPACING: f64 = 1.2;
    const HALF: i32 = 2;
    let sites = (-HALF..=HALF).flat_map(|row| {
        (-HALF..=HALF)
            .map(move |column| SPACING * DVec3::new(f64::from(column), f64::from(row), 0.0))
    });
    let middle = SPACING * DVec3::new(0.5, 0.5, 0.0);
    let field: f64 =
        sites.clone().map(|site| Kernel::QUARTIC.value(site.distance_squared(middle))).sum();
    let scene = quartic(sites.map(|site| Metaball::new(site.as_vec3(), 1.0)))?
        .with_threshold((field / (1.0 + value)) as f32)?;
    Ok((scene, looking(Vec3::new(1.5, 3.0, 9.0), Vec3::ZERO)?))
}

pub(super) fn touching(value: f64) -> Result<Shot, LoadError> {
    Ok((pair(1.0 + 0.5 * value)?, looking(Vec3::new(0.3, 0.2, 6.0), Vec3::ZERO)?))
}

pub(super) fn two_levels(value: f64) -> Result<Shot, LoadError> {
    let scene = pair(0.5)?.with_kernel(Kernel::Wyvill).with_threshold(value as f32)?;
    Ok((scene, looking(Vec3::new(0.7, 0.6, 5.0), Vec3::ZERO)?))
}

pub(super) fn effective_radii(value: f64) -> Result<Shot, LoadError> {
    let sites = (0..75).map(|site| {
        Vec3::new((site % 5 - 2) as f32, (site / 25 - 1) as f32, (site / 5 % 5 - 2) as f32)
    });
    let scene = quartic(sites.map(|site| Metaball::new(site, value as f32)))?;
    Ok((scene.with_kernel(Kernel::Wyvill), looking(Vec3::new(6.0, 7.0, 12.0), Vec3::ZERO)?))
}
