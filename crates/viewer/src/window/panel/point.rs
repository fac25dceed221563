//! What picked points are made of.

use eframe::egui::{Grid, ProgressBar, RichText, Ui};
use glam::DVec3;

use super::{number, row};
use crate::{Pick, Viewer};

/// Balls that are listed; how many there are is always said.
const LISTED: usize = 12;

pub(super) fn show(ui: &mut Ui, viewer: &Viewer, picks: &mut Vec<Pick>) {
    if picks.is_empty() {
        ui.weak(
            "Click on the surface: what makes a point of it is said here. A second point gives \
                 the distance, a double click looks at it.",
        );
        return;
    }
    for (index, pick) in picks.iter().enumerate() {
        if picks.len() > 1 {
            ui.strong(format!("Point {}", index + 1));
        }
        facts(ui, index, pick);
    }
    if let [first, second] = picks.as_slice() {
        let distance = first.point.distance(second.point);
        ui.label(RichText::new(format!("Distance {}", number(distance))).strong());
    }
    if let Some(pick) = picks.last() {
        shares(ui, viewer, pick);
    }
    if ui.button("Forget").clicked() {
        picks.clear();
    }
}

fn facts(ui: &mut Ui, index: usize, pick: &Pick) {
    Grid::new(("point", index)).num_columns(2).show(ui, |ui| {
        row(ui, "Position", triple(pick.point));
        row(ui, "Normal", triple(pick.normal().as_dvec3()));
        row(ui, "t", number(pick.hit.t.into()));
        row(ui, "Field", number(pick.field));
        if pick.is_inside() {
            row(ui, "Where", "the eye, within the solid");
        } else if pick.on_face {
            row(ui, "Where", "on the face of the cut");
        }
    });
}

fn shares(ui: &mut Ui, viewer: &Viewer, pick: &Pick) {
    let Some(model) = viewer.model() else { return };
    ui.label(format!("{} balls make it:", pick.shares.len()));
    Grid::new("shares").num_columns(3).show(ui, |ui| {
        for share in pick.shares.iter().take(LISTED) {
            let Some(support) = model.scene().supports().get(share.ball) else { continue };
            let center = support.center.as_dvec3() + model.scene().origin();
            let words = format!("centre {}\nR {}", triple(center), number(support.radius.into()));
            ui.label(format!("#{}", share.ball)).on_hover_text(words);
            ui.label(number(share.value));
            let bar = ProgressBar::new(share.share as f32).desired_width(ui.available_width());
            ui.add(bar.text(format!("{:.1} %", 100.0 * share.share)));
            ui.end_row();
        }
    });
    if let Some(others) = pick.shares.get(LISTED..).filter(|others| !others.is_empty()) {
        let rest: f64 = others.iter().map(|share| share.share).sum();
        ui.weak(format!("and {} others, {:.1} % together", others.len(), 100.0 * rest));
    }
}

fn triple(point: DVec3) -> String {
    point.to_array().map(number).join(", ")
}
