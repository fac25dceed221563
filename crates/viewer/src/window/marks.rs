//! What is painted over the picture: axes, and points that were picked.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Vec2};
use glam::DVec3;

use super::panel::number;
use crate::{Pick, Pose};

/// Points from the middle of the axes to their ends.
const AXIS: f32 = 26.0;

/// Of a picked point.
const ACCENT: Color32 = Color32::from_rgb(255, 196, 64);

/// The world's axes as the picture shows them, in its lower left corner; the nearest is painted last.
pub(super) fn axes(painter: &Painter, rect: Rect, pose: &Pose) {
    let middle = rect.left_bottom() + Vec2::new(AXIS + 18.0, -AXIS - 18.0);
    let mut axes = [
        (DVec3::X, "x", Color32::from_rgb(240, 92, 92)),
        (DVec3::Y, "y", Color32::from_rgb(120, 206, 104)),
        (DVec3::Z, "z", Color32::from_rgb(104, 160, 255)),
    ];
    let [right, up, forward] = pose.axes();
    axes.sort_by(|a, b| b.0.dot(forward).total_cmp(&a.0.dot(forward)));
    for (axis, name, color) in axes {
        let end = Vec2::new(axis.dot(right) as f32, -axis.dot(up) as f32);
        let tip = middle + AXIS * end;
        painter.line_segment([middle, tip], Stroke::new(2.0, color));
        let at = middle + (AXIS + 9.0) * end;
        painter.text(at, Align2::CENTER_CENTER, name, FontId::proportional(13.0), color);
    }
}

/// Rings around picked points, numbered, and how far two are apart.
pub(super) fn picks(painter: &Painter, rect: Rect, pose: &Pose, picks: &[Pick]) {
    let places: Vec<_> = picks.iter().map(|pick| place(rect, pose, pick.point)).collect();
    if let ([first, second], [Some(from), Some(to)]) = (picks, places.as_slice()) {
        painter.line_segment([*from, *to], Stroke::new(1.5, ACCENT));
        let distance = number(first.point.distance(second.point));
        label(painter, from.lerp(*to, 0.5), &distance);
    }
    for (index, place) in places.iter().enumerate() {
        let Some(place) = place else { continue };
        painter.circle_stroke(*place, 5.0, Stroke::new(3.5, Color32::from_black_alpha(140)));
        painter.circle_stroke(*place, 5.0, Stroke::new(1.5, ACCENT));
        if picks.len() > 1 {
            label(painter, *place + Vec2::new(14.0, -12.0), &(index + 1).to_string());
        }
    }
}

/// Words that can be read on any picture.
fn label(painter: &Painter, at: Pos2, words: &str) {
    let text = painter.layout_no_wrap(words.to_owned(), FontId::proportional(13.0), ACCENT);
    let ground = Rect::from_center_size(at, text.size() + Vec2::new(8.0, 4.0));
    painter.rect_filled(ground, 3.0, Color32::from_black_alpha(170));
    painter.galley(ground.center() - 0.5 * text.size(), text, ACCENT);
}

/// Where a point is on the screen; `None` behind the eye.
fn place(rect: Rect, pose: &Pose, point: DVec3) -> Option<Pos2> {
    let [right, up, forward] = pose.axes();
    let ray = point - pose.eye;
    let depth = ray.dot(forward);
    if depth <= 0.0 {
        return None;
    }
    let scale = f64::from(rect.height()) / pose.height_at(depth);
    let offset = Vec2::new((ray.dot(right) * scale) as f32, (-ray.dot(up) * scale) as f32);
    Some(rect.center() + offset)
}
