//! The picture, and what the mouse does on it.

use std::ops::RangeInclusive;

use eframe::egui::{
    self, Color32, ColorImage, EventFilter, Id, PointerButton, Pos2, Rect, Response, Role, Sense,
    TextureHandle, TextureOptions, Vec2, WidgetInfo,
};
use glam::DVec3;
use metaball::Verdict;

use super::error_map::ErrorMap;
use super::marks;
use crate::{Painting, Pick, Pose, Viewer};

/// Radians that the eye turns for a drag across the picture's height.
const TURN: f64 = std::f64::consts::PI;

/// The share of the distance that is left after one point of scrolling.
const ZOOM: f64 = 0.997;

/// The share that is left after one scroll, at most and at least.
const ZOOM_LIMITS: RangeInclusive<f64> = 0.2..=5.0;

/// Marks pixels that arithmetic could not decide.
const UNDECIDED: Color32 = Color32::from_rgb(255, 0, 255);

/// The picture on the graphics side.
#[derive(Default)]
pub(super) struct Canvas {
    texture: Option<TextureHandle>,
    /// Which painting the texture is of.
    shown: u64,
    errors: ErrorMap,
    /// The widget that takes the keys.
    id: Option<Id>,
    /// The point that a drag took hold of, in the coordinates of the file.
    grabbed: Option<DVec3>,
}

impl Canvas {
    /// The widget that takes the keys, once it has been shown.
    pub(super) fn id(&self) -> Option<Id> {
        self.id
    }

    pub(super) fn show(&mut self, ui: &mut egui::Ui, viewer: &mut Viewer, picks: &mut Vec<Pick>) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let size = pixels(ui, rect);
        self.id = Some(response.id);
        focus(ui, &response);
        label(&response, viewer);
        self.turn(&response, viewer);
        zoom(ui, &response, viewer);
        pick(&response, size, viewer, picks);
        if let Some(wait) = viewer.draw(size, response.is_pointer_button_down_on()) {
            ui.ctx().request_repaint_after(wait);
        }
        self.upload(ui, viewer);
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, Color32::from_rgb(48, 54, 64));
        if let Some(texture) = self.texture.as_ref().filter(|_| viewer.painting().is_some()) {
            let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
            painter.image(texture.id(), rect, whole, Color32::WHITE);
        }
        self.errors.show(ui, rect, viewer);
        if let Some(pose) = viewer.pose() {
            marks::picks(&painter, rect, &pose, picks);
            marks::axes(&painter, rect, &pose);
        }
    }

    /// Drags: turning about the middle, or moving along with the point under the cursor.
    fn turn(&mut self, response: &Response, viewer: &mut Viewer) {
        let Some(pose) = viewer.pose() else { return };
        if response.drag_started() {
            let place = response.interact_pointer_pos().map(|at| place(response.rect, at));
            self.grabbed = place.and_then(|place| viewer.point_at(place));
        }
        let shift = response.ctx.input(|input| input.modifiers.shift);
        let height = f64::from(response.rect.height());
        let by = response.drag_delta();
        let (right, down) = (f64::from(by.x) / height, f64::from(by.y) / height);
        if by == Vec2::ZERO {
            return;
        }
        if response.dragged_by(PointerButton::Primary) && !shift {
            viewer.set_pose(pose.orbited(TURN * right, TURN * down));
        } else {
            let depth = self.grabbed.map_or(pose.distance(), |point| depth_of(&pose, point));
            let units = pose.height_at(depth);
            viewer.set_pose(pose.moved(units * DVec3::new(-right, down, 0.0)));
        }
    }

    /// Hands a new picture to the graphics side.
    fn upload(&mut self, ui: &egui::Ui, viewer: &Viewer) {
        let Some(painting) = viewer.painting().filter(|_| viewer.paintings() != self.shown) else {
            return;
        };
        self.shown = viewer.paintings();
        let image = marked(painting);
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            None => {
                let texture = ui.ctx().load_texture("picture", image, TextureOptions::LINEAR);
                self.texture = Some(texture);
            }
        }
    }
}

/// The picture, with pixels marked that are undecided.
fn marked(painting: &Painting) -> ColorImage {
    let image = &painting.shown.image;
    let size = [image.width as usize, image.height as usize];
    let mut marked = ColorImage::from_rgba_premultiplied(size, &image.rgba);
    if painting.undecided == 0 {
        return marked;
    }
    for (pixel, hit) in marked.pixels.iter_mut().zip(&painting.shown.hits) {
        if hit.verdict == Verdict::Undecided {
            *pixel = UNDECIDED;
        }
    }
    marked
}

/// Whoever clicks on the picture wants its keys, arrows among them.
fn focus(ui: &egui::Ui, response: &Response) {
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    if response.has_focus() {
        let arrows = EventFilter {
            horizontal_arrows: true,
            vertical_arrows: true,
            escape: true,
            ..EventFilter::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    }
}

/// Says what it is to those who cannot see it.
fn label(response: &Response, viewer: &Viewer) {
    let name = viewer.subject().map_or("nothing yet", |subject| &subject.name).to_owned();
    response
        .widget_info(move || WidgetInfo::labeled(Role::Image, true, format!("Picture of {name}")));
}

/// Pixels of the screen across and down.
fn pixels(ui: &egui::Ui, rect: Rect) -> (u32, u32) {
    let size = ui.ctx().pixels_per_point() * rect.size();
    (size.x.round().max(1.0) as u32, size.y.round().max(1.0) as u32)
}

/// From the top left, each from 0 to 1.
fn place(rect: Rect, at: Pos2) -> (f64, f64) {
    let place = (at - rect.min) / rect.size();
    (place.x.into(), place.y.into())
}

/// How far in front of the eye.
fn depth_of(pose: &Pose, point: DVec3) -> f64 {
    (point - pose.eye).dot(pose.axes()[2])
}

/// Scrolls and pinches: towards the point under the cursor, or the one behind it that is as far as the
/// middle.
fn zoom(ui: &egui::Ui, response: &Response, viewer: &mut Viewer) {
    let (scrolled, pinched) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
    let share = (ZOOM.powf(scrolled.into()) / f64::from(pinched))
        .clamp(*ZOOM_LIMITS.start(), *ZOOM_LIMITS.end());
    let (Some(at), Some(pose)) = (response.hover_pos(), viewer.pose()) else { return };
    if share == 1.0 {
        return;
    }
    let place = place(response.rect, at);
    let about = viewer.point_at(place).unwrap_or_else(|| behind(&pose, response.rect, place));
    viewer.set_pose(pose.zoomed(about, share));
}

/// The point behind a place of the picture that is as far in front of the eye as the middle.
fn behind(pose: &Pose, rect: Rect, (right, down): (f64, f64)) -> DVec3 {
    let units = pose.height_at(pose.distance());
    let aspect = f64::from(rect.width() / rect.height());
    let across = DVec3::new((right - 0.5) * aspect, 0.5 - down, 0.0);
    pose.moved(units * across).look_at
}

/// Clicks: the point that was hit, or none; a second one with it. Double clicks look at it.
fn pick(response: &Response, size: (u32, u32), viewer: &mut Viewer, picks: &mut Vec<Pick>) {
    if !response.clicked() {
        return;
    }
    let Some(at) = response.interact_pointer_pos() else { return };
    let (right, down) = place(response.rect, at);
    let pixel = |share: f64, count: u32| {
        ((share * f64::from(count)) as i64).clamp(0, i64::from(count) - 1) as u32
    };
    let found = viewer.pick((pixel(right, size.0), pixel(down, size.1)));
    match found {
        Some(found) if response.double_clicked() => {
            if let Some(pose) = viewer.pose() {
                viewer.set_pose(pose.centered(found.point));
            }
        }
        Some(found) => {
            if picks.len() > 1 {
                picks.clear();
            }
            picks.push(found);
        }
        None => picks.clear(),
    }
}
