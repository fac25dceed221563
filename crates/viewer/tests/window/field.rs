//! Another kernel, threshold and radius; light; a cut.

use eframe::egui::{Key, Role};
use egui_kittest::kittest::Queryable;
use metaball::{LightOptions, Overrides, ReadOptions};
use metaball_core::Kernel;
use viewer::{Look, Stage};

use crate::stage::{assert_rendered, rendered, start, until, until_sharp, window, window_of};

#[test]
fn the_tree_is_built_anew_beside_the_picture() {
    let mut harness = window("molecule");
    assert_rendered(&mut harness);
    let before = rendered(harness.state().viewer()).image;
    harness.get_by_role_and_label(Role::Slider, "Threshold").set_value_accesskit(0.6);
    harness.step();
    harness.step();
    until(&mut harness, |viewer| {
        viewer.model().is_some_and(|model| (model.scene().threshold() - 0.6).abs() < 1e-6)
    });
    assert_rendered(&mut harness);
    assert!(rendered(harness.state().viewer()).image != before);
    harness.get_by_label("Kernel").click();
    harness.run_steps(2);
    harness.get_by_label(&Kernel::Wyvill.to_string()).click();
    harness.step();
    until(&mut harness, |viewer| {
        viewer.model().is_some_and(|model| model.scene().kernel() == Kernel::Wyvill)
    });
    assert_rendered(&mut harness);
    let viewer = harness.state().viewer();
    let line = viewer.command_line().expect("open").to_string();
    assert!(line.contains("--kernel=wyvill --threshold=0.6"), "{line}");
}

#[test]
fn light_gathers_at_rest_and_is_that_of_render() {
    let light = LightOptions { shadows: true, samples: Some(3), ..LightOptions::default() };
    let mut begin = start("colors-100");
    begin.look = Look { light, ..begin.look };
    let mut harness = window_of(std::sync::Arc::new(crate::stage::Bench), begin);
    let is_lit = |viewer: &viewer::Viewer| {
        viewer.painting().is_some_and(|painting| painting.stage == Stage::Lit(3))
    };
    until(&mut harness, is_lit);
    until_sharp(&mut harness);
    let viewer = harness.state().viewer();
    assert!(viewer.painting().expect("lit").shown.image == rendered(viewer).image);
}

#[test]
fn a_cut_is_filled_as_render_fills_it() {
    let mut harness = window("molecule");
    assert_rendered(&mut harness);
    harness.get_by_label("Cut").click();
    harness.run_steps(20);
    harness.get_all_by_label("+z").next().expect("a normal").click();
    harness.step();
    until(&mut harness, |viewer| !viewer.look().clip.is_all());
    until(&mut harness, |viewer| {
        let faces = |normal| normal == glam::Vec3::Z;
        let painting = viewer.painting();
        painting.is_some_and(|painting| painting.shown.hits.iter().any(|hit| faces(hit.normal)))
    });
    assert_rendered(&mut harness);
}

#[test]
fn radii_are_scaled_by_the_reader() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("water.xyz");
    std::fs::write(&path, "3\nwater\nO 0 0 0.12\nH 0 0.76 -0.48\nH 0 -0.76 -0.48\n")
        .expect("written");
    let path = path.display().to_string();
    let mut harness = window(&path);
    assert_rendered(&mut harness);
    harness.get_by_role_and_label(Role::Slider, "Radius scale").set_value_accesskit(0.5);
    let radius_scale = Some(0.5);
    let reading = ReadOptions { radius_scale, ..ReadOptions::default() };
    let wanted = metaball::load(&path, &reading, &Overrides::default()).expect("read").scene;
    until(&mut harness, |viewer| viewer.model().is_some_and(|model| *model.scene() == wanted));
    assert_rendered(&mut harness);
}

#[test]
fn a_column_gives_colours_and_a_legend() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("drops.csv");
    std::fs::write(&path, "x,y,z,radius,heat\n0,0,0,1,3\n1.5,0,0,1,8\n").expect("written");
    let path = path.display().to_string();
    let mut harness = window(&path);
    assert_rendered(&mut harness);
    harness.get_by_label("Colour by").focus();
    harness.step();
    harness.get_by_role_and_label(Role::TextInput, "Colour by").type_text("heat=0..10");
    harness.step();
    harness.key_press(Key::Enter);
    harness.step();
    until(&mut harness, |viewer| {
        viewer.model().is_some_and(|model| model.scene().colors().is_some())
    });
    assert_rendered(&mut harness);
    harness.get_by_label("heat");
    let viewer = harness.state().viewer();
    let line = viewer.command_line().expect("open").to_string();
    assert!(line.contains("--color-by=heat=0..10"), "{line}");
}
