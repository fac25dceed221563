//! Drags, scrolls, keys, and other sizes.

use eframe::egui::{self, Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use viewer::{Viewer, Window};

use crate::stage::{assert_rendered, rendered, until_sharp, window};

/// Where the molecule is in the window.
pub(crate) fn middle(harness: &Harness<'_, Window>) -> Pos2 {
    harness.get_by_label_contains("Picture of").rect().center()
}

/// Presses a button of the mouse, moves, and lets go.
fn drag(harness: &mut Harness<'_, Window>, button: PointerButton, by: Vec2, modifiers: Modifiers) {
    let from = middle(harness);
    let press = |pos, pressed| Event::PointerButton { pos, button, pressed, modifiers };
    harness.event(Event::PointerMoved(from));
    harness.event_modifiers(press(from, true), modifiers);
    harness.step();
    for step in 1..=4 {
        harness.event_modifiers(Event::PointerMoved(from + by * step as f32 / 4.0), modifiers);
        harness.step();
    }
    harness.event_modifiers(press(from + by, false), modifiers);
    harness.step();
}

fn eye(viewer: &Viewer) -> glam::DVec3 {
    viewer.pose().expect("a pose").eye
}

#[test]
fn a_drag_turns_the_molecule_and_its_picture_is_that_of_render() {
    let mut harness = window("molecule");
    assert_rendered(&mut harness);
    let before = harness.state().viewer().pose().expect("a pose");
    let picture = rendered(harness.state().viewer()).image;
    drag(&mut harness, PointerButton::Primary, Vec2::new(90.0, 30.0), Modifiers::NONE);
    let after = harness.state().viewer().pose().expect("a pose");
    assert!(after.eye.distance(before.eye) > 0.1 * before.distance());
    assert!((after.distance() - before.distance()).abs() < 1e-6 * before.distance());
    assert_rendered(&mut harness);
    assert!(harness.state().viewer().painting().expect("sharp").shown.image != picture);
}

#[test]
fn moving_keeps_hold_of_the_point_that_was_grabbed() {
    for (button, modifiers) in
        [(PointerButton::Secondary, Modifiers::NONE), (PointerButton::Primary, Modifiers::SHIFT)]
    {
        let mut harness = window("molecule");
        until_sharp(&mut harness);
        let held = harness.state().viewer().point_at((0.5, 0.5)).expect("on the molecule");
        let before = eye(harness.state().viewer());
        let by = Vec2::new(40.0, -20.0);
        drag(&mut harness, button, by, modifiers);
        until_sharp(&mut harness);
        let rect = harness.get_by_label_contains("Picture of").rect();
        let viewer = harness.state().viewer();
        assert!(eye(viewer).distance(before) > 0.0);
        let place = Vec2::splat(0.5) + by / rect.size();
        let found = viewer.point_at((place.x.into(), place.y.into())).expect("still there");
        assert!(found.distance(held) < 0.5, "{found} for {held}, in ångströms");
    }
}

#[test]
fn scrolling_comes_nearer_to_the_point_under_the_cursor() {
    let mut harness = window("molecule");
    until_sharp(&mut harness);
    let rect = harness.get_by_label_contains("Picture of").rect();
    let at = rect.min + rect.size() * Vec2::new(0.55, 0.45);
    let place = (0.55, 0.45);
    let held = harness.state().viewer().point_at(place).expect("on the molecule");
    let before = eye(harness.state().viewer()).distance(held);
    harness.event(Event::PointerMoved(at));
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 100.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers: Modifiers::NONE,
    });
    for _ in 0..60 {
        harness.step();
    }
    until_sharp(&mut harness);
    let viewer = harness.state().viewer();
    assert!(eye(viewer).distance(held) < 0.9 * before);
    let found = viewer.point_at(place).expect("still there");
    assert!(found.distance(held) < 0.5, "{found} for {held}, in ångströms");
}

#[test]
fn keys_turn_and_lead_home() {
    let mut harness = window("molecule");
    until_sharp(&mut harness);
    let home = eye(harness.state().viewer());
    harness.key_down(Key::ArrowLeft);
    for _ in 0..5 {
        harness.step();
    }
    harness.key_up(Key::ArrowLeft);
    harness.step();
    let turned = eye(harness.state().viewer());
    assert!(turned.distance(home) > 1.0, "{turned} from {home}");
    harness.key_press(Key::X);
    harness.step();
    let pose = harness.state().viewer().pose().expect("a pose");
    assert!((pose.eye - pose.look_at).normalize().x > 0.999_999);
    assert_rendered(&mut harness);
    harness.key_press(Key::H);
    harness.step();
    assert_eq!(eye(harness.state().viewer()), home);
    assert!(!harness.state().viewer().viewpoint().is_asked(), "the scene's own, to the last bit");
    assert_rendered(&mut harness);
}

#[test]
fn another_size_gets_another_picture() {
    let mut harness = window("two-merging");
    until_sharp(&mut harness);
    let before = harness.state().viewer().size();
    harness.set_size(Vec2::new(900.0, 600.0));
    harness.step();
    assert_rendered(&mut harness);
    assert_ne!(harness.state().viewer().size(), before);
    harness.set_pixels_per_point(2.0);
    harness.step();
    harness.step();
    assert_rendered(&mut harness);
}
