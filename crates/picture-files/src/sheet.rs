//! A picture of pictures, side by side.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ImageEncoder, RgbImage, imageops};

use crate::{PictureFileError, write_atomically};

/// Pictures to a row.
const COLUMNS: u32 = 6;

/// White pixels between pictures.
const GAP: u32 = 2;

/// Writes a PNG of these pictures, six to a row from the top left.
///
/// # Errors
/// When there is none, one cannot be read, their sizes differ, or the sheet cannot be written.
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
    let count = pictures.len() as u32;
    let columns = count.min(COLUMNS);
    let (across, down) = (width + GAP, height + GAP);
    let (sheet_width, sheet_height) =
        (columns * across - GAP, count.div_ceil(columns) * down - GAP);
    let mut sheet = RgbImage::from_pixel(sheet_width, sheet_height, image::Rgb([255; 3]));
    for (index, picture) in (0..count).zip(&pictures) {
        let (column, row) = (index % columns, index / columns);
        imageops::replace(&mut sheet, picture, (column * across).into(), (row * down).into());
    }

    let mut png = Cursor::new(Vec::new());
    PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive)
        .write_image(&sheet, sheet_width, sheet_height, image::ExtendedColorType::Rgb8)
        .map_err(PictureFileError::encode("a PNG"))?;
    write_atomically(path, png.get_ref())
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

        RgbImage::new(5, 3).save(&paths[3]).expect("written");
        assert!(write_sheet(&sheet, &paths).expect_err("sizes").to_string().contains("one size"));
        assert!(write_sheet(&sheet, &[]).is_err());
    }
}
