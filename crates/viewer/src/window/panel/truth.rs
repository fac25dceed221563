//! How wrong the picture is: other trees, and the reference.

use eframe::egui::{Button, ComboBox, Grid, ProgressBar, Ui};
use fbvh::Kind;
use harness::heat;

use super::{row, swatch};
use crate::{Judge, Verdicts, Viewer};

const KINDS: [Kind; 3] = [Kind::Certified, Kind::Fitted, Kind::ModifiedBvh];

pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer, judge: &mut Judge) {
    let mut kind = viewer.kind();
    ComboBox::from_label("Method").selected_text(kind.name()).show_ui(ui, |ui| {
        for other in KINDS {
            ui.selectable_value(&mut kind, other, other.name()).on_hover_text(other.source());
        }
    });
    viewer.set_kind(kind);
    ui.horizontal(|ui| {
        let button = Button::new("Hold against the reference");
        let asks = ui.add_enabled(Judge::is_able(viewer), button);
        if asks.on_disabled_hover_text("Needs a sharp picture without a cut").clicked() {
            judge.judge(viewer);
        }
        let is_there = judge.verdicts().is_some();
        if ui.add_enabled(is_there, Button::new("Hide")).clicked() {
            judge.forget();
        }
    });
    if let Some(verdicts) = judge.verdicts() {
        report(ui, verdicts);
    }
}

fn report(ui: &mut Ui, verdicts: &Verdicts) {
    let progress = verdicts.progress();
    if progress < 1.0 {
        ui.add(ProgressBar::new(progress).show_percentage());
    }
    Grid::new("verdicts").num_columns(2).show(ui, |ui| {
        for (name, count, color) in [
            ("Wrong", verdicts.wrong(), Some(heat::WRONG)),
            ("   missed", verdicts.missed, None),
            ("   invented", verdicts.invented, None),
            ("   on a wrong front", verdicts.wrong_front, None),
            ("Undecided", verdicts.undecided, Some(heat::UNDECIDED)),
            ("Too close to call", verdicts.ambiguous, Some(heat::AMBIGUOUS)),
        ] {
            ui.horizontal(|ui| {
                if let Some(color) = color {
                    swatch(ui, color);
                }
                ui.weak(name);
            });
            ui.label(count.to_string());
            ui.end_row();
        }
        row(ui, "Largest error", format!("{:.1e} support radii", verdicts.largest_error));
        row(ui, "Rays", verdicts.judgements.len().to_string());
    });
    let (low, high) = heat::ERROR_RANGE;
    ui.weak(format!("Blue: the error of a hit, from {low:e} (pale) to {high:e} support radii."));
}
