//! What is looked at: its name, its size, and what its loader says.

use eframe::egui::{Color32, Grid, RichText, Ui};
use metaball::{Legend, NoteKind, Scale};

use super::{number, row, swatch};
use crate::Viewer;

/// A name that is being written.
#[derive(Default)]
pub(super) struct Opening {
    spec: String,
}

impl Opening {
    pub(super) fn show(&mut self, ui: &mut Ui, viewer: &mut Viewer) {
        self.open(ui, viewer);
        facts(ui, viewer);
        let Some(subject) = viewer.subject() else { return };
        for note in subject.notes.iter().flatten() {
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing.x = 4.0;
                ui.label(RichText::new(kind(note.kind)).strong());
                ui.label(&note.text);
            });
        }
        if let Some(legend) = &subject.legend {
            show_legend(ui, legend);
        }
    }

    fn open(&mut self, ui: &mut Ui, viewer: &mut Viewer) {
        ui.horizontal(|ui| {
            let label = ui.label("Open");
            let field = eframe::egui::TextEdit::singleline(&mut self.spec)
                .hint_text("a file or a known scene")
                .desired_width(ui.available_width() - 44.0);
            let written = ui.add(field).labelled_by(label.id);
            let entered = written.lost_focus()
                && ui.input(|input| input.key_pressed(eframe::egui::Key::Enter));
            if (ui.button("Go").clicked() || entered) && !self.spec.is_empty() {
                viewer.open(std::mem::take(&mut self.spec));
            }
        });
    }
}

fn facts(ui: &mut Ui, viewer: &Viewer) {
    let (Some(subject), Some(model)) = (viewer.subject(), viewer.model()) else { return };
    let scene = model.scene();
    Grid::new("facts").num_columns(2).show(ui, |ui| {
        row(ui, "Name", RichText::new(&subject.name).strong());
        row(ui, "Balls", scene.len().to_string());
        let size = model.bounds().extent().to_array().map(|length| number(length.into()));
        row(ui, "Size", size.join(" × "));
        row(
            ui,
            "Tree",
            format!(
                "{:.0} ms, {:.1} MB",
                1e3 * model.build_time().as_secs_f64(),
                model.tree_bytes() as f64 / 1e6
            ),
        );
    });
}

fn kind(kind: NoteKind) -> &'static str {
    match kind {
        NoteKind::Read => "Read",
        NoteKind::Guessed => "Guessed",
        NoteKind::LeftOut => "Left out",
        _ => "Changed",
    }
}

/// Steps of a colour map.
const STEPS: usize = 48;

fn show_legend(ui: &mut Ui, legend: &Legend) {
    ui.strong(&legend.title);
    match &legend.scale {
        Scale::Numbers(from, to) => {
            let size = eframe::egui::vec2(ui.available_width(), 12.0);
            let (bar, _) = ui.allocate_exact_size(size, eframe::egui::Sense::hover());
            for step in 0..STEPS {
                let share = |step: usize| bar.left() + bar.width() * step as f32 / STEPS as f32;
                let part = eframe::egui::Rect::from_x_y_ranges(
                    share(step)..=share(step + 1) + 0.5,
                    bar.y_range(),
                );
                let [r, g, b] = Legend::color_at((step as f64 + 0.5) / STEPS as f64).to_srgb();
                ui.painter().rect_filled(part, 0.0, Color32::from_rgb(r, g, b));
            }
            ui.columns(2, |columns| {
                columns[0].label(number(*from));
                columns[1].with_layout(
                    eframe::egui::Layout::right_to_left(eframe::egui::Align::Min),
                    |ui| ui.label(number(*to)),
                );
            });
        }
        Scale::Words(words) => {
            for (word, color) in words {
                ui.horizontal(|ui| {
                    swatch(ui, color.to_srgb());
                    ui.label(word);
                });
            }
        }
    }
}
