//! The line below the picture: frames, and how far the picture is.

use std::time::Instant;

use eframe::egui::{self, Align, Button, Key, Layout, Slider};
use fbvh::Kind;

use crate::{Painting, Stage, Viewer};

pub(super) fn show(ui: &mut egui::Ui, viewer: &mut Viewer) {
    if viewer.timeline().is_moving() {
        timeline(ui, viewer);
    }
    ui.horizontal(|ui| {
        let Some(painting) = viewer.painting() else {
            ui.weak("No picture yet");
            return;
        };
        ui.label(stage(painting, viewer));
        ui.weak(match painting.time.as_secs_f64() {
            seconds if seconds < 2.0 => format!("{:.0} ms", 1e3 * seconds),
            seconds => format!("{seconds:.1} s"),
        });
        if let (Stage::Coarse, Some(rate)) = (painting.stage, viewer.rate()) {
            ui.weak(format!("{rate:.0} frames a second"));
        }
        let undecided = painting.undecided;
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if undecided > 0 {
                ui.colored_label(
                    ui.visuals().warn_fg_color,
                    format!("{undecided} pixels undecided, marked"),
                );
            } else if viewer.kind() == Kind::Certified {
                ui.weak("every pixel certain");
            }
        });
    });
}

/// How far the picture is, in words.
fn stage(painting: &Painting, viewer: &Viewer) -> String {
    let (width, height) = (painting.view.width(), painting.view.height());
    let size = format!("{width} × {height}");
    match painting.stage {
        Stage::Coarse => format!("Moving, {size}"),
        Stage::Sharp => size,
        Stage::Lit(done) => {
            let samples = viewer.look().light.samples.unwrap_or(done);
            format!("{size}, light {done} of {samples}")
        }
    }
}

/// The frames: one before, play, one on, and any of them.
fn timeline(ui: &mut egui::Ui, viewer: &mut Viewer) {
    let now = Instant::now();
    let old = viewer.timeline().clone();
    let mut new = old.clone();
    ui.horizontal(|ui| {
        if ui.button("First").on_hover_text("First frame").clicked() {
            new = new.at(0, now);
        }
        if ui.button("Back").on_hover_text("Frame before (,)").clicked() {
            new = new.stepped(-1, now);
        }
        let words = if old.is_playing() { "Stop" } else { "Play" };
        let play = Button::new(words).shortcut_text(
            ui.ctx()
                .format_shortcut(&egui::KeyboardShortcut::new(egui::Modifiers::NONE, Key::Space)),
        );
        if ui.add(play).on_hover_text("Play or stop").clicked() {
            new = new.playing(!old.is_playing(), now);
        }
        if ui.button("Next").on_hover_text("Next frame (.)").clicked() {
            new = new.stepped(1, now);
        }
        let frames = old.frames();
        let mut frame = new.frame();
        ui.spacing_mut().slider_width = (ui.available_width() - 110.0).max(60.0);
        let slider = Slider::new(&mut frame, frames.start..=frames.end - 1).text("Frame");
        if ui.add(slider).changed() {
            new = new.at(frame, now);
        }
    });
    if new != old {
        viewer.set_timeline(new);
    }
}
