//! Scenes that move, as users get them.

use std::fs;
use std::path::{Path, PathBuf};

use bench_scenes::{FRAME_RATE, LoadError, Moving, Overrides, load, moving};
use glam::Vec3;
use metaball_core::{Kernel, Scene};

fn get(spec: &str) -> Result<Moving, LoadError> {
    Moving::load(spec, &Overrides::default())
}

/// An empty folder for one test, of that name.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target folder is writable");
    folder
}

/// The farthest that a ball goes from one scene to the other.
fn farthest(one: &Scene, other: &Scene) -> f32 {
    assert_eq!(one.len(), other.len());
    let pairs = one.supports().iter().zip(other.supports());
    pairs.map(|(one, other)| one.center.distance(other.center)).fold(0.0, f32::max)
}

#[test]
fn named_scenes_move_and_frames_are_independent() {
    for (name, _) in moving().iter().filter(|(name, _)| *name != "tornado-128k") {
        let moving = get(name).expect("known");
        let later = moving.frame(7).expect("drawn");
        let first = moving.frame(0).expect("drawn");
        assert!(farthest(&first, &later) > 0.0, "{name} stands still");
        let again = get(name).expect("known");
        assert_eq!(again.frame(7).expect("drawn"), later, "{name}");
        assert_eq!(again.camera, moving.camera);
    }
}

#[test]
fn frame_0_is_the_still_scene() {
    for spec in ["tornado:500", "fountain:500", "molecule"] {
        let still = load(spec, &Overrides::default()).expect("known").scene;
        assert_eq!(get(spec).expect("moves").frame(0).expect("drawn"), still, "{spec}");
    }
}

/// The motion has a period of 96 frames, in the second half of which all goes the other way.
///
/// Coordinates are below 128 Å, so each of the additions of three modes in two frames rounds by at most
/// half of 2⁻¹⁷ Å.
#[test]
fn the_molecules_motion_is_periodic() {
    const ROUNDING: f32 = 6.0 * 0.5 / 131_072.0;
    let molecule = get("molecule").expect("known");
    let frame = |number| molecule.frame(number).expect("drawn");
    let rest = frame(0);
    assert_eq!(rest, frame(96));
    assert!(rest.supports().iter().all(|ball| ball.center.abs().max_element() + 10.0 < 128.0));
    let lopsided = |one: &Scene, other: &Scene| {
        let pairs = one.supports().iter().zip(other.supports());
        let middles = pairs.map(|(one, other)| 0.5 * (one.center + other.center));
        let off = middles.zip(rest.supports());
        off.map(|(middle, ball)| (middle - ball.center).abs().max_element()).fold(0.0, f32::max)
    };
    for number in [1, 24, 31] {
        let (away, back) = (frame(number), frame(96 - number));
        assert!(lopsided(&away, &back) <= ROUNDING, "frame {number}: {}", lopsided(&away, &back));
        assert!(lopsided(&away, &away) > ROUNDING, "frame {number}: at rest");
    }
}

/// Walls hold the water.
#[test]
fn the_splash_stays_in_its_tank() {
    let splash = get("splash").expect("known");
    assert_eq!(splash.frames, 0..48);
    for number in [0, 10, 20, 47] {
        let frame = splash.frame(number).expect("drawn");
        for ball in frame.supports() {
            let inside = Vec3::ZERO.cmple(ball.center).all() && ball.center.x <= 1.632;
            assert!(inside && ball.center.z <= 0.912, "frame {number}: {}", ball.center);
        }
    }
    let error = splash.frame(48).expect_err("the last is 47").to_string();
    assert_eq!(error, "frame: needed a number below 48, found 48");
}

/// What no water can do: rise as a whole above where it was at rest, or fall faster than freely. A
/// centre is rounded by at most half a step of 1/4096 m.
#[test]
fn the_splash_obeys_gravity() {
    const STEP: f64 = 1.0 / 4096.0;
    let fall = 9.81 / f64::from(FRAME_RATE).powi(2);
    let splash = get("splash").expect("known");
    let height = |number| {
        let frame = splash.frame(number).expect("drawn");
        let heights = frame.supports().iter().map(|ball| f64::from(ball.center.y));
        heights.sum::<f64>() / frame.len() as f64
    };
    let obeys = |heights: &[f64]| {
        let rises = heights.iter().any(|height| *height > heights[0] + STEP);
        let drops = heights.windows(3).any(|of| of[0] - 2.0 * of[1] + of[2] < -fall - 2.0 * STEP);
        !rises && !drops
    };
    let mut heights: Vec<f64> = splash.frames.clone().map(height).collect();
    assert!(obeys(&heights), "{heights:?}");
    let faster: Vec<f64> = heights.iter().step_by(2).copied().collect();
    assert!(!obeys(&faster), "a film at twice its speed");
    heights.reverse();
    assert!(!obeys(&heights), "a film run backwards");
}

#[test]
fn numbered_files_move() {
    let folder = folder("numbered");
    for number in [3, 5, 8] {
        let table = format!("x,y,z,radius\n{number},0,0,1\n");
        fs::write(folder.join(format!("p-{number:03}.csv")), table).expect("writable");
    }
    let files = folder.join("p-%03d.csv").display().to_string();
    let wyvill = Overrides { kernel: Some(Kernel::Wyvill), ..Overrides::default() };
    let moving = Moving::load(&files, &wyvill).expect("legal");
    assert_eq!((moving.name.as_str(), moving.frames.clone()), (files.as_str(), 3..9));
    assert_eq!(moving.present(0..6).expect("a folder"), [3, 5]);
    let frame = moving.frame(5).expect("a file");
    assert_eq!(frame.supports()[0].center, Vec3::new(5.0, 0.0, 0.0));
    assert_eq!(frame.kernel(), Kernel::Wyvill);
}

#[test]
fn what_does_not_move_says_what_does() {
    for spec in ["scattered:500", "dam-break", "nosuch"] {
        let message = get(spec).expect_err("still").to_string();
        assert!(message.contains("does not move. Needed one of"), "{message}");
        assert!(message.contains("molecule, splash") && message.contains("tornado, fountain"));
    }
    let folder = folder("none");
    let single = folder.join("p.csv");
    fs::write(&single, "x,y,z\n0,0,0\n").expect("writable");
    let message = get(&single.display().to_string()).expect_err("one frame").to_string();
    assert!(message.contains("needed a particle file for each frame"), "{message}");
    let message = get(&folder.join("%d.xyz").display().to_string()).expect_err("none").to_string();
    assert!(message.ends_with("needed at least one file of this name, found none"), "{message}");
}
