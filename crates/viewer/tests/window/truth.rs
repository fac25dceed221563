//! The picture held against the reference.

use eframe::egui::Vec2;
use egui_kittest::kittest::Queryable;
use fbvh::Kind;
use harness::score::Judgement;
use metaball_core::reference::Oracle;
use viewer::{Verdicts, Window};

use crate::stage::{until, until_it, until_sharp, window};

#[test]
fn the_certified_tree_is_never_wrong_and_a_published_one_is() {
    let mut harness = window("two-merging");
    // High enough for the section to be seen.
    harness.set_size(Vec2::new(700.0, 1000.0));
    harness.step();
    until_sharp(&mut harness);
    for kind in [Kind::Certified, Kind::Fitted] {
        harness.state_mut().viewer_mut().set_kind(kind);
        until(&mut harness, |viewer| {
            viewer.model().is_some_and(|model| model.method().name() == kind.name())
        });
        until_sharp(&mut harness);
        if kind == Kind::Certified {
            harness.get_by_label("Truth").click();
            harness.run_steps(20);
        }
        harness.get_by_label("Hold against the reference").click();
        harness.step();
        let verdicts = |window: &Window| window.judge().verdicts().map(Verdicts::progress);
        until_it(&mut harness, |window| verdicts(window).is_some_and(|progress| progress >= 1.0));
        let window = harness.state();
        let (painting, verdicts) =
            (window.viewer().painting().expect("sharp"), window.judge().verdicts());
        let verdicts = verdicts.expect("judged");
        let truths = Oracle::new(painting.model.scene()).first_hits(&painting.view.rays());
        let wanted: Vec<_> = truths
            .iter()
            .zip(&painting.shown.hits)
            .map(|(truth, hit)| Judgement::new(truth, hit))
            .collect();
        assert!(verdicts.judgements == wanted);
        let wrong = wanted.iter().filter(|judgement| judgement.is_wrong()).count();
        assert_eq!(verdicts.wrong(), wrong);
        assert_eq!(wrong > 20, kind == Kind::Fitted, "{wrong} of {}", kind.name());
        assert!(verdicts.largest_error > 0.0 && verdicts.largest_error < 1e-3);
    }
    harness.key_press(eframe::egui::Key::X);
    harness.step();
    until_sharp(&mut harness);
    assert!(harness.state().judge().verdicts().is_none(), "of another picture");
}
