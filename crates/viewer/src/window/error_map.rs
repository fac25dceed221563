//! The error of each pixel over the picture, row by row as the reference finds it.

use eframe::egui::{self, Color32, ColorImage, Pos2, Rect, TextureHandle, TextureOptions};
use harness::heat;

use crate::{Judge, Verdicts};

/// The map on the graphics side.
#[derive(Default)]
pub(super) struct ErrorMap {
    texture: Option<TextureHandle>,
    /// The judgements that it shows.
    shown: usize,
}

impl ErrorMap {
    pub(super) fn show(&mut self, ui: &egui::Ui, rect: Rect, judge: &Judge) {
        let Some(verdicts) = judge.verdicts().filter(|found| !found.judgements.is_empty()) else {
            self.shown = 0;
            return;
        };
        if self.shown != verdicts.judgements.len() {
            self.shown = verdicts.judgements.len();
            let image = map(verdicts);
            let texture = ui.ctx().load_texture("errors", image, TextureOptions::NEAREST);
            self.texture = Some(texture);
        }
        if let Some(texture) = &self.texture {
            let share = verdicts.progress();
            let part = Rect::from_min_size(rect.min, rect.size() * egui::vec2(1.0, share));
            let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
            ui.painter_at(rect).image(texture.id(), part, whole, Color32::WHITE);
        }
    }
}

fn map(verdicts: &Verdicts) -> ColorImage {
    let width = verdicts.size.0 as usize;
    let size = [width, verdicts.judgements.len() / width];
    let rgb: Vec<u8> = verdicts.judgements.iter().flat_map(heat::color).collect();
    ColorImage::from_rgb(size, &rgb)
}
