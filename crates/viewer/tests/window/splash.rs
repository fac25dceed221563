//! A scene that moves.

use eframe::egui::Key;
use egui_kittest::kittest::Queryable;
use metaball::Overrides;

use crate::stage::{assert_rendered, until, until_sharp, window};

#[test]
fn frames_are_stepped_through_and_played() {
    let mut harness = window("splash");
    assert_rendered(&mut harness);
    let timeline = harness.state().viewer().timeline().clone();
    assert!(timeline.is_moving() && timeline.frame() == timeline.frames().start);
    harness.get_by_label("Next").click();
    harness.step();
    let next = timeline.frame() + 1;
    assert_eq!(harness.state().viewer().timeline().frame(), next);
    until(&mut harness, |viewer| viewer.progress() == viewer::Progress::Ready);
    assert_rendered(&mut harness);
    let splash = bench_scenes::Moving::load("splash", &Overrides::default()).expect("known");
    let wanted = splash.frame(next).expect("there");
    assert!(*harness.state().viewer().model().expect("built").scene() == wanted);

    harness.key_press(Key::Space);
    until(&mut harness, |viewer| viewer.timeline().frame() > next + 2);
    harness.key_press(Key::Space);
    harness.step();
    assert!(!harness.state().viewer().timeline().is_playing());
    until(&mut harness, |viewer| viewer.progress() == viewer::Progress::Ready);
    until_sharp(&mut harness);
    let viewer = harness.state().viewer();
    let wanted = splash.frame(viewer.timeline().frame()).expect("there");
    assert!(*viewer.model().expect("built").scene() == wanted, "what is shown is what is named");
    let line = viewer.command_line().expect("open").to_string();
    let frame = viewer.timeline().frame();
    assert!(line.starts_with("metaball animate splash"), "{line}");
    assert!(line.contains(&format!("--frames={frame}..{}", frame + 1)), "{line}");
}
