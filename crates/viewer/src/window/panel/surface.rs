//! The field whose surface is seen, and what the picture shows of it.

use eframe::egui::{ComboBox, Key, Slider, TextEdit, Ui};
use metaball::{ColorBy, Overrides, Picture, ReadOptions};
use metaball_core::Kernel;

use crate::{Look, Viewer};

/// How far the threshold's slider goes from the scene's own, either way.
const RANGE: f32 = 16.0;

const PICTURES: [(Picture, &str); 4] = [
    (Picture::Phong, "Surface"),
    (Picture::Normal, "Normals"),
    (Picture::Depth, "Distances"),
    (Picture::Color, "Colours"),
];

/// A column's name that is being written.
#[derive(Default)]
pub(super) struct Coloring {
    column: String,
    refusal: Option<String>,
}

impl Coloring {
    /// Particles get their colours where they are read, too.
    fn show(&mut self, ui: &mut Ui, viewer: &mut Viewer) {
        ui.horizontal(|ui| {
            let label = ui.label("Colour by");
            let field = TextEdit::singleline(&mut self.column)
                .hint_text("a column, or none")
                .desired_width(ui.available_width() - 8.0);
            let written = ui.add(field).labelled_by(label.id);
            let is_entered = ui.input(|input| input.key_pressed(Key::Enter));
            if written.lost_focus() && is_entered {
                self.refusal = self.read(viewer).err();
            }
        });
        if let Some(refusal) = &self.refusal {
            ui.colored_label(ui.visuals().error_fg_color, refusal);
        }
    }

    fn read(&self, viewer: &mut Viewer) -> Result<(), String> {
        let column = self.column.trim();
        let color_by = match column {
            "" => None,
            column => Some(column.parse::<ColorBy>().map_err(|error| error.to_string())?),
        };
        viewer.read_as(ReadOptions { color_by, ..viewer.reading().clone() });
        Ok(())
    }
}

pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer, coloring: &mut Coloring) {
    let Some(model) = viewer.model() else { return };
    let (kernel, threshold) = (model.scene().kernel(), model.scene().threshold());
    let mut field = *viewer.field();
    kernels(ui, kernel, &mut field);
    thresholds(ui, threshold, &mut field);
    viewer.set_field(field);
    if viewer.subject().is_some_and(crate::Subject::is_of_file) {
        radii(ui, viewer);
        coloring.show(ui, viewer);
    }
    let old = viewer.look().picture;
    let mut picture = old;
    ui.horizontal_wrapped(|ui| {
        for (kind, name) in PICTURES {
            ui.selectable_value(&mut picture, kind, name);
        }
    });
    if picture != old {
        viewer.set_look(Look { picture, ..viewer.look().clone() });
    }
}

fn kernels(ui: &mut Ui, shown: Kernel, field: &mut Overrides) {
    let mut kernel = shown;
    ComboBox::from_label("Kernel").selected_text(kernel.to_string()).show_ui(ui, |ui| {
        for other in Kernel::all() {
            ui.selectable_value(&mut kernel, other, other.to_string());
        }
    });
    if kernel != shown {
        (field.kernel, field.exponent) = (Some(kernel), None);
    }
}

fn thresholds(ui: &mut Ui, shown: f32, field: &mut Overrides) {
    ui.horizontal(|ui| {
        let mut threshold = field.threshold.unwrap_or(shown);
        let middle = if field.threshold.is_some() { 0.25 } else { shown };
        let range = (middle.min(shown) / RANGE)..=(middle.max(shown) * RANGE);
        let slider = Slider::new(&mut threshold, range).logarithmic(true).text("Threshold");
        if ui.add(slider).changed() && threshold > 0.0 {
            field.threshold = Some(threshold);
        }
        let reset = ui.add_enabled(field.threshold.is_some(), eframe::egui::Button::new("Reset"));
        if reset.on_hover_text("The scene's own threshold").clicked() {
            field.threshold = None;
        }
    });
}

/// Radii are scaled where they are made, by the file's reader.
fn radii(ui: &mut Ui, viewer: &mut Viewer) {
    let old = viewer.reading().radius_scale.unwrap_or(1.0);
    let mut scale = old;
    let slider = Slider::new(&mut scale, 0.25..=4.0).logarithmic(true).text("Radius scale");
    ui.add(slider);
    if scale != old {
        let radius_scale = (scale != 1.0).then_some(scale);
        viewer.read_as(ReadOptions { radius_scale, ..viewer.reading().clone() });
    }
}
