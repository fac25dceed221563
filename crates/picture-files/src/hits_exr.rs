//! Hits as OpenEXR, for other programs to compare with, and from them.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes};
use exr::prelude::{ReadChannels, ReadLayers, Vec2, WritableImage, read};
use glam::Vec3;
use metaball_core::{Hit, Verdict};

use crate::{PictureFileError, write_atomically};

/// Channels of normals.
const NORMALS: [&str; 3] = ["N.X", "N.Y", "N.Z"];

/// The hits of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct HitImage {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Row by row from the top left.
    pub hits: Vec<Hit>,
    /// Whether the file has normals; without them all are zero.
    pub has_normals: bool,
}

/// Writes an image of hits, row by row from the top left, as f32 channels: `Z` is the distance along
/// the unit primary ray in scene units, +∞ for a miss, 0 where the ray starts inside; `N.X`, `N.Y`,
/// `N.Z` are the unit outward normal, zero for a miss. Where a method could not tell, Z is NaN and the
/// normal zero.
///
/// # Errors
/// When there are not width times height hits, or the file cannot be written.
pub fn write_hits(
    path: &Path,
    width: u32,
    height: u32,
    hits: &[Hit],
) -> Result<(), PictureFileError> {
    let size = Vec2(width as usize, height as usize);
    if hits.len() != size.area() {
        return Err(PictureFileError::Size {
            what: "hits".to_owned(),
            needed: format!("{width} × {height} pixels"),
            found: hits.len(),
        });
    }
    let distance = |hit: &Hit| match hit.verdict {
        Verdict::Hit | Verdict::Inside => hit.t,
        Verdict::Miss => f32::INFINITY,
        Verdict::Undecided => f32::NAN,
    };
    let normal = |axis: usize| move |hit: &Hit| if hit.is_hit() { hit.normal[axis] } else { 0.0 };
    let channels = [
        channel("Z", hits, distance),
        channel(NORMALS[0], hits, normal(0)),
        channel(NORMALS[1], hits, normal(1)),
        channel(NORMALS[2], hits, normal(2)),
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
        .map_err(PictureFileError::encode(path.display().to_string()))?;
    write_atomically(path, file.get_ref())
}

fn channel(name: &str, hits: &[Hit], value: impl Fn(&Hit) -> f32) -> AnyChannel<FlatSamples> {
    AnyChannel::new(name, FlatSamples::F32(hits.iter().map(value).collect()))
}

/// Reads what [`write_hits`] writes: `Z` as f32 or f16, with or without normals. A distance of 0 is a ray
/// that starts inside.
///
/// # Errors
/// When the file cannot be read, has no channel `Z`, some but not all of the normals, or a distance
/// below 0.
pub fn read_hits(path: &Path) -> Result<HitImage, PictureFileError> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(PictureFileError::decode(path))?;
    let size = image.layer_data.size;
    let channels = &image.layer_data.channel_data.list;
    let content =
        |needed, found: String| PictureFileError::Content { path: path.to_owned(), needed, found };
    let named = |name: &str| channels.iter().find(|channel| channel.name.to_string() == name);
    let names = || channels.iter().map(|channel| channel.name.to_string()).collect::<Vec<_>>();
    let needed = "a channel Z, and N.X, N.Y and N.Z or none of them";
    let normals = NORMALS.map(named);
    let has_normals = normals.iter().all(Option::is_some);
    let distances = named("Z").filter(|_| has_normals || normals.iter().all(Option::is_none));
    let Some(distances) = distances else {
        return Err(content(needed, names().join(", ")));
    };
    let floats = |channel: &AnyChannel<FlatSamples>| match &channel.sample_data {
        FlatSamples::F32(samples) => Ok(samples.clone()),
        FlatSamples::F16(samples) => Ok(samples.iter().map(|value| value.to_f32()).collect()),
        FlatSamples::U32(_) => {
            let found = format!("integers in {}", channel.name);
            Err(content("floating-point channels", found))
        }
    };
    let distances = floats(distances)?;
    let normals = normals.into_iter().flatten().map(floats).collect::<Result<Vec<_>, _>>()?;
    let hits = distances.iter().enumerate().map(|(pixel, &t)| {
        let normal = normals.iter().map(|axis| axis[pixel]).collect::<Vec<_>>();
        let normal = <[f32; 3]>::try_from(normal).map_or(Vec3::ZERO, Vec3::from);
        hit(t, normal).ok_or_else(|| {
            let (column, row) = (pixel % size.x(), pixel / size.x());
            content("distances of at least 0", format!("Z = {t} at column {column}, row {row}"))
        })
    });
    let hits = hits.collect::<Result<Vec<_>, _>>()?;
    // Sizes come from a file that was made of u32s, or are bounded by what fits into memory.
    let [width, height] =
        [size.x(), size.y()].map(|pixels| u32::try_from(pixels).unwrap_or(u32::MAX));
    Ok(HitImage { width, height, hits, has_normals })
}

/// What a distance says; `None` where it says nothing.
pub(crate) fn hit(t: f32, normal: Vec3) -> Option<Hit> {
    let found = |verdict| Some(Hit { verdict, fallback: false, t, normal });
    match t {
        t if t.is_nan() => Some(Hit { verdict: Verdict::Undecided, ..Hit::MISS }),
        f32::INFINITY => Some(Hit::MISS),
        0.0 => found(Verdict::Inside),
        t if t > 0.0 => found(Verdict::Hit),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit_at(t: f32, normal: Vec3) -> Hit {
        Hit { verdict: Verdict::Hit, fallback: false, t, normal }
    }

    #[test]
    fn the_file_reads_back_bit_for_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("hits.exr");
        let normal = Vec3::new(0.6, -0.0, 0.8);
        let undecided = Hit { verdict: Verdict::Undecided, ..hit_at(3.0, Vec3::X) };
        let hits = [
            hit_at(1.000_000_1, normal),
            Hit::MISS,
            undecided,
            hit_at(2.0, Vec3::Z),
            Hit::MISS,
            Hit { verdict: Verdict::Inside, ..hit_at(0.0, Vec3::Y) },
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

        let back = read_hits(&path).expect("readable");
        assert!(back.has_normals && (back.width, back.height) == (3, 2));
        let verdicts = |hits: &[Hit]| hits.iter().map(|hit| hit.verdict).collect::<Vec<_>>();
        assert_eq!(verdicts(&back.hits), verdicts(&hits));
        assert_eq!((back.hits[0], back.hits[3]), (hits[0], hits[3]));
    }

    #[test]
    fn a_truncated_image_is_refused() {
        let error = write_hits(Path::new("unused.exr"), 2, 2, &[Hit::MISS; 3]);
        assert_eq!(error.expect_err("refused").to_string(), "hits: needed 2 × 2 pixels, found 3");
    }

    #[test]
    fn what_holds_no_hits_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("light.exr");
        crate::write_light(&path, 1, 1, &[Vec3::ONE]).expect("written");
        let error = read_hits(&path).expect_err("refused").to_string();
        assert!(error.contains("needed a channel Z") && error.ends_with("B, G, R"), "{error}");
        write_hits(&path, 1, 1, &[hit_at(-1.0, Vec3::X)]).expect("written");
        let error = read_hits(&path).expect_err("refused").to_string();
        assert!(error.ends_with("found Z = -1 at column 0, row 0"), "{error}");
    }
}
