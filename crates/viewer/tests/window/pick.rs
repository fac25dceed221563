//! Clicks.

use eframe::egui::Vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use metaball::Verdict;
use viewer::Window;

use crate::camera::middle;
use crate::stage::{rendered, until_sharp, window};

fn click(harness: &mut Harness<'_, Window>, at: Vec2) {
    let at = middle(harness) + at;
    harness.drag_at(at);
    harness.step();
    harness.drop_at(at);
    harness.step();
    // Not the second click of a double one.
    for _ in 0..30 {
        harness.step();
    }
}

#[test]
fn a_click_reads_what_the_picture_shows_there() {
    let mut harness = window("molecule");
    until_sharp(&mut harness);
    click(&mut harness, Vec2::ZERO);
    let drawing = rendered(harness.state().viewer());
    let [pick] = harness.state().picks() else { panic!("one point") };
    let near = drawing.hits.iter().find(|hit| {
        hit.verdict == Verdict::Hit && hit.t == pick.hit.t && hit.normal == pick.hit.normal
    });
    assert!(near.is_some(), "a pixel of render has it bit for bit");
    let viewer = harness.state().viewer();
    let threshold = viewer.model().expect("built").scene().threshold();
    assert!((pick.field - f64::from(threshold)).abs() < 1e-5);
    let whole: f64 = pick.shares.iter().map(|share| share.share).sum();
    assert!((whole - 1.0).abs() < 1e-12);
    let first = pick.shares[0];
    harness.get_by_label(&format!("#{}", first.ball));
    harness.get_by_label_contains(&format!("{} balls make it", pick.shares.len()));
}

#[test]
fn two_points_have_a_distance_and_nothing_forgets_them() {
    let mut harness = window("molecule");
    until_sharp(&mut harness);
    click(&mut harness, Vec2::new(-20.0, 0.0));
    click(&mut harness, Vec2::new(20.0, 10.0));
    let [first, second] = harness.state().picks() else { panic!("two points") };
    assert!(first.point.distance(second.point) > 1.0);
    harness.get_by_label_contains("Distance ");
    let corner =
        -0.5 * harness.get_by_label_contains("Picture of").rect().size() + Vec2::splat(4.0);
    click(&mut harness, corner);
    assert!(harness.state().picks().is_empty());
}
