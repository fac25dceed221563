//! Sequences of files, through the file system.

use std::fs;
use std::path::{Path, PathBuf};

use glam::Vec3;
use metaball_core::Kernel;
use particle_files::{LoadError, Overrides, ReadOptions, Sequence, pack_frames};

fn get(path: impl AsRef<Path>) -> Result<Sequence, LoadError> {
    Sequence::open(path, &ReadOptions::default(), &Overrides::default())
}

/// An empty folder for one test, of that name.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target folder is writable");
    folder
}

#[test]
fn numbered_files_are_frames() {
    let folder = folder("numbered");
    for number in [3, 5, 8] {
        let table = format!("x,y,z,support_radius\n{number},0,0,1\n");
        fs::write(folder.join(format!("p-{number:03}.csv")), table).expect("writable");
    }
    let sequence = get(folder.join("p-%03d.csv")).expect("legal");
    assert_eq!(sequence.frames(), 3..9);
    assert_eq!(sequence.present(0..6).expect("a folder"), [3, 5]);
    assert_eq!(sequence.frame(5).expect("a file").supports()[0].center, Vec3::new(5.0, 0.0, 0.0));
    let missing = sequence.frame(4).expect_err("no file").to_string();
    assert!(missing.starts_with("cannot read ") && missing.ends_with("p-004.csv"), "{missing}");
    fs::write(folder.join("p-005.csv"), "x,y,z,support_radius\n0,0,0,much\n").expect("writable");
    let broken = sequence.frame(5).expect_err("no number").to_string();
    assert!(broken.contains("p-005.csv, line 2"), "{broken}");

    let text = "particles = 'p-%03d.csv'\nkernel = 'wyvill'\nthreshold = 0.5\n[camera]\n\
                eye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
    let file = folder.join("scene.toml");
    fs::write(&file, text).expect("writable");
    let sequence = get(file).expect("legal");
    assert_eq!(sequence.camera().eye(), Vec3::new(0.0, 0.0, 5.0));
    assert_eq!(sequence.frame(3).expect("a file").kernel(), Kernel::Wyvill);
}

#[test]
fn frames_without_radii_have_that_of_the_first() {
    let folder = folder("spaced");
    let write = |number: u32, spacing: u32| {
        let table = format!("3\n\nbead 0 0 0\nbead {spacing} 0 0\nbead {} 0 0\n", 2 * spacing);
        fs::write(folder.join(format!("p{number}.xyz")), table).expect("writable");
    };
    write(2, 3);
    write(3, 5);
    let text = "particles = 'p%d.xyz'\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
    fs::write(folder.join("scene.toml"), text).expect("writable");
    let radius = |number| {
        let sequence = get(folder.join("scene.toml")).expect("legal");
        sequence.frame(number).expect("a file").supports()[0].radius
    };
    assert_eq!([2, 3].map(radius), [6.0, 6.0], "twice the spacing in the first");
    fs::write(folder.join("p1.xyz"), "broken").expect("writable");
    assert_eq!([2, 3].map(radius), [6.0, 6.0], "the first that can be read");
    write(1, 5);
    assert_eq!([2, 3].map(radius), [10.0, 10.0]);
    // What says its radius keeps it.
    let own = "1\nProperties=pos:R:3:radius:R:1\n0 0 0 0.5\n";
    fs::write(folder.join("p4.xyz"), own).expect("writable");
    assert_eq!(radius(4), 0.5 * std::f32::consts::SQRT_2);
}

#[test]
fn packed_frames_are_a_sequence() {
    let file = folder("packed").join("a.frames");
    let frames = [vec![Vec3::ZERO], vec![Vec3::X]];
    fs::write(&file, pack_frames(0.5, 0.25, &frames).expect("legal")).expect("writable");
    let sequence = get(&file).expect("legal");
    assert_eq!(sequence.frames(), 0..2);
    assert_eq!(sequence.present(1..7).expect("no folder"), [1]);
    assert_eq!(sequence.frame(1).expect("there").supports()[0].center, Vec3::X);
    let missing = sequence.frame(2).expect_err("the last is 1").to_string();
    assert_eq!(missing, "frame: needed a number below 2, found 2");
}

#[test]
fn a_single_scene_is_no_sequence() {
    let folder = folder("single");
    let (table, scene) = (folder.join("p.csv"), folder.join("scene.toml"));
    fs::write(&table, "x,y,z\n0,0,0\n").expect("writable");
    fs::write(&scene, "particles = 'p.csv'").expect("writable");
    for single in [&table, &scene] {
        let error = get(single).expect_err("one scene");
        assert!(matches!(error, LoadError::NotASequence { .. }), "{error}");
    }
    let none = get(folder.join("%d.xyz")).expect_err("none").to_string();
    assert!(none.ends_with("needed at least one file of this name, found none"), "{none}");
}

#[test]
fn one_file_holds_many_frames() {
    let file = folder("many").join("many.xyz");
    let frame = |x: u32| format!("2\n\nbead {x} 0 0\nbead {x} 0 3\n");
    fs::write(&file, [frame(0), frame(1), frame(2)].concat()).expect("writable");
    let sequence = get(&file).expect("legal");
    assert_eq!((sequence.frames(), sequence.present(1..7).expect("no folder")), (0..3, vec![1, 2]));
    let second = sequence.frame(1).expect("there").supports()[0];
    assert_eq!((second.center, second.radius), (Vec3::X, 6.0));
    assert!(sequence.frame(3).expect_err("the last is 2").to_string().contains("from 0 to 2"));
    let options = ReadOptions { frame: Some(1), ..ReadOptions::default() };
    let alone = particle_files::load(&file, &options, &Overrides::default()).expect("legal");
    assert_eq!(alone.scene.supports()[0].center, Vec3::X);
}
