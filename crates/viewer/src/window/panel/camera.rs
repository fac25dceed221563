//! Where it is seen from, in numbers.

use eframe::egui::{DragValue, Grid, Ui};
use glam::DVec3;

use crate::{Pose, Viewer};

const SIDES: [(DVec3, &str); 6] = [
    (DVec3::X, "+x"),
    (DVec3::NEG_X, "-x"),
    (DVec3::Y, "+y"),
    (DVec3::NEG_Y, "-y"),
    (DVec3::Z, "+z"),
    (DVec3::NEG_Z, "-z"),
];

pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer) {
    let Some(old) = viewer.pose() else { return };
    let mut new = old;
    ui.horizontal_wrapped(|ui| {
        if ui.button("Home").on_hover_text("H").clicked() {
            viewer.go_home();
        }
        for (side, name) in SIDES {
            if ui.button(name).on_hover_text("seen from there").clicked() {
                new = old.seen_from(side);
            }
        }
    });
    numbers(ui, &mut new);
    if new != old {
        viewer.set_pose(new);
    }
    let flags = crate::CommandLine::default().viewpoint(&viewer.viewpoint()).to_string();
    ui.add_enabled_ui(!flags.is_empty(), |ui| {
        if ui.button("Copy as flags").clicked() {
            ui.ctx().copy_text(flags);
        }
    });
}

fn numbers(ui: &mut Ui, pose: &mut Pose) {
    let speed = 0.005 * pose.distance();
    Grid::new("pose").num_columns(4).show(ui, |ui| {
        for (name, point) in [("Eye", &mut pose.eye), ("Looks at", &mut pose.look_at)] {
            ui.weak(name);
            for coordinate in [&mut point.x, &mut point.y, &mut point.z] {
                ui.add(DragValue::new(coordinate).speed(speed).max_decimals(4));
            }
            ui.end_row();
        }
        ui.weak("Up");
        for coordinate in [&mut pose.up.x, &mut pose.up.y, &mut pose.up.z] {
            ui.add(DragValue::new(coordinate).speed(0.005).max_decimals(4));
        }
        ui.end_row();
        ui.weak("View");
        ui.add(DragValue::new(&mut pose.fov).range(1.0..=160.0).speed(0.2).suffix("°"));
        ui.end_row();
    });
}
