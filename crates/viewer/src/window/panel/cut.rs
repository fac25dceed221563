//! A plane that cuts the solid.

use eframe::egui::{Slider, Ui};

use super::number;
use crate::Viewer;
use crate::cut::{NORMALS, cut, last_plane, reach};

pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer) {
    let (Some(model), Some(pose)) = (viewer.model(), viewer.pose()) else { return };
    let old = last_plane(viewer.look());
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
        cut(viewer, new);
    }
}
