//! Planes that cut the solid.

use std::ops::RangeInclusive;

use glam::{DVec3, Vec3};
use metaball::{Clip, Model};

use crate::{Look, Viewer};

/// The plane that was cut last, with its outward normal and offset, in the coordinates of the scene's file.
pub type Plane = (Vec3, f64);

/// Outward normals to choose from.
pub const NORMALS: [(Vec3, &str); 6] = [
    (Vec3::X, "+x"),
    (Vec3::NEG_X, "-x"),
    (Vec3::Y, "+y"),
    (Vec3::NEG_Y, "-y"),
    (Vec3::Z, "+z"),
    (Vec3::NEG_Z, "-z"),
];

/// The last plane of a look.
pub fn last_plane(look: &Look) -> Option<Plane> {
    look.clip.planes().last()
}

/// Cuts by this plane in the place of the last, or by none.
pub fn cut(viewer: &mut Viewer, plane: Option<Plane>) {
    let planes: Vec<_> = viewer.look().clip.planes().collect();
    let others = &planes[..planes.len().saturating_sub(1)];
    let with = |clip: Clip, plane: &Plane| clip.and_plane(plane.0, plane.1).ok();
    if let Some(clip) = others.iter().chain(&plane).try_fold(Clip::default(), with) {
        viewer.set_look(Look { clip, ..viewer.look().clone() });
    }
}

/// From where to where planes of this normal meet the scene, in the coordinates of its file.
pub fn reach(model: &Model, normal: Vec3) -> RangeInclusive<f64> {
    let bounds = model.bounds();
    let (normal, half) = (normal.as_dvec3(), 0.5 * bounds.extent().as_dvec3());
    let middle = (bounds.center().as_dvec3() + model.scene().origin()).dot(normal);
    let reach = half.dot(normal.abs() * DVec3::ONE).max(f64::MIN_POSITIVE);
    middle - reach..=middle + reach
}
