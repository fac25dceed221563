//! Hits, for other programs to compare with, and from them: `docs/hits-format.md` is this for people.

mod exr;
mod npy;

use std::path::Path;

use glam::Vec3;
use metaball_core::{Hit, Verdict};

use self::exr::ExrHits;
use self::npy::NpyHits;
use crate::PictureFileError;
use crate::ending::named_format;

/// What such a file holds of a picture.
const WHAT: &str = "hits";

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

/// A file of hits, known by its ending.
#[derive(Debug, Clone, Copy)]
enum Format {
    Exr,
    Npy,
}

impl Format {
    fn of(path: &Path) -> Result<Self, PictureFileError> {
        named_format(
            path,
            &[("exr", Self::Exr), ("npy", Self::Npy)],
            "a file of hits, .exr or .npy",
        )
    }
}

/// Hits on their way to the disk, each as four f32: `Z` is the distance along the unit primary ray in
/// scene units, +∞ for a miss, 0 where the ray starts inside; `N.X`, `N.Y`, `N.Z` are the unit outward
/// normal, zero for a miss. Where a method could not tell, Z is NaN and the normal zero.
///
/// `.exr` has them as channels, `.npy` as an array of height × width × 4. What is no regular file and has
/// no ending gets OpenEXR.
///
/// They come in parts, row by row from the top left, and the part written last and sixteen rows are all
/// of them that is held. [`finish`](Self::finish) moves the file to its place; dropped before, it is
/// removed.
#[derive(Debug)]
pub struct HitsFile(Encoder);

#[derive(Debug)]
enum Encoder {
    Exr(Box<ExrHits>),
    Npy(NpyHits),
}

impl HitsFile {
    /// A file of this size, and of the format that its ending names.
    ///
    /// # Errors
    /// When the ending is another, or the file cannot be made.
    pub fn create(path: &Path, width: u32, height: u32) -> Result<Self, PictureFileError> {
        Ok(Self(match Format::of(path)? {
            Format::Exr => Encoder::Exr(ExrHits::create(path, (width, height))?.into()),
            Format::Npy => Encoder::Npy(NpyHits::create(path, (width, height))?),
        }))
    }

    /// Writes the next hits, any number of them.
    ///
    /// # Errors
    /// When they are more than are left, or cannot be written.
    pub fn write(&mut self, hits: &[Hit]) -> Result<(), PictureFileError> {
        match &mut self.0 {
            Encoder::Exr(file) => file.write(hits),
            Encoder::Npy(file) => file.write(hits),
        }
    }

    /// Moves the file to its place.
    ///
    /// # Errors
    /// When hits are missing, or the file cannot be written.
    pub fn finish(self) -> Result<(), PictureFileError> {
        match self.0 {
            Encoder::Exr(file) => file.finish(),
            Encoder::Npy(file) => file.finish(),
        }
    }
}

/// Writes an image of hits, row by row from the top left, as a [`HitsFile`].
///
/// # Errors
/// When there are not width times height hits, the ending is another, or the file cannot be written.
pub fn write_hits(
    path: &Path,
    width: u32,
    height: u32,
    hits: &[Hit],
) -> Result<(), PictureFileError> {
    let mut file = HitsFile::create(path, width, height)?;
    file.write(hits)?;
    file.finish()
}

/// Reads what [`write_hits`] writes, and what other programs write like it: distances as f32, f16 (in
/// `.exr`) or f64 (in `.npy`), with or without normals. A distance of 0 is a ray that starts inside.
///
/// # Errors
/// When the file cannot be read, has no distances, some but not all of the normals, or a distance
/// below 0.
pub fn read_hits(path: &Path) -> Result<HitImage, PictureFileError> {
    match Format::of(path)? {
        Format::Exr => exr::read_file(path),
        Format::Npy => npy::read_file(path),
    }
}

/// A hit as four numbers: distance and normal.
fn values(hit: &Hit) -> [f32; 4] {
    let t = match hit.verdict {
        Verdict::Hit | Verdict::Inside => hit.t,
        Verdict::Miss => f32::INFINITY,
        Verdict::Undecided => f32::NAN,
    };
    let normal = if hit.is_hit() { hit.normal } else { Vec3::ZERO };
    [t, normal.x, normal.y, normal.z]
}

/// The hit of four numbers; `None` where the distance is below 0.
fn hit([t, x, y, z]: [f32; 4]) -> Option<Hit> {
    let found = |verdict| Some(Hit { verdict, fallback: false, t, normal: Vec3::new(x, y, z) });
    match t {
        t if t.is_nan() => Some(Hit { verdict: Verdict::Undecided, ..Hit::MISS }),
        f32::INFINITY => Some(Hit::MISS),
        0.0 => found(Verdict::Inside),
        t if t > 0.0 => found(Verdict::Hit),
        _ => None,
    }
}

impl HitImage {
    fn of_values(
        path: &Path,
        (width, height): (usize, usize),
        has_normals: bool,
        values: impl Iterator<Item = [f32; 4]>,
    ) -> Result<Self, PictureFileError> {
        let content =
            |needed, found| PictureFileError::Content { path: path.to_owned(), needed, found };
        let hits = values.enumerate().map(|(pixel, values)| {
            hit(values).ok_or_else(|| {
                let (column, row) = (pixel % width, pixel / width);
                let found = format!("Z = {} at column {column}, row {row}", values[0]);
                content("distances of at least 0", found)
            })
        });
        let hits = hits.collect::<Result<Vec<_>, _>>()?;
        let (Ok(across), Ok(down)) = (u32::try_from(width), u32::try_from(height)) else {
            return Err(content("at most 2³² pixels a side", format!("{width} × {height}")));
        };
        Ok(Self { width: across, height: down, hits, has_normals })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_endings_have_to_fit() {
        let message = |path: &str, count| {
            let hits = vec![Hit::MISS; count];
            write_hits(Path::new(path), 2, 2, &hits).expect_err("refused").to_string()
        };
        assert_eq!(message("unused.exr", 3), "hits: needed 2 × 2 pixels, found 3");
        assert_eq!(message("a.png", 4), "a.png: needed a file of hits, .exr or .npy, found .png");
        assert!(
            read_hits(Path::new("hits")).expect_err("refused").to_string().ends_with("no ending")
        );
        for name in ["nowhere.exr", "nowhere.npy"] {
            let error = read_hits(Path::new(name)).expect_err("refused").to_string();
            assert_eq!(error, format!("cannot open {name}"));
        }
    }
}
