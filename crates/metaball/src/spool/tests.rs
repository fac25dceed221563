//! What a spool keeps, and refuses.

use std::fs;
use std::ops::Range;
use std::path::PathBuf;

use glam::Vec3;
use metaball_core::{Camera, Color, Hit, Verdict};

use super::*;
use crate::summary::Tally;

const ALL: Planes = Planes { pixels: true, hits: true, light: true };

struct Folder {
    /// Removes itself.
    _folder: tempfile::TempDir,
    picture: PathBuf,
    /// The spool's.
    path: PathBuf,
}

fn folder() -> Folder {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = folder.path().join("picture.png");
    let path = folder.path().join("picture.png.spool");
    Folder { _folder: folder, picture, path }
}

fn view() -> View {
    let camera = Camera::look_at(Vec3::Z, Vec3::ZERO, Vec3::Y, 38.0).expect("legal");
    View::new(camera, 3, 40).expect("a size")
}

fn description(text: &str) -> Description {
    let json = format!("[[\"size\",\"3 × 40\"],[\"scene\",\"{text}\"]]");
    Description::from_json(json.as_bytes()).expect("a description")
}

fn open(picture: &Path, text: &str, resume: bool) -> Result<Spool, Error> {
    Spool::open(picture, &view(), ALL, &description(text), resume)
}

/// Every kind of hit.
fn hits(count: u16) -> Vec<Hit> {
    let verdicts = [Verdict::Hit, Verdict::Miss, Verdict::Inside, Verdict::Undecided];
    let hit = |index: u16| Hit {
        verdict: verdicts[usize::from(index % 4)],
        fallback: index.is_multiple_of(3),
        t: if index % 4 == 1 { f32::INFINITY } else { f32::from(index) + 0.1 },
        normal: Vec3::new(f32::from(index), -0.0, 1.0),
    };
    (0..count).map(hit).collect()
}

fn band(rows: Range<u32>, planes: Planes) -> Band {
    let pixels = 3 * rows.len() as u16;
    let kept = |kept| if kept { pixels } else { 0 };
    let hits = hits(kept(planes.hits));
    Band {
        pixels: (0..kept(planes.pixels)).map(|i| Color::srgb(i as u8, 1, 2)).collect(),
        light: (0..kept(planes.light)).map(|i| Vec3::splat(f32::from(i) * 0.3)).collect(),
        tally: Tally { undecided_light: 7, ..Tally::of(&hits) },
        hits,
        rows,
    }
}

fn read(spool: &Spool) -> Vec<Band> {
    spool.bands().collect::<Result<_, _>>().expect("readable")
}

#[test]
fn bands_come_back_with_all_their_bits() {
    for planes in [ALL, Planes { light: false, ..ALL }, Planes { pixels: false, ..ALL }] {
        let folder = folder();
        let bands = [band(0..16, planes), band(16..40, planes)];
        let open = |resume| {
            let text = description("a");
            Spool::open(&folder.picture, &view(), planes, &text, resume)
        };
        let mut spool = open(false).expect("begun");
        for band in &bands {
            spool.append(band).expect("written");
        }
        assert_eq!(read(&spool), bands);
        drop(spool);
        let spool = open(true).expect("resumed");
        assert_eq!((spool.rows(), read(&spool)), (40, bands.to_vec()));
        spool.remove().expect("removed");
        assert!(!folder.path.exists());
    }
}

#[test]
fn what_is_not_whole_is_written_anew() {
    let folder = folder();
    let mut spool = open(&folder.picture, "a", false).expect("begun");
    let first = band(0..16, ALL);
    spool.append(&first).expect("written");
    let whole = spool.end as usize;
    spool.append(&band(16..32, ALL)).expect("written");
    drop(spool);
    let bytes = fs::read(&folder.path).expect("readable");

    let mut flipped = bytes.clone();
    flipped[whole + 200] ^= 1;
    let cuts = [whole, whole + 1, whole + 100, bytes.len() - 1];
    let broken = cuts.into_iter().map(|length| bytes[..length].to_vec()).chain([flipped]);
    for broken in broken {
        fs::write(&folder.path, &broken).expect("written");
        let mut spool = open(&folder.picture, "a", true).expect("resumed");
        assert_eq!((spool.rows(), read(&spool)), (16, vec![first.clone()]));
        spool.append(&band(16..32, ALL)).expect("written");
        drop(spool);
        assert!(fs::read(&folder.path).expect("readable") == bytes);
    }
    for length in [0, 16, 20, 30] {
        fs::write(&folder.path, &bytes[..length]).expect("written");
        assert_eq!(open(&folder.picture, "a", true).expect("begun").rows(), 0, "{length} bytes");
    }
}

#[test]
fn a_spool_that_is_of_use_is_kept() {
    let folder = folder();
    let error =
        |text, resume| open(&folder.picture, text, resume).expect_err("refused").to_string();
    let mut spool = open(&folder.picture, "a", false).expect("begun");
    assert!(error("a", true).ends_with("found it in use by another"));
    drop(spool);
    spool = open(&folder.picture, "a", false).expect("nothing is lost");
    spool.append(&band(0..16, ALL)).expect("written");
    drop(spool);
    assert!(error("a", false).contains("16 of 40 rows"));
    let other = error("b", true);
    assert!(other.contains("needed the scene of this picture, b, found a"), "{other}");
    assert_eq!(open(&folder.picture, "b", false).expect("begun anew").rows(), 0);

    fs::write(&folder.path, "my own notes").expect("written");
    assert!(error("a", false).ends_with("found another file"));
    assert_eq!(fs::read(&folder.path).expect("readable"), b"my own notes");
}
