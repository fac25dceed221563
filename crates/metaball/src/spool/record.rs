//! A band as bytes: its [`Head`], then its planes one after the other: pixels, hits, light.

use std::hash::{DefaultHasher, Hasher};
use std::io::{self, Read};
use std::time::Duration;

use bytemuck::{Pod, Zeroable, bytes_of, bytes_of_mut, cast_slice, pod_collect_to_vec};
use glam::Vec3;
use metaball_core::{Color, Hit, Verdict};

use crate::band::{Band, Planes};
use crate::summary::Tally;

/// A band but for its planes.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Head {
    /// First row, and the row after the last.
    rows: [u64; 2],
    /// Hits, misses, inside, undecided, undecided of light.
    rays: [u64; 5],
    /// Nanoseconds for the frame and for light.
    times: [u64; 2],
    /// Of all above and the planes.
    hash: u64,
}

/// A hit with all its bits.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct StoredHit {
    t: f32,
    normal: Vec3,
    /// The verdict's number, plus [`FALLBACK`].
    status: u32,
}

/// Marks a fallback.
const FALLBACK: u32 = 1 << 8;

/// The bytes of a band.
pub(super) fn encode(band: &Band, planes: Planes) -> Vec<u8> {
    let mut stored = Vec::new();
    if planes.pixels {
        stored.extend_from_slice(cast_slice(&band.pixels));
    }
    if planes.hits {
        let hits: Vec<StoredHit> = band.hits.iter().map(store).collect();
        stored.extend_from_slice(cast_slice(&hits));
    }
    if planes.light {
        stored.extend_from_slice(cast_slice(&band.light));
    }
    let mut head = Head::new(band);
    head.hash = head.hash_with(&stored);
    [bytes_of(&head), &stored].concat()
}

/// The band of a picture of this size that a file goes on with, and the number of its bytes.
///
/// # Errors
/// When they cannot be read, or are not as they were written.
pub(super) fn read(
    mut file: impl Read,
    (width, height): (u32, u32),
    planes: Planes,
) -> io::Result<(Band, u64)> {
    let broken = || io::Error::new(io::ErrorKind::InvalidData, "the band is not as it was written");
    let mut head = Head::zeroed();
    file.read_exact(bytes_of_mut(&mut head))?;
    let [first, end] = head.rows;
    if first >= end || end > height.into() {
        return Err(broken());
    }
    let pixels = (end - first) as usize * width as usize;
    let bytes = |kept, of_a_pixel: usize| if kept { pixels * of_a_pixel } else { 0 };
    let colors = bytes(planes.pixels, size_of::<Color>());
    let hits = bytes(planes.hits, size_of::<StoredHit>());
    let light = bytes(planes.light, size_of::<Vec3>());
    let mut stored = vec![0; colors + hits + light];
    file.read_exact(&mut stored)?;
    if head.hash_with(&stored) != head.hash {
        return Err(broken());
    }
    let (colors, stored_below) = stored.split_at(colors);
    let (hits, light) = stored_below.split_at(hits);
    let hits: Vec<StoredHit> = pod_collect_to_vec(hits);
    let band = Band {
        rows: first as u32..end as u32,
        pixels: pod_collect_to_vec(colors),
        hits: hits.into_iter().map(restore).collect(),
        light: pod_collect_to_vec(light),
        tally: head.tally(),
    };
    Ok((band, (size_of::<Head>() + stored.len()) as u64))
}

impl Head {
    /// Without its hash.
    fn new(band: &Band) -> Self {
        let Band { rows, tally, .. } = band;
        let nanoseconds = |time: Duration| u64::try_from(time.as_nanos()).unwrap_or(u64::MAX);
        Self {
            rows: [rows.start, rows.end].map(u64::from),
            rays: [tally.hits, tally.misses, tally.inside, tally.undecided, tally.undecided_light],
            times: [tally.frame, tally.light].map(nanoseconds),
            hash: 0,
        }
    }

    fn tally(&self) -> Tally {
        let [hits, misses, inside, undecided, undecided_light] = self.rays;
        let [frame, light] = self.times.map(Duration::from_nanos);
        Tally { hits, misses, inside, undecided, undecided_light, asked_again: 0, frame, light }
    }

    fn hash_with(&self, stored: &[u8]) -> u64 {
        let mut hasher = DefaultHasher::new();
        hasher.write(bytes_of(&Self { hash: 0, ..*self }));
        hasher.write(stored);
        hasher.finish()
    }
}

fn store(hit: &Hit) -> StoredHit {
    let fallback = if hit.fallback { FALLBACK } else { 0 };
    StoredHit { t: hit.t, normal: hit.normal, status: hit.verdict as u32 | fallback }
}

fn restore(hit: StoredHit) -> Hit {
    let verdicts = [Verdict::Miss, Verdict::Hit, Verdict::Inside];
    let verdict = verdicts.into_iter().find(|verdict| *verdict as u32 == hit.status & !FALLBACK);
    Hit {
        verdict: verdict.unwrap_or(Verdict::Undecided),
        fallback: hit.status & FALLBACK != 0,
        t: hit.t,
        normal: hit.normal,
    }
}
