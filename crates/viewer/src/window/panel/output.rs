//! What is seen, as a file and as a command line.

use std::path::PathBuf;

use eframe::egui::{DragValue, ProgressBar, TextEdit, Ui};

use crate::{Export, Viewer};

/// A file that is being named.
pub(super) struct Naming {
    path: String,
    /// Other than that of the window.
    size: Option<(u32, u32)>,
    exr: bool,
}

impl Default for Naming {
    fn default() -> Self {
        Self { path: "picture.png".to_owned(), size: None, exr: false }
    }
}

impl Naming {
    pub(super) fn show(&mut self, ui: &mut Ui, viewer: &mut Viewer) {
        let Some(shown) = viewer.size() else { return };
        ui.horizontal(|ui| {
            let label = ui.label("File");
            ui.add(TextEdit::singleline(&mut self.path).desired_width(f32::INFINITY))
                .labelled_by(label.id)
                .on_hover_text(".png, .jpg or .jpeg");
        });
        self.size(ui, shown);
        let exr = match viewer.look().light.is_asked() {
            true => "Light too, as OpenEXR",
            false => "Distances and normals too, as OpenEXR",
        };
        ui.checkbox(&mut self.exr, exr);
        self.save(ui, viewer, shown);
        if let Some(line) = viewer.command_line() {
            let line = line.to_string();
            ui.add_space(4.0);
            ui.weak("The command that draws this picture:");
            ui.add(
                TextEdit::multiline(&mut line.as_str())
                    .desired_width(f32::INFINITY)
                    .desired_rows(3),
            );
            if ui.button("Copy command").clicked() {
                ui.ctx().copy_text(line);
            }
        }
    }

    fn size(&mut self, ui: &mut Ui, shown: (u32, u32)) {
        ui.horizontal(|ui| {
            let (mut width, mut height) = self.size.unwrap_or(shown);
            ui.label("Size");
            ui.add(DragValue::new(&mut width).range(1..=32_768));
            ui.label("×");
            ui.add(DragValue::new(&mut height).range(1..=32_768));
            let size = (width, height);
            self.size = (size != shown).then_some(size);
            if self.size.is_some()
                && ui.button("Reset").on_hover_text("That of the window").clicked()
            {
                self.size = None;
            }
        });
    }

    fn save(&self, ui: &mut Ui, viewer: &mut Viewer, shown: (u32, u32)) {
        if let Some(progress) = viewer.exporting() {
            ui.horizontal(|ui| {
                if ui.button("Stop").clicked() {
                    viewer.stop_export();
                }
                ui.add(ProgressBar::new(progress).show_percentage());
            });
            return;
        }
        if ui.button("Save").clicked() {
            let (image, size) = (PathBuf::from(&self.path), self.size.unwrap_or(shown));
            viewer.export(Export { image, size, exr: self.exr });
        }
        match viewer.exported() {
            Some(Ok(path)) => _ = ui.label(format!("Wrote {path}")),
            Some(Err(error)) => _ = ui.colored_label(ui.visuals().error_fg_color, error),
            None => {}
        }
    }
}
