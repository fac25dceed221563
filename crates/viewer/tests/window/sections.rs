//! All of the panel, at both sizes of words and in both themes. The harness refuses words whose letters
//! no font has.

use eframe::egui::{Role, Theme, Vec2};
use egui_kittest::kittest::Queryable;

use crate::stage::{until_sharp, window};

#[test]
fn every_section_opens() {
    for (scale, theme) in [(1.0, Theme::Dark), (2.0, Theme::Light)] {
        let mut harness = window("colors-100");
        harness.ctx.set_theme(theme);
        harness.set_pixels_per_point(scale);
        harness.set_size(Vec2::new(640.0, 2000.0));
        harness.step();
        until_sharp(&mut harness);
        for (section, widget) in [
            ("Light", "Ambient occlusion"),
            ("Cut", "toward the eye"),
            ("Truth", "Hold against the reference"),
            ("Camera", "Copy as flags"),
            ("Picture", "Copy command"),
            ("Keys", "Arrows"),
        ] {
            assert!(harness.query_by_label(widget).is_none());
            harness.get_by_role_and_label(Role::DisclosureTriangle, section).click_accesskit();
            harness.run_steps(20);
            assert!(harness.query_by_label(widget).is_some(), "{section} at {scale}");
        }
        harness.get_by_label("Shadows").click_accesskit();
        harness.run_steps(3);
        assert!(harness.state().viewer().look().light.shadows);
        assert_eq!(harness.state().viewer().look().light.samples, Some(64));
        let line = harness.state().viewer().command_line().expect("open").to_string();
        assert!(line.contains("--shadows --samples=64"), "{line}");
    }
}
