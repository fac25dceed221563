//! A plane that cuts the solid.

use std::ops::RangeInclusive;

use eframe::egui::{Slider, Ui};
use glam::{DVec3, Vec3};
use metaball::{Clip, Model};

use super::number;
use crate::{Look, Viewer};

/// Outward normals to choose from.
const NORMALS: [(Vec3, &str); 6] = [
    (Vec3::X, "+x"),
    (Vec3::NEG_X, "-x"),
    (Vec3::Y, "+y"),
    (Vec3::NEG_Y, "-y"),
    (Vec3::Z, "+z"),
    (Vec3::NEG_Z, "-z"),
];

pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer) {
    let (Some(model), Some(pose)) = (viewer.model(), viewer.pose()) else { return };
    let planes: Vec<_> = viewer.look().clip.planes().collect();
    let old = planes.last().copied();
    let mut new = old;
    ui.weak("Away with what lies beyond a plane:");
    ui.horizontal_wrapped(|ui| {
        if ui.selectable_label(old.is_none(), "nothing").clicked() {
            new = None;
        }
        let toward_eye = (-pose.axes()[2].as_vec3(), "toward the eye");
        for (normal, name) in NORMALS.into_iter().chain([toward_eye]) {
            let is_chosen = old.is_some_and(|(old, _)| old == normal);
            if ui.selectable_label(is_chosen, name).clicked() {
                let range = reach(model, normal);
                new = Some((normal, 0.5 * (range.start() + range.end())));
            }
        }
    });
    if let Some((normal, offset)) = &mut new {
        let range = reach(model, *normal);
        let slider = Slider::new(offset, range).text("Where").custom_formatter(|at, _| number(at));
        ui.add(slider);
    }
    if new != old {
        let others = &planes[..planes.len().saturating_sub(1)];
        if let Some(clip) = others
            .iter()
            .chain(&new)
            .try_fold(Clip::default(), |clip, plane| clip.and_plane(plane.0, plane.1).ok())
        {
            viewer.set_look(Look { clip, ..viewer.look().clone() });
        }
    }
}

/// From where to where planes of this normal meet the scene, in the coordinates of its file.
fn reach(model: &Model, normal: Vec3) -> RangeInclusive<f64> {
    let bounds = model.bounds();
    let (normal, half) = (normal.as_dvec3(), 0.5 * bounds.extent().as_dvec3());
    let middle = (bounds.center().as_dvec3() + model.scene().origin()).dot(normal);
    let reach = half.dot(normal.abs() * DVec3::ONE).max(f64::MIN_POSITIVE);
    middle - reach..=middle + reach
}
