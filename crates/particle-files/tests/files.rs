//! Files of one scene, through the file system.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use flate2::Compression;
use flate2::write::GzEncoder;
use glam::Vec3;
use metaball_core::Kernel;
use particle_files::{LoadError, Loaded, Overrides, load, pack_balls};

/// A folder for one test, of that name.
fn folder(test: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(test);
    fs::create_dir_all(&folder).expect("the target folder is writable");
    folder
}

fn write(folder: &str, name: &str, bytes: impl AsRef<[u8]>) -> String {
    let path = self::folder(folder).join(name);
    fs::write(&path, bytes).expect("the target folder is writable");
    path.to_str().expect("the target folder's name is text").to_owned()
}

fn packed(text: &str) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(text.as_bytes()).expect("a Vec takes all bytes");
    encoder.finish().expect("a Vec takes all bytes")
}

fn get(path: &str) -> Result<Loaded, LoadError> {
    load(path, &Overrides::default())
}

const TABLE: &str = "x,y,z,radius\n0,0,0,1\n1,0,0,1\n";

#[test]
fn a_scene_file_names_its_table_relative_to_itself() {
    write("scene-file", "pool.csv.gz", packed(TABLE));
    let text = "particles = 'pool.csv.gz'\nkernel = 'wyvill'\nthreshold = 0.5\n[camera]\n\
                eye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
    let path = write("scene-file", "pool.toml", text);
    let made = get(&path).expect("legal");
    assert_eq!(made.name, "pool.toml");
    assert_eq!((made.scene.len(), made.scene.kernel()), (2, Kernel::Wyvill));
    assert_eq!(made.camera.eye(), Vec3::new(0.0, 0.0, 5.0));
}

#[test]
fn bare_particle_files_are_scenes() {
    let table = get(&write("bare", "a.csv", TABLE)).expect("legal");
    assert_eq!((table.scene.len(), table.scene.kernel()), (2, Kernel::QUARTIC));
    let bounds = table.scene.bounds();
    assert!(!bounds.contains(table.camera.eye()), "the camera frames the balls from outside");

    let xyz = get(&write("bare", "a.xyz.gz", packed("1\n\nO 0 0 0\n"))).expect("legal");
    assert!(xyz.scene.colors().is_some());

    let frame = pack_balls(&table.scene).expect("legal");
    let read = get(&write("bare", "a.balls", frame)).expect("legal");
    assert_eq!(read.scene.supports(), table.scene.supports());
}

#[test]
fn refusals_name_the_file_that_is_at_fault() {
    let table = write("refusals", "bad.csv", "x,y,z,radius\n0,0,0,1\n0,0,0,-1\n");
    let scene = write("refusals", "scene.toml", "particles = 'bad.csv'");
    for path in [&table, &scene] {
        let expected = format!(
            "{table}, line 3: ball 1: needed a support radius from 1e-18 to 1e18, found -1"
        );
        assert_eq!(get(path).expect_err("refused").to_string(), expected);
    }

    let missing = get(&write("refusals", "missing.toml", "particles = 'nowhere.csv'"));
    let missing = missing.expect_err("refused").to_string();
    assert!(missing.starts_with("cannot read ") && missing.ends_with("nowhere.csv"), "{missing}");

    let kind = write("refusals", "kind.toml", "particles = 'scene.toml'");
    let message = get(&kind).expect_err("refused").to_string();
    assert!(message.starts_with(&format!("{kind}, particles: needed a .csv")), "{message}");

    let cut = get(&write("refusals", "cut.csv.gz", &packed(TABLE)[..20])).expect_err("refused");
    assert!(matches!(cut, LoadError::Read { .. }), "{cut}");
}

#[test]
fn what_is_no_file_of_a_scene_says_so() {
    let unknown = get("a.doc").expect_err("refused");
    assert!(matches!(unknown, LoadError::UnknownFormat { .. }));
    let endings = ".csv, .xyz, .pdb, .ent, .cif, .mmcif, .balls";
    assert!(unknown.to_string().contains(endings), "{unknown}");
    let frames = get("a.frames").expect_err("refused").to_string();
    let expected = "a.frames: needed the particles of one scene, found those of many frames";
    assert_eq!(frames, expected);
}

#[test]
fn bytes_of_a_name_are_read_as_the_file_is() {
    let parsed = particle_files::parse("a.csv.gz", &packed(TABLE)).expect("legal");
    assert_eq!(parsed.balls.len(), 2);
    let read = particle_files::read(write("bytes", "a.csv.gz", packed(TABLE))).expect("legal");
    assert_eq!((read.balls, read.lines), (parsed.balls, parsed.lines));
}
