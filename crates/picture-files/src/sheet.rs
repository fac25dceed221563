//! A picture of pictures, side by side.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ImageEncoder, RgbImage, imageops};

use crate::picture::PictureFormat;
use crate::{PictureFileError, ensure_writable, jpeg, write_atomically};

/// Pictures to a row.
const COLUMNS: u32 = 6;

/// White pixels between pictures.
const GAP: u32 = 2;

/// Writes a picture of these pictures, six to a row from the top left: `.png`, or `.jpg` and `.jpeg`.
///
/// # Errors
/// When there is none, one cannot be read, their sizes differ, or as [`ensure_sheet`].
pub fn write_sheet(path: &Path, pictures: &[PathBuf]) -> Result<(), PictureFileError> {
    let read = |path: &PathBuf| {
        let picture = image::open(path).map_err(PictureFileError::decode(path));
        picture.map(image::DynamicImage::into_rgb8)
    };
    let pictures: Vec<RgbImage> = pictures.iter().map(read).collect::<Result<_, _>>()?;
    let refused = |needed: &str, found| PictureFileError::Size {
        what: "sheet".to_owned(),
        needed: needed.to_owned(),
        found,
    };
    let first = pictures.first().ok_or_else(|| refused("pictures", 0))?;
    let (width, height) = first.dimensions();
    let others = pictures.iter().filter(|picture| picture.dimensions() != (width, height)).count();
    if others > 0 {
        return Err(refused("pictures of one size", others));
    }
    let size = sheet_size(pictures.len(), (width, height));
    let mut sheet = RgbImage::from_pixel(size.0, size.1, image::Rgb([255; 3]));
    for (index, picture) in (0..).zip(&pictures) {
        let (column, row) = (index % COLUMNS, index / COLUMNS);
        let (across, down) = (column * (width + GAP), row * (height + GAP));
        imageops::replace(&mut sheet, picture, across.into(), down.into());
    }
    let bytes = match PictureFormat::of_size(path, size.0, size.1)? {
        PictureFormat::Png => smallest_png(&sheet, size)?,
        PictureFormat::Jpeg => jpeg::encode(&sheet, size)?,
    };
    write_atomically(path, &bytes)
}

/// Makes sure that a sheet of so many pictures of a size could be written now, and leaves none.
///
/// # Errors
/// When the ending is another, the format has no such size, or the file cannot be written.
pub fn ensure_sheet(
    path: &Path,
    pictures: usize,
    size: (u32, u32),
) -> Result<(), PictureFileError> {
    let (width, height) = sheet_size(pictures, size);
    PictureFormat::of_size(path, width, height)?;
    ensure_writable(path)
}

/// Pixels across and down of a sheet of so many pictures of a size.
fn sheet_size(pictures: usize, (width, height): (u32, u32)) -> (u32, u32) {
    let pictures = u32::try_from(pictures).unwrap_or(u32::MAX);
    let side = |count: u32, pixels: u32| count.saturating_mul(pixels.saturating_add(GAP)) - GAP;
    (side(pictures.clamp(1, COLUMNS), width), side(pictures.div_ceil(COLUMNS).max(1), height))
}

fn smallest_png(rgb: &[u8], (width, height): (u32, u32)) -> Result<Vec<u8>, PictureFileError> {
    let mut png = Cursor::new(Vec::new());
    PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive)
        .write_image(rgb, width, height, image::ExtendedColorType::Rgb8)
        .map_err(PictureFileError::encode("a PNG"))?;
    Ok(png.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_stand_side_by_side() {
        let folder = tempfile::tempdir().expect("a folder");
        let paths: Vec<PathBuf> = (0..8)
            .map(|index| {
                let path = folder.path().join(format!("{index}.png"));
                RgbImage::from_pixel(4, 3, image::Rgb([index, 0, 0])).save(&path).expect("written");
                path
            })
            .collect();
        let sheet = folder.path().join("sheet.png");
        write_sheet(&sheet, &paths).expect("written");
        let found = image::open(&sheet).expect("a PNG").into_rgb8();
        assert_eq!(found.dimensions(), (6 * 4 + 5 * 2, 2 * 3 + 2));
        let red = |x, y| found.get_pixel(x, y).0[0];
        assert_eq!([red(0, 0), red(4, 0), red(33, 2), red(0, 3), red(6, 7)], [0, 255, 5, 255, 7]);

        let smaller = folder.path().join("sheet.jpg");
        write_sheet(&smaller, &paths).expect("written");
        assert_eq!(image::open(&smaller).expect("a JPEG").into_rgb8().dimensions(), (34, 8));
        for (name, pictures) in [("sheet.gif", 8), ("sheet.jpg", 6 * 13_107 + 1)] {
            let path = folder.path().join(name);
            assert!(ensure_sheet(&path, pictures, (4, 3)).is_err(), "{name}");
        }
        ensure_sheet(&folder.path().join("later.jpg"), 6 * 13_107, (4, 3)).expect("it fits");
        assert!(write_sheet(&folder.path().join("sheet.gif"), &paths).is_err());

        RgbImage::new(5, 3).save(&paths[3]).expect("written");
        assert!(write_sheet(&sheet, &paths).expect_err("sizes").to_string().contains("one size"));
        assert!(write_sheet(&sheet, &[]).is_err());
    }
}
