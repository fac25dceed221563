//! The format `.balls`: equal balls with positions of 16 bits, laid out as `FORMATS.md` says.

use std::io::{Read, Write};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use glam::{DVec3, Vec3};
use metaball_core::Scene;

use super::{Reader, Request, Span};
use crate::error::{Flaw, LoadError};
use crate::notes::Notes;
use crate::table::{Table, Values};

pub(super) const READER: Reader = Reader {
    name: "balls16",
    endings: &["balls"],
    is_text: false,
    recognizes: |bytes| bytes.starts_with(MAGIC),
    frames: |bytes| Ok(vec![Span::whole(bytes)]),
    table: |bytes: &[u8], _: &Span, _: &Request, _: &mut Notes| parse(bytes),
};

const MAGIC: &[u8; 8] = b"balls16\n";

/// Writes a scene's balls in the format of [`.balls` files](crate#packed-balls-and-frames).
///
/// # Errors
/// When radii differ, or the scene has strengths or colours: the format does not hold them.
pub fn pack_balls(scene: &Scene) -> Result<Vec<u8>, LoadError> {
    let refused = |found: &str| LoadError::Parameter {
        name: "balls to pack".to_owned(),
        needed: "balls of one radius, without strengths or colours".to_owned(),
        found: found.to_owned(),
    };
    let radius = scene.supports().first().map_or(1.0, |support| support.radius);
    if scene.supports().iter().any(|support| support.radius != radius) {
        return Err(refused("several radii"));
    }
    if scene.strengths().is_some() || scene.colors().is_some() {
        return Err(refused("strengths or colours"));
    }

    let centers = || scene.supports().iter().map(|support| support.center);
    let least = centers().reduce(Vec3::min).unwrap_or_default();
    let greatest = centers().reduce(Vec3::max).unwrap_or_default();
    let step = ((greatest.as_dvec3() - least.as_dvec3()) / f64::from(u16::MAX)).as_vec3();

    let mut plain = (scene.len() as u32).to_le_bytes().to_vec();
    for number in [radius].into_iter().chain(least.to_array()).chain(step.to_array()) {
        plain.extend(number.to_le_bytes());
    }
    for axis in 0..3 {
        let mut before = 0_u16;
        for center in centers() {
            let steps = (f64::from(center[axis]) - f64::from(least[axis])) / f64::from(step[axis]);
            // A flat box has no step: 0/0 is NaN and becomes 0.
            let steps = steps.round() as u16;
            plain.extend(steps.wrapping_sub(before).to_le_bytes());
            before = steps;
        }
    }
    Ok(compress(&plain))
}

fn compress(plain: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(MAGIC.to_vec(), Compression::best());
    encoder.write_all(plain).and_then(|()| encoder.finish()).expect("a Vec takes all bytes")
}

/// Reads a `.balls` file.
fn parse(bytes: &[u8]) -> Result<Table, Flaw> {
    let stream = bytes
        .strip_prefix(MAGIC)
        .ok_or_else(|| Flaw::needed("the first bytes \"balls16\\n\"", "others"))?;
    let mut plain = Vec::new();
    ZlibDecoder::new(stream)
        .read_to_end(&mut plain)
        .map_err(|error| Flaw::needed("a zlib stream", error))?;

    let cut = || Flaw::needed("a header of 32 bytes", plain.len());
    let (count, rest) = plain.split_first_chunk::<4>().ok_or_else(cut)?;
    let (header, steps) = rest.split_first_chunk::<28>().ok_or_else(cut)?;
    let count = u32::from_le_bytes(*count) as usize;
    if count.checked_mul(6) != Some(steps.len()) {
        let needed = format!("six bytes for each of {count} balls");
        return Err(Flaw::needed(&needed, format_args!("{} bytes", steps.len())));
    }
    let numbers: [f32; 7] = std::array::from_fn(|index| {
        f32::from_le_bytes(std::array::from_fn(|byte| header[4 * index + byte]))
    });
    let [radius, least @ .., step_x, step_y, step_z] = numbers;
    let (least, step) =
        (DVec3::from_array(least.map(f64::from)), Vec3::new(step_x, step_y, step_z).as_dvec3());

    let mut positions = vec![DVec3::ZERO; count];
    for (axis, column) in steps.chunks_exact((2 * count).max(1)).enumerate() {
        let mut steps = 0_u16;
        for (position, difference) in positions.iter_mut().zip(column.chunks_exact(2)) {
            steps = steps.wrapping_add(u16::from_le_bytes([difference[0], difference[1]]));
            position[axis] = least[axis] + f64::from(steps) * step[axis];
        }
    }
    let mut table = Table { positions, ..Table::default() };
    table.add("support_radius", Values::Numbers(vec![f64::from(radius); count]));
    Ok(table)
}

#[cfg(test)]
mod tests {
    use metaball_core::{Kernel, Metaball};
    use proptest::prelude::*;

    use super::*;

    fn scene(centers: &[[f32; 3]]) -> Scene {
        let balls = centers.iter().map(|center| Metaball::new(Vec3::from_array(*center), 0.5));
        Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal")
    }

    #[test]
    fn scenes_with_more_than_centres_are_refused() {
        let balls = [Metaball::new(Vec3::ZERO, 1.0), Metaball::new(Vec3::ZERO, 2.0)];
        let scene = Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal");
        let error = pack_balls(&scene).expect_err("refused").to_string();
        assert!(error.ends_with("without strengths or colours, found several radii"));
    }

    #[test]
    fn refusals_say_what_was_needed() {
        let problem = |bytes: &[u8]| parse(bytes).expect_err("refused").problem;
        assert!(problem(b"").starts_with("needed the first bytes"));
        assert!(problem(b"balls16\nxxxx").starts_with("needed a zlib stream"));
        assert_eq!(problem(&compress(b"short")), "needed a header of 32 bytes, found 5");
        let mut plain = [0; 32];
        plain[0] = 2;
        assert_eq!(
            problem(&compress(&plain)),
            "needed six bytes for each of 2 balls, found 0 bytes"
        );
    }

    proptest! {
        /// Half a step, and the roundings of least corner, step (65,535 times) and sum to f32: four
        /// times 6e-8 of the greatest number that occurs, twice the range.
        #[test]
        fn centres_move_by_half_a_step(
            centers in prop::collection::vec(prop::array::uniform3(-100.0f32..100.0), 0..50),
        ) {
            let read = parse(&pack_balls(&scene(&centers)).expect("legal")).expect("legal");
            prop_assert_eq!(read.len(), centers.len());
            for (position, center) in read.positions.iter().zip(&centers) {
                let moved = (position.as_vec3() - Vec3::from_array(*center)).abs().max_element();
                prop_assert!(moved <= 0.5 * 200.0 / 65_535.0 + 4.0 * 6e-8 * 200.0);
            }
            let radii = Values::Numbers(vec![0.5; centers.len()]);
            prop_assert_eq!(read.column("support_radius").map(|column| &column.values), Some(&radii));
        }

        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            let _ = (parse(&bytes), parse(&compress(&bytes)), parse(&[MAGIC, &bytes[..]].concat()));
        }
    }
}
