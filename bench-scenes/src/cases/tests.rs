//! What cases promise of their scenes.

use glam::DVec3;
use metaball_core::{Kernel, Metaball, Scene};

use super::*;

fn field(scene: &Scene, point: DVec3) -> f64 {
    let ball = |ball: Metaball| {
        let squared = point.distance_squared(ball.center.as_dvec3());
        let radius = f64::from(ball.radius);
        f64::from(ball.strength) * scene.kernel().value(squared / (radius * radius))
    };
    scene.balls().map(ball).sum()
}

fn case(name: &str) -> &'static Case {
    cases().iter().find(|case| case.name == name).expect("a case of that name")
}

#[test]
fn every_value_makes_a_scene() {
    for case in cases() {
        assert!(case.values.len() >= 4, "{}: too few values to see a limit", case.name);
        for &value in case.values {
            let made = case.view(value);
            assert!(made.is_ok(), "{} at {value}: {made:?}", case.name);
        }
    }
}

#[test]
fn names_are_unique() {
    let mut names: Vec<_> = cases().iter().map(|case| case.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), cases().len());
}

#[test]
fn impossible_values_are_refused() {
    assert!(case("scale").scene(f64::NAN).is_err());
    assert!(case("threshold-near-zero").scene(-1.0).is_err());
    assert!(case("wide-lens").scene(180.0).is_err());
}

/// The axis passes the ball at its silhouette, up to the rounding of the eye to f32, 6e-8; the top
/// of the picture is as far above it as the value says, to a few roundings of the lens.
#[test]
fn grazing_is_as_near_as_it_says() {
    for &value in case("grazing").values {
        let (_, view) = case("grazing").view(value).expect("legal");
        let camera = view.camera();
        let core = Kernel::QUARTIC.ratio_at(0.25).expect("taken");
        assert!((f64::from(camera.eye().x) - core).abs() < 1.2e-7);
        assert!((3.0 * f64::from(camera.half_height()) / value - 1.0).abs() < 1e-6);
        assert_eq!((view.width() % 2, view.height() % 2), (1, 1));
    }
}

#[test]
fn quick_values_are_values() {
    for case in cases() {
        assert!(!case.quick.is_empty(), "{}", case.name);
        for value in case.quick {
            assert!(case.values.contains(value), "{} at {value}", case.name);
        }
    }
}

#[test]
fn cases_are_sorted_by_category() {
    assert!(cases().windows(2).all(|pair| pair[0].category <= pair[1].category));
}

/// On the axis the surface of a ball alone is as far from the rim of the other's support as the value says, to
/// the rounding of the centres to f32.
#[test]
fn kinks_are_as_near_surfaces_as_they_say() {
    for &value in case("kink").values {
        let scene = case("kink").scene(value).expect("legal").scene;
        let [left, right] = [0, 1].map(|ball| scene.ball(ball));
        let core = scene.kernel().core_radius(&left, scene.threshold()).expect("it shows");
        let gap = f64::from(right.center.x - left.center.x) - core - f64::from(right.radius);
        assert!((gap - value).abs() < 2.5e-7, "{gap} for {value}");
        assert!(scene.kernel().has_kink());
    }
}

/// The roundings of centres and T to f32, 6e-8 each, times slopes up to 4.
#[test]
fn necks_and_sheets_are_as_thin_as_they_say() {
    let middle = DVec3::new(0.6, 0.6, 0.0);
    for (name, point) in [("neck", DVec3::ZERO), ("sheet", middle), ("carved", DVec3::ZERO)] {
        for &value in case(name).values {
            let scene = case(name).scene(value).expect("legal").scene;
            let found = field(&scene, point) / f64::from(scene.threshold()) - 1.0;
            assert!((found - value).abs() < 1e-6, "{name} at {value}: {found}");
        }
    }
}

/// What stands before the surface or around it must not be a surface itself.
#[test]
fn weak_balls_stay_below_the_threshold() {
    let veiled = case("veiled").scene(65.0).expect("legal");
    for step in 0..640 {
        let point = DVec3::new(0.0, 0.0, 0.1 * f64::from(step) + 0.1);
        assert!(field(&veiled.scene, point) < 0.2);
    }
    for &value in case("behind-the-eye").values {
        let made = case("behind-the-eye").scene(value).expect("legal");
        assert!(field(&made.scene, DVec3::ZERO) < 0.25);
    }
}
