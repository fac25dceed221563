//! Hits as an OpenEXR file, for other programs to compare with.

use std::io::Cursor;
use std::path::Path;

use anyhow::Context;
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes};
use exr::prelude::{Vec2, WritableImage};
use metaball_core::{Hit, Verdict};

use crate::output::write_atomically;

/// Writes an image of hits, row by row from the top left, as f32 channels: `Z` is the distance along
/// the unit primary ray in scene units, +∞ for a miss; `N.X`, `N.Y`, `N.Z` are the unit outward
/// normal, zero for a miss. Where a method could not tell, Z is NaN and the normal zero.
///
/// # Errors
/// When there are not width times height hits, or the file cannot be written.
pub fn write_hits(path: &Path, width: u32, height: u32, hits: &[Hit]) -> anyhow::Result<()> {
    let size = Vec2(width as usize, height as usize);
    anyhow::ensure!(
        hits.len() == size.area(),
        "hits: needed {width} × {height} pixels, found {}",
        hits.len()
    );
    let distance = |hit: &Hit| match hit.verdict {
        Verdict::Hit | Verdict::Inside => hit.t,
        Verdict::Miss => f32::INFINITY,
        Verdict::Undecided => f32::NAN,
    };
    let normal = |axis: usize| move |hit: &Hit| if hit.is_hit() { hit.normal[axis] } else { 0.0 };
    let channels = [
        channel("Z", hits, distance),
        channel("N.X", hits, normal(0)),
        channel("N.Y", hits, normal(1)),
        channel("N.Z", hits, normal(2)),
    ];
    let layer = Layer::new(
        size,
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels.into_iter().collect()),
    );
    let mut file = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .to_buffered(&mut file)
        .with_context(|| format!("cannot encode {}", path.display()))?;
    write_atomically(path, file.get_ref())
}

fn channel(name: &str, hits: &[Hit], value: impl Fn(&Hit) -> f32) -> AnyChannel<FlatSamples> {
    AnyChannel::new(name, FlatSamples::F32(hits.iter().map(value).collect()))
}

#[cfg(test)]
mod tests {
    use exr::prelude::{ReadChannels, ReadLayers, read};
    use glam::Vec3;

    use super::*;
    use crate::output::tests::scratch;

    fn hit(t: f32, normal: Vec3) -> Hit {
        Hit { verdict: Verdict::Hit, fallback: false, t, normal }
    }

    #[test]
    fn the_file_reads_back_bit_for_bit() {
        let folder = scratch("exr");
        let path = folder.join("hits.exr");
        let normal = Vec3::new(0.6, -0.0, 0.8);
        let undecided = Hit { verdict: Verdict::Undecided, ..hit(3.0, Vec3::X) };
        let hits = [
            hit(1.000_000_1, normal),
            Hit::MISS,
            undecided,
            hit(2.0, Vec3::Z),
            Hit::MISS,
            Hit { verdict: Verdict::Inside, ..hit(0.0, Vec3::Y) },
        ];
        write_hits(&path, 3, 2, &hits).expect("written");

        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_file(&path)
            .expect("readable");
        std::fs::remove_dir_all(folder).expect("removable");
        assert_eq!(image.layer_data.size, Vec2(3, 2));
        let channels = &image.layer_data.channel_data.list;
        let names: Vec<_> = channels.iter().map(|channel| channel.name.to_string()).collect();
        assert_eq!(names, ["N.X", "N.Y", "N.Z", "Z"]);
        let bits = |index: usize| match &channels[index].sample_data {
            FlatSamples::F32(samples) => samples.iter().map(|v| v.to_bits()).collect::<Vec<_>>(),
            other => panic!("needed f32 samples, found {other:?}"),
        };
        let expected = |values: [f32; 6]| values.map(f32::to_bits).to_vec();
        assert_eq!(bits(0), expected([0.6, 0.0, 0.0, 0.0, 0.0, 0.0]));
        assert_eq!(bits(1), expected([-0.0, 0.0, 0.0, 0.0, 0.0, 1.0]));
        assert_eq!(bits(2), expected([0.8, 0.0, 0.0, 1.0, 0.0, 0.0]));
        let infinity = f32::INFINITY;
        assert_eq!(bits(3), expected([1.000_000_1, infinity, f32::NAN, 2.0, infinity, 0.0]));
    }

    #[test]
    fn a_truncated_image_is_refused() {
        let error = write_hits(Path::new("unused.exr"), 2, 2, &[Hit::MISS; 3]);
        assert_eq!(error.expect_err("refused").to_string(), "hits: needed 2 × 2 pixels, found 3");
    }
}
