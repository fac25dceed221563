//! The keyboard.

use std::time::Instant;

use eframe::egui::{self, Id, Key, Modifiers};
use glam::DVec3;

use crate::{Pose, Viewer};

/// What each key does, for the list in the panel.
pub(super) const KEYS: [(&str, &str); 11] = [
    ("Arrows", "turn"),
    ("Shift and arrows", "move sideways"),
    ("+ and -", "nearer, farther"),
    ("W S A D, R F", "fly"),
    ("Q E", "roll"),
    ("H", "home"),
    ("X Y Z", "along an axis; with Shift from behind"),
    ("Space", "play or stop"),
    (", and .", "frame before, next frame"),
    ("Escape", "give up what is being read or built"),
    ("Ctrl + and -", "larger, smaller words"),
];

/// Radians that the eye turns a second while a key is held.
const TURN: f64 = 1.2;

/// The share of the distance that is left after a second of coming nearer.
const NEARER: f64 = 0.3;

/// Obeys keys, unless a widget of the panel has them.
pub(super) fn obey(ui: &egui::Ui, viewer: &mut Viewer, canvas: Option<Id>) {
    let focused = ui.memory(egui::Memory::focused);
    if focused.is_some() && focused != canvas {
        return;
    }
    let pressed = |key| ui.input(|input| input.key_pressed(key));
    if pressed(Key::Escape) {
        viewer.cancel();
    }
    if pressed(Key::H) || pressed(Key::Home) {
        viewer.go_home();
    }
    frames(viewer, pressed);
    if let Some(pose) = viewer.pose() {
        let moved = held(ui, along_axis(ui, pose));
        if moved != pose {
            viewer.set_pose(moved);
        }
    }
}

fn frames(viewer: &mut Viewer, pressed: impl Fn(Key) -> bool) {
    let (now, old) = (Instant::now(), viewer.timeline().clone());
    if pressed(Key::Space) {
        viewer.set_timeline(old.playing(!old.is_playing(), now));
    } else if pressed(Key::Period) {
        viewer.set_timeline(old.stepped(1, now));
    } else if pressed(Key::Comma) {
        viewer.set_timeline(old.stepped(-1, now));
    }
}

fn along_axis(ui: &egui::Ui, pose: Pose) -> Pose {
    let axes = [(Key::X, DVec3::X), (Key::Y, DVec3::Y), (Key::Z, DVec3::Z)];
    let none = |input: &egui::InputState| !input.modifiers.command && !input.modifiers.alt;
    let pressed = |key| ui.input(|input| input.key_pressed(key) && none(input));
    match axes.into_iter().find(|(key, _)| pressed(*key)) {
        Some((_, axis)) if ui.input(|input| input.modifiers.shift) => pose.seen_from(-axis),
        Some((_, axis)) => pose.seen_from(axis),
        None => pose,
    }
}

/// What goes on while keys are held.
fn held(ui: &egui::Ui, pose: Pose) -> Pose {
    let (seconds, modifiers) = ui.input(|input| (input.stable_dt.min(0.1), input.modifiers));
    let seconds = f64::from(seconds);
    if modifiers.matches_any(Modifiers::COMMAND | Modifiers::ALT) {
        return pose;
    }
    let way = |more: &[Key], less: &[Key]| {
        let down = |keys: &[Key]| ui.input(|input| keys.iter().any(|key| input.key_down(*key)));
        f64::from(i8::from(down(more)) - i8::from(down(less)))
    };
    let right = way(&[Key::ArrowRight], &[Key::ArrowLeft]);
    let up = way(&[Key::ArrowUp], &[Key::ArrowDown]);
    let nearer = way(&[Key::Plus, Key::Equals], &[Key::Minus]);
    let roll = way(&[Key::E], &[Key::Q]);
    let fly =
        DVec3::new(way(&[Key::D], &[Key::A]), way(&[Key::R], &[Key::F]), way(&[Key::W], &[Key::S]));
    if [right, up, nearer, roll, fly.length()].iter().all(|way| *way == 0.0) {
        return pose;
    }
    // While a key is held, the next step is due at once.
    ui.ctx().request_repaint();
    let step = seconds * pose.height_at(pose.distance());
    let moved = if modifiers.shift {
        pose.moved(step * DVec3::new(-right, -up, 0.0))
    } else {
        pose.orbited(seconds * TURN * right, -seconds * TURN * up)
    };
    moved
        .zoomed(moved.look_at, NEARER.powf(seconds * nearer))
        .rolled(seconds * TURN * roll)
        .moved(step * fly)
}
