//! Hits as OpenEXR: f32 channels `Z`, `N.X`, `N.Y`, `N.Z`.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use exr::prelude::{AnyChannel, FlatSamples, ReadChannels, ReadLayers, read};
use metaball_core::Hit;

use super::{HitImage, WHAT, values};
use crate::PictureFileError;
use crate::scan_lines::ScanLines;

/// Channels of normals.
const NORMALS: [&str; 3] = ["N.X", "N.Y", "N.Z"];

/// A file of hits that come in parts.
#[derive(Debug)]
pub(super) struct ExrHits(ScanLines<4>);

impl ExrHits {
    pub(super) fn create(path: &Path, size: (u32, u32)) -> Result<Self, PictureFileError> {
        let [x, y, z] = NORMALS;
        ScanLines::create(path, WHAT, size, [x, y, z, "Z"]).map(Self)
    }

    pub(super) fn write(&mut self, hits: &[Hit]) -> Result<(), PictureFileError> {
        self.0.write(hits.iter().map(values).map(|[t, x, y, z]| [x, y, z, t]))
    }

    pub(super) fn finish(self) -> Result<(), PictureFileError> {
        self.0.finish()
    }
}

/// Reads what [`ExrHits`] makes: channels of f32 or f16, with or without normals.
pub(super) fn read_file(path: &Path) -> Result<HitImage, PictureFileError> {
    let file = File::open(path).map_err(PictureFileError::io("open", path))?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(BufReader::new(file))
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
    let values = distances.iter().enumerate().map(|(pixel, &t)| {
        let axis = |index: usize| normals.get(index).map_or(0.0, |axis| axis[pixel]);
        [t, axis(0), axis(1), axis(2)]
    });
    HitImage::of_values(path, (size.x(), size.y()), has_normals, values)
}

#[cfg(test)]
mod tests {
    use exr::prelude::Vec2;
    use glam::Vec3;
    use metaball_core::Verdict;

    use super::*;
    use crate::{read_hits, write_hits};

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
