//! The panel beside the picture: a section for each thing that can be asked or changed.

mod camera;
mod cut;
mod light;
mod output;
mod point;
mod scene;
mod surface;
mod truth;

use eframe::egui::{self, CollapsingHeader, Color32, ScrollArea, Sense, ThemePreference, Ui, Vec2};

use self::output::Naming;
use self::scene::Opening;
use self::surface::Coloring;
use super::keys::KEYS;
use crate::{Judge, Pick, Viewer};

/// What the sections remember.
#[derive(Default)]
pub(super) struct Sections {
    opening: Opening,
    coloring: Coloring,
    naming: Naming,
}

impl Sections {
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        viewer: &mut Viewer,
        picks: &mut Vec<Pick>,
        judge: &mut Judge,
    ) {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.add_space(4.0);
            section(ui, "Scene", true, |ui| self.opening.show(ui, viewer));
            if viewer.model().is_some() {
                section(ui, "Surface", true, |ui| {
                    surface::show(ui, viewer, &mut self.coloring);
                });
                section(ui, "Light", false, |ui| light::show(ui, viewer));
                section(ui, "Cut", false, |ui| cut::show(ui, viewer));
                section(ui, "Points", true, |ui| point::show(ui, viewer, picks));
                section(ui, "Truth", false, |ui| truth::show(ui, viewer, judge));
                section(ui, "Camera", false, |ui| camera::show(ui, viewer));
                section(ui, "Picture", false, |ui| self.naming.show(ui, viewer));
            }
            section(ui, "Keys", false, keys);
            ui.add_space(8.0);
            themes(ui);
        });
    }
}

fn section(ui: &mut Ui, name: &str, is_open: bool, contents: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(name).default_open(is_open).show_unindented(ui, |ui| {
        contents(ui);
        ui.add_space(6.0);
    });
}

fn themes(ui: &mut Ui) {
    let old = ui.ctx().options(|options| options.theme_preference);
    let mut theme = old;
    ui.horizontal(|ui| {
        ui.selectable_value(&mut theme, ThemePreference::System, "As the system");
        ui.selectable_value(&mut theme, ThemePreference::Light, "Light");
        ui.selectable_value(&mut theme, ThemePreference::Dark, "Dark");
    });
    if theme != old {
        ui.ctx().set_theme(theme);
    }
}

fn keys(ui: &mut Ui) {
    egui::Grid::new("keys").num_columns(2).show(ui, |ui| {
        for (key, what) in KEYS {
            ui.strong(key);
            ui.label(what);
            ui.end_row();
        }
    });
}

/// A square of a colour.
fn swatch(ui: &mut Ui, [red, green, blue]: [u8; 3]) {
    let (square, _) = ui.allocate_exact_size(Vec2::splat(11.0), Sense::hover());
    ui.painter().rect_filled(square, 2.0, Color32::from_rgb(red, green, blue));
}

/// A name and what is said of it, in a grid of two columns.
fn row(ui: &mut Ui, name: &str, value: impl Into<egui::WidgetText>) {
    ui.weak(name);
    ui.label(value);
    ui.end_row();
}

/// Five digits, and not more zeros than they need.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) {
        return format!("{value:.4e}");
    }
    let whole = if size >= 1.0 { size.log10().floor() as usize } else { 0 };
    format!("{value:.*}", 4usize.saturating_sub(whole))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_five_digits() {
        for (value, wanted) in [
            (0.0, "0.0000"),
            (1.234_567_8, "1.2346"),
            (-123.456, "-123.46"),
            (12_345.678, "12346"),
            (5.46e6, "5.4600e6"),
            (1.5e-5, "1.5000e-5"),
        ] {
            assert_eq!(number(value), wanted);
        }
    }
}
