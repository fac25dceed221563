//! What is said over the picture: what is being done, and what went wrong.

use std::time::{Duration, Instant};

use eframe::egui::{self, Align2, Area, Frame, RichText, Vec2};

use crate::{Progress, Viewer};

/// What takes less time is not announced.
const PATIENCE: Duration = Duration::from_millis(250);

pub(super) fn show(ui: &mut egui::Ui, viewer: &mut Viewer) {
    failure(ui, viewer);
    match viewer.progress() {
        Progress::Ready => {}
        Progress::Reading(since) => working(ui, viewer, "Reading…", since),
        Progress::Building(since) => working(ui, viewer, "Building the tree…", since),
    }
}

fn working(ui: &mut egui::Ui, viewer: &mut Viewer, words: &str, since: Instant) {
    let passed = since.elapsed();
    let is_first = viewer.painting().is_none();
    if passed < PATIENCE || (viewer.timeline().is_playing() && !is_first) {
        ui.ctx().request_repaint_after(PATIENCE);
        return;
    }
    let place = if is_first { Align2::CENTER_CENTER } else { Align2::CENTER_TOP };
    card(ui, "working", place, |ui| {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label(format!("{words} {} s", passed.as_secs()));
            if ui.button("Cancel").on_hover_text("Escape").clicked() {
                viewer.cancel();
            }
        });
    });
}

fn failure(ui: &mut egui::Ui, viewer: &Viewer) {
    let Some(failure) = viewer.failure() else {
        if viewer.subject().is_none() && viewer.progress() == Progress::Ready {
            card(ui, "empty", Align2::CENTER_CENTER, |ui| {
                ui.label("Drop a file of particles here, or name one on the right.");
            });
        }
        return;
    };
    let is_first = viewer.painting().is_none();
    let place = if is_first { Align2::CENTER_CENTER } else { Align2::CENTER_BOTTOM };
    card(ui, "failure", place, |ui| {
        ui.label(RichText::new(failure).color(ui.visuals().error_fg_color));
    });
}

fn card(ui: &egui::Ui, name: &str, place: Align2, contents: impl FnOnce(&mut egui::Ui)) {
    const MARGIN: f32 = 16.0;
    let rect = ui.min_rect().shrink(MARGIN);
    let width = (0.8 * rect.width()).min(560.0);
    let at = place.pos_in_rect(&rect);
    Area::new(egui::Id::unique(name)).fixed_pos(at).pivot(place).show(ui.ctx(), |ui| {
        ui.set_max_width(width);
        Frame::popup(ui.style()).inner_margin(Vec2::new(14.0, 10.0)).show(ui, contents);
    });
}
