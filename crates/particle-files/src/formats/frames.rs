//! The format `.frames`: frames of equal balls with positions of 16 bits, laid out as `FORMATS.md` says.

use std::io::{Read, Write};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use glam::Vec3;

use crate::error::{Flaw, LoadError};
use crate::particles::{Particles, Sizes};

const MAGIC: &[u8; 9] = b"frames16\n";

/// Bytes before the first frame: seven numbers of four.
const HEADER: usize = 28;

/// The frames of a [`.frames` file](crate#packed-balls-and-frames).
#[derive(Debug, Clone, PartialEq)]
pub struct PackedFrames {
    radius: f32,
    step: f32,
    least: Vec3,
    balls: usize,
    /// For each frame x, y and z of all balls, in steps from the least corner.
    steps: Vec<u16>,
}

/// Writes frames in the format of [`.frames` files](crate#packed-balls-and-frames). All balls have the
/// support radius; positions are rounded to multiples of `step`. Both are in scene units.
///
/// # Errors
/// When there is no frame, frames differ in their number of balls, or the box around all centres is
/// longer than 65,535 steps.
pub fn pack_frames(radius: f32, step: f32, frames: &[Vec<Vec3>]) -> Result<Vec<u8>, LoadError> {
    let refused = |needed: &str, found: String| LoadError::Parameter {
        name: "frames to pack".to_owned(),
        needed: needed.to_owned(),
        found,
    };
    let balls = frames.first().map(Vec::len).ok_or_else(|| refused("frames", "none".to_owned()))?;
    if let Some(other) = frames.iter().find(|frame| frame.len() != balls) {
        return Err(refused(&format!("{balls} balls in all"), other.len().to_string()));
    }
    let centers = || frames.iter().flatten().copied();
    let least = centers().reduce(Vec3::min).unwrap_or_default();
    let extent = centers().reduce(Vec3::max).unwrap_or_default() - least;
    let longest = f64::from(extent.max_element()) / f64::from(step);
    if !(0.0..=f64::from(u16::MAX)).contains(&longest) {
        return Err(refused("a box of up to 65535 steps", format!("{longest} steps")));
    }

    let mut plain = [frames.len() as u32, balls as u32].map(u32::to_le_bytes).concat();
    for number in [radius, step].into_iter().chain(least.to_array()) {
        plain.extend(number.to_le_bytes());
    }
    let mut before = vec![[0_u16; 2]; 3 * balls];
    for (frame, centers) in frames.iter().enumerate() {
        for axis in 0..3 {
            let column = &mut before[axis * balls..][..balls];
            let steps = centers.iter().zip(column).map(|(center, before)| {
                let away = f64::from(center[axis]) - f64::from(least[axis]);
                let steps = (away / f64::from(step)).round() as u16;
                let difference = steps.wrapping_sub(expected(frame, *before));
                *before = [steps, before[0]];
                difference.to_le_bytes()
            });
            let (low, high): (Vec<u8>, Vec<u8>) = steps.map(|[low, high]| (low, high)).unzip();
            plain.extend(low);
            plain.extend(high);
        }
    }
    Ok(compress(&plain))
}

/// Steps of a ball had it continued as between the last frame and the one before that.
fn expected(frame: usize, [last, before]: [u16; 2]) -> u16 {
    if frame < 2 { last } else { last.wrapping_add(last.wrapping_sub(before)) }
}

fn compress(plain: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(MAGIC.to_vec(), Compression::best());
    encoder.write_all(plain).and_then(|()| encoder.finish()).expect("a Vec takes all bytes")
}

impl PackedFrames {
    /// What the name of such a file ends in.
    pub(crate) const ENDING: &'static str = "frames";

    /// Reads the bytes of a `.frames` file.
    ///
    /// # Errors
    /// [`LoadError::Content`].
    pub fn parse(bytes: &[u8]) -> Result<Self, LoadError> {
        Ok(Self::content(bytes)?)
    }

    pub(crate) fn content(bytes: &[u8]) -> Result<Self, Flaw> {
        let stream = bytes
            .strip_prefix(MAGIC)
            .ok_or_else(|| Flaw::needed("the first bytes \"frames16\\n\"", "others"))?;
        let mut plain = Vec::new();
        ZlibDecoder::new(stream)
            .read_to_end(&mut plain)
            .map_err(|error| Flaw::needed("a zlib stream", error))?;

        let (header, columns) = plain
            .split_first_chunk::<HEADER>()
            .ok_or_else(|| Flaw::needed("a header of 28 bytes", plain.len()))?;
        let word = |index: usize| std::array::from_fn(|byte| header[4 * index + byte]);
        let [frames, balls] = [0, 1].map(|index| u32::from_le_bytes(word(index)) as usize);
        let [radius, step, x, y, z] = [2, 3, 4, 5, 6].map(|index| f32::from_le_bytes(word(index)));
        if frames == 0
            || balls.checked_mul(6).and_then(|n| n.checked_mul(frames)) != Some(columns.len())
        {
            let needed = format!("six bytes for each of {balls} balls in {frames} frames");
            return Err(Flaw::needed(&needed, format_args!("{} bytes", columns.len())));
        }

        let mut steps = Vec::with_capacity(columns.len() / 2);
        for (column, bytes) in columns.chunks_exact((2 * balls).max(1)).enumerate() {
            let (low, high) = bytes.split_at(balls);
            for (low, high) in low.iter().zip(high) {
                // The same ball and axis one and two frames before.
                let at = |frames: usize| {
                    steps.len().checked_sub(frames * 3 * balls).map_or(0, |index| steps[index])
                };
                let expected = expected(column / 3, [at(1), at(2)]);
                steps.push(u16::from_le_bytes([*low, *high]).wrapping_add(expected));
            }
        }
        Ok(Self { radius, step, least: Vec3::new(x, y, z), balls, steps })
    }

    /// Number of frames; none without balls.
    pub fn count(&self) -> u32 {
        (self.steps.len() / (3 * self.balls).max(1)) as u32
    }

    /// The support radius R of all balls, scene units.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The centres of a frame.
    ///
    /// # Panics
    /// When there is no frame of that number, counted from 0.
    pub fn centers(&self, number: u32) -> impl ExactSizeIterator<Item = Vec3> {
        let frame = &self.steps[number as usize * 3 * self.balls..][..3 * self.balls];
        let coordinate = move |ball: usize, axis: usize| {
            let steps = f64::from(frame[axis * self.balls + ball]);
            (f64::from(self.least[axis]) + steps * f64::from(self.step)) as f32
        };
        (0..self.balls)
            .map(move |ball| Vec3::from_array([0, 1, 2].map(|axis| coordinate(ball, axis))))
    }

    /// The balls of a frame.
    ///
    /// # Panics
    /// As [`Self::centers`].
    pub fn frame(&self, number: u32) -> Particles {
        Particles {
            positions: self.centers(number).map(Vec3::as_dvec3).collect(),
            sizes: Sizes::Support(vec![self.radius; self.balls]),
            ..Particles::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn refusals_say_what_was_needed() {
        let problem = |bytes: &[u8]| PackedFrames::content(bytes).expect_err("refused").problem;
        assert!(problem(b"").starts_with("needed the first bytes"));
        assert!(problem(b"frames16\nxxxx").starts_with("needed a zlib stream"));
        assert_eq!(problem(&compress(b"short")), "needed a header of 28 bytes, found 5");
        let mut plain = [0; HEADER];
        (plain[0], plain[4]) = (3, 2);
        let needed = "needed six bytes for each of 2 balls in 3 frames, found 0 bytes";
        assert_eq!(problem(&compress(&plain)), needed);

        let refused = |step, frames: &[Vec<Vec3>]| {
            pack_frames(1.0, step, frames).expect_err("refused").to_string()
        };
        assert!(refused(0.1, &[]).ends_with("needed frames, found none"));
        let uneven = [vec![Vec3::ZERO; 2], vec![Vec3::ZERO]];
        assert!(refused(0.1, &uneven).ends_with("needed 2 balls in all, found 1"));
        let far = [vec![Vec3::ZERO, Vec3::X]];
        assert!(refused(1e-6, &far).contains("needed a box of up to 65535 steps"));
        assert!(refused(0.0, &far).contains("found inf steps"));
    }

    proptest! {
        /// Half a step, and the roundings to f32 of the centre and of what it is compared with: twice
        /// 6e-8 of the greatest coordinate.
        #[test]
        fn centres_move_by_half_a_step(
            frames in prop::collection::vec(
                prop::array::uniform7(prop::array::uniform3(-100.0f32..100.0)), 1..6,
            ),
        ) {
            const STEP: f32 = 0.01;
            let frames: Vec<Vec<Vec3>> =
                frames.iter().map(|frame| frame.map(Vec3::from_array).to_vec()).collect();
            let bytes = pack_frames(0.5, STEP, &frames).expect("legal");
            let read = PackedFrames::content(&bytes).expect("legal");
            prop_assert_eq!(read.count() as usize, frames.len());
            for (number, centers) in frames.iter().enumerate() {
                let read_back = read.centers(number as u32);
                prop_assert_eq!(read_back.len(), centers.len());
                for (read_back, center) in read_back.zip(centers) {
                    let moved = (read_back - *center).abs().max_element();
                    prop_assert!(moved <= 0.5 * STEP + 2.0 * 6e-8 * 100.0, "{moved}");
                }
            }
        }

        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            for bytes in [&bytes, &compress(&bytes), &[MAGIC, &bytes[..]].concat()] {
                if let Ok(frames) = PackedFrames::content(bytes) {
                    (0..frames.count()).for_each(|number| drop(frames.frame(number)));
                }
            }
        }
    }
}
