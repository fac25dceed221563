//! Hits as NumPy arrays: height × width × 4 numbers, Z, N.X, N.Y, N.Z; or height × width distances.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

use metaball_core::Hit;
use npyz::{DType, NpyFile, NpyWriter, Order, TypeChar, WriterBuilder};

use super::{HitImage, WHAT, values};
use crate::PictureFileError;
use crate::draft::Draft;
use crate::pixel_count::PixelCount;

/// A file of hits that come in parts.
pub(super) struct NpyHits {
    draft: Draft,
    array: NpyWriter<f32, BufWriter<File>>,
    count: PixelCount,
}

impl NpyHits {
    pub(super) fn create(
        path: &Path,
        (width, height): (u32, u32),
    ) -> Result<Self, PictureFileError> {
        let draft = Draft::create(path)?;
        let file = draft.file().map_err(draft.error())?;
        let array = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&[height.into(), width.into(), 4])
            .writer(BufWriter::new(file))
            .begin_nd();
        let array = array.map_err(draft.error())?;
        Ok(Self { draft, array, count: PixelCount::new(WHAT, width, height) })
    }

    pub(super) fn write(&mut self, hits: &[Hit]) -> Result<(), PictureFileError> {
        self.count.add(hits.len())?;
        self.array.extend(hits.iter().flat_map(values)).map_err(self.draft.error())
    }

    pub(super) fn finish(self) -> Result<(), PictureFileError> {
        self.count.finish()?;
        self.array.finish().map_err(self.draft.error())?;
        self.draft.keep()
    }
}

impl std::fmt::Debug for NpyHits {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("NpyHits").field("draft", &self.draft).finish_non_exhaustive()
    }
}

/// Reads f32 or f64 of either shape.
pub(super) fn read_file(path: &Path) -> Result<HitImage, PictureFileError> {
    let file = File::open(path).map_err(PictureFileError::io("open", path))?;
    let array = NpyFile::new(BufReader::new(file)).map_err(PictureFileError::decode(path))?;
    let content = |found| PictureFileError::Content {
        path: path.to_owned(),
        needed: "f32 or f64 in C order, height × width × 4, or height × width distances alone",
        found,
    };
    let (shape, dtype) = (array.shape().to_vec(), array.dtype());
    let refused = || content(format!("{} of shape {shape:?}", dtype.descr()));
    let side = |index: usize| usize::try_from(shape[index]).map_err(|_| refused());
    let has_normals = match shape[..] {
        [_, _, 4] => true,
        [_, _] => false,
        _ => return Err(refused()),
    };
    let (height, width) = (side(0)?, side(1)?);
    let bits = match &dtype {
        DType::Plain(plain) if plain.type_char() == TypeChar::Float => plain.size_field(),
        _ => 0,
    };
    let is_rows = array.order() == Order::C;
    let numbers: Vec<f32> = match bits {
        4 if is_rows => array.into_vec().map_err(PictureFileError::decode(path))?,
        8 if is_rows => {
            let numbers: Vec<f64> = array.into_vec().map_err(PictureFileError::decode(path))?;
            numbers.into_iter().map(|number| number as f32).collect()
        }
        _ => return Err(refused()),
    };
    let values = numbers.chunks_exact(if has_normals { 4 } else { 1 }).map(|numbers| {
        let at = |index: usize| numbers.get(index).copied().unwrap_or(0.0);
        [at(0), at(1), at(2), at(3)]
    });
    HitImage::of_values(path, (width, height), has_normals, values)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use metaball_core::Verdict;

    use super::*;
    use crate::{read_hits, write_hits};

    #[test]
    fn an_array_reads_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("hits.npy");
        let hit = |t| Hit { verdict: Verdict::Hit, fallback: false, t, normal: Vec3::Y };
        let hits = [hit(1.5), Hit::MISS, hit(1e-3), hit(7.0), Hit::MISS, hit(2.0)];
        write_hits(&path, 3, 2, &hits).expect("written");
        let back = read_hits(&path).expect("readable");
        assert_eq!((back.width, back.height, back.has_normals), (3, 2, true));
        assert_eq!(back.hits[0], hits[0]);
        let verdicts = |hits: &[Hit]| hits.iter().map(|hit| hit.verdict).collect::<Vec<_>>();
        assert_eq!(verdicts(&back.hits), verdicts(&hits));
    }

    /// As `numpy.save` writes an array of f64 distances.
    #[test]
    fn distances_alone_will_do() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("depth.npy");
        let save = |shape: &[u64], numbers: &[f64]| {
            let mut bytes = Vec::new();
            let mut writer = npyz::WriteOptions::new()
                .default_dtype()
                .shape(shape)
                .writer(&mut bytes)
                .begin_nd()
                .expect("begun");
            writer.extend(numbers).expect("written");
            writer.finish().expect("written");
            std::fs::write(&path, bytes).expect("written");
        };
        save(&[1, 2], &[2.25, f64::INFINITY]);
        let back = read_hits(&path).expect("readable");
        assert_eq!((back.width, back.height, back.has_normals), (2, 1, false));
        assert_eq!((back.hits[0].t, back.hits[1]), (2.25, Hit::MISS));
        save(&[2], &[1.0, 2.0]);
        let error = read_hits(&path).expect_err("refused").to_string();
        assert!(error.contains("height × width × 4") && error.contains("[2]"), "{error}");
        save(&[1, 1], &[-2.0]);
        let error = read_hits(&path).expect_err("refused").to_string();
        assert!(error.ends_with("found Z = -2 at column 0, row 0"), "{error}");
    }
}
