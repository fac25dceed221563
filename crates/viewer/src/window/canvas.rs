//! The picture, and what the mouse does on it.

use eframe::egui::{
    self, Color32, ColorImage, EventFilter, Id, PointerButton, Pos2, Rect, Response, Role, Sense,
    TextureHandle, TextureOptions, Vec2, WidgetInfo,
};
use metaball::Verdict;

use super::error_map::ErrorMap;
use super::marks;
use crate::{Hand, Judge, Painting, Pick, Viewer};

/// The share of the distance that is left after one point of scrolling.
const ZOOM: f64 = 0.997;

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
    hand: Hand,
}

impl Canvas {
    /// The widget that takes the keys, once it has been shown.
    pub(super) fn id(&self) -> Option<Id> {
        self.id
    }

    pub(super) fn show(
        &mut self,
        ui: &mut egui::Ui,
        viewer: &mut Viewer,
        picks: &mut Vec<Pick>,
        judge: &Judge,
    ) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let size = pixels(ui, rect);
        self.id = Some(response.id);
        focus(ui, &response);
        label(&response, viewer);
        self.turn(&response, viewer);
        self.zoom(ui, &response, viewer);
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
        self.errors.show(ui, rect, judge);
        if let Some(pose) = viewer.pose() {
            marks::picks(&painter, rect, &pose, picks);
            marks::axes(&painter, rect, &pose);
        }
    }

    /// Drags: turning about the middle, or moving along with the point under the cursor.
    fn turn(&mut self, response: &Response, viewer: &mut Viewer) {
        if response.drag_started()
            && let Some(at) = response.interact_pointer_pos()
        {
            self.hand.grab(viewer, place(response.rect, at));
        }
        let shift = response.ctx.input(|input| input.modifiers.shift);
        let height = f64::from(response.rect.height());
        let by = response.drag_delta();
        let (right, down) = (f64::from(by.x) / height, f64::from(by.y) / height);
        if by == Vec2::ZERO {
            return;
        }
        if response.dragged_by(PointerButton::Primary) && !shift {
            self.hand.turn(viewer, right, down);
        } else {
            self.hand.slide(viewer, right, down);
        }
    }

    /// Scrolls and pinches: towards the point under the cursor.
    fn zoom(&self, ui: &egui::Ui, response: &Response, viewer: &mut Viewer) {
        let (scrolled, pinched) =
            ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        if let Some(at) = response.hover_pos() {
            let share = ZOOM.powf(scrolled.into()) / f64::from(pinched);
            self.hand.zoom(viewer, place(response.rect, at), share);
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
