//! Files of one scene, through the file system.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use flate2::Compression;
use flate2::write::GzEncoder;
use glam::{DVec3, Vec3};
use metaball_core::Kernel;
use particle_files::{LoadError, Loaded, Overrides, ReadOptions, load, pack_balls, parse, read};

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
    load(path, &ReadOptions::default(), &Overrides::default())
}

const TABLE: &str = "x,y,z,support_radius\n0,0,0,1\n1,0,0,1\n";

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
    let table = write("refusals", "bad.csv", "x,y,z,support_radius\n0,0,0,1\n0,0,0,-1\n");
    let scene = write("refusals", "scene.toml", "particles = 'bad.csv'");
    for path in [&table, &scene] {
        let expected =
            format!("{table}, line 3, support_radius: needed a finite number above 0, found -1");
        assert_eq!(get(path).expect_err("refused").to_string(), expected);
    }

    let missing = get(&write("refusals", "missing.toml", "particles = 'nowhere.csv'"));
    let missing = missing.expect_err("refused").to_string();
    assert!(missing.starts_with("cannot read ") && missing.ends_with("nowhere.csv"), "{missing}");

    let kind = write("refusals", "kind.toml", "particles = 'scene.toml'");
    let message = get(&kind).expect_err("refused").to_string();
    assert!(
        message.starts_with(&format!("{kind}, particles: needed a file of particles")),
        "{message}"
    );

    let cut = get(&write("refusals", "cut.csv.gz", &packed(TABLE)[..20])).expect_err("refused");
    assert!(matches!(cut, LoadError::Read { .. }), "{cut}");
}

#[test]
fn what_is_no_file_of_a_scene_says_so() {
    let unknown =
        get(&write("unknown", "a.doc", "Dear all,\nno particles here\n")).expect_err("refused");
    assert!(matches!(unknown, LoadError::UnknownFormat { .. }), "{unknown}");
    assert!(
        unknown.to_string().contains("found text that starts with \"Dear all,\"; convert it"),
        "{unknown}"
    );
    let frames = get("a.frames").expect_err("refused").to_string();
    let expected = "a.frames: needed the particles of one scene, found those of many frames";
    assert_eq!(frames, expected);
}

#[test]
fn bytes_of_a_name_are_read_as_the_file_is() {
    let options = ReadOptions::default();
    let parsed = parse("a.csv.gz", &packed(TABLE), &options).expect("legal");
    assert_eq!(parsed.len(), 2);
    let read = read(write("bytes", "a.csv.gz", packed(TABLE)), &options).expect("legal");
    assert_eq!((read.positions, read.lines), (parsed.positions, parsed.lines));
}

/// Neither a wrong ending, nor packing, nor an encoding changes what is read.
#[test]
fn content_decides() {
    let utf16: Vec<u8> =
        format!("\u{feff}{TABLE}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let zstd: Vec<u8> = {
        // A frame of one raw block: magic, one segment with its size in a byte, the block's header.
        let size = TABLE.len() as u32;
        let block = (size << 3 | 1).to_le_bytes();
        [&[0x28, 0xb5, 0x2f, 0xfd, 0x20, size as u8], &block[..3], TABLE.as_bytes()].concat()
    };
    let expected = get(&write("content", "a.csv", TABLE)).expect("legal");
    for (name, bytes) in [
        ("a.pdb", TABLE.into()),
        ("a", TABLE.into()),
        ("a.xyz", packed(TABLE)),
        ("b.csv", utf16),
        ("c.csv", zstd),
        ("d.csv", TABLE.replace('\n', "\r").into()),
    ] {
        let made = get(&write("content", name, bytes)).expect(name);
        assert_eq!(made.scene, expected.scene, "{name}");
    }
}

/// What a load says is on record: the format, how many, and where radii came from.
#[test]
fn every_load_says_what_it_read() {
    let said = |name: &str, text: &str| -> String {
        let loaded = get(&write("notes", name, text)).expect("legal");
        loaded.notes.iter().map(|note| format!("{note}\n")).collect()
    };
    let table = said("a.csv", "x,y,z,radius,mass\n0,0,0,1,5\n");
    for part in ["CSV", "1 particle", "each alone shows at its radius", "not used: mass"] {
        assert!(table.contains(part), "{part} is not in {table}");
    }
    let frames = said("a.dat", "2\n\nO 0 0 0\nH 0 0 1\n1\n\nO 0 0 0\n");
    for part in ["XYZ by its content", "1 frame after the first", "molecule", "van der Waals"] {
        assert!(frames.contains(part), "{part} is not in {frames}");
    }
    let types = said("t.xyz", "2\n\n1 0 0 0\n2 0 0 3\n");
    assert!(types.contains("types, not elements") && types.contains("support radius 6"), "{types}");
}

#[test]
fn coordinates_far_from_the_origin_are_kept() {
    let table = "x,y,z,support_radius\n510000.25,5460000.5,100,1\n510001.5,5460000.75,100,1\n";
    let loaded = get(&write("far", "utm.csv", table)).expect("legal");
    let at =
        |index: usize| loaded.scene.origin() + loaded.scene.supports()[index].center.as_dvec3();
    assert_eq!(at(0), DVec3::new(510_000.25, 5_460_000.5, 100.0));
    assert_eq!(at(1), DVec3::new(510_001.5, 5_460_000.75, 100.0));
    let near = get(&write("far", "near.csv", TABLE)).expect("legal");
    assert_eq!(near.scene.origin(), DVec3::ZERO);
}
