//! Linear light: pictures before they are tone mapped, and surroundings.

use std::path::Path;

use glam::Vec3;
use image::{DynamicImage, ImageReader};

use crate::PictureFileError;
use crate::ending::named_format;
use crate::scan_lines::ScanLines;

/// An image of linear light, red, green and blue, not limited to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct LightImage {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Row by row from the top left.
    pub light: Vec<Vec3>,
}

/// Linear light on its way to the disk: OpenEXR, three channels of f32.
///
/// It comes in parts, row by row from the top left, and the part written last and sixteen rows are all of
/// it that is held. [`finish`](Self::finish) moves the file to its place; dropped before, it is removed.
#[derive(Debug)]
pub struct LightFile(ScanLines<3>);

impl LightFile {
    /// A file of this size.
    ///
    /// # Errors
    /// When its ending is not `.exr`, or the file cannot be made.
    pub fn create(path: &Path, width: u32, height: u32) -> Result<Self, PictureFileError> {
        named_format(path, &[("exr", ())], "a file of light, .exr")?;
        ScanLines::create(path, "light", (width, height), ["B", "G", "R"]).map(Self)
    }

    /// Writes the light of the next pixels, any number of them.
    ///
    /// # Errors
    /// When they are more than are left, or cannot be written.
    pub fn write(&mut self, light: &[Vec3]) -> Result<(), PictureFileError> {
        self.0.write(light.iter().map(|light| [light.z, light.y, light.x]))
    }

    /// Moves the file to its place.
    ///
    /// # Errors
    /// When pixels are missing, or the file cannot be written.
    pub fn finish(self) -> Result<(), PictureFileError> {
        self.0.finish()
    }
}

/// Writes linear light, row by row from the top left, as a [`LightFile`].
///
/// # Errors
/// When there is not one value for each pixel, or the file cannot be written.
pub fn write_light(
    path: &Path,
    width: u32,
    height: u32,
    light: &[Vec3],
) -> Result<(), PictureFileError> {
    let mut file = LightFile::create(path, width, height)?;
    file.write(light)?;
    file.finish()
}

/// Reads linear light from a file that holds linear light: OpenEXR or Radiance HDR.
///
/// # Errors
/// When the file cannot be read, or its channels are not f32.
pub fn read_light(path: &Path) -> Result<LightImage, PictureFileError> {
    let image = ImageReader::open(path)
        .map_err(PictureFileError::io("open", path))?
        .with_guessed_format()
        .map_err(PictureFileError::io("read", path))?
        .decode()
        .map_err(PictureFileError::decode(path))?;
    let (DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_)) = image else {
        return Err(PictureFileError::Content {
            path: path.to_owned(),
            needed: "linear light, an .hdr or .exr image",
            found: format!("{:?}", image.color()),
        });
    };
    let image = image.into_rgb32f();
    let light = image.pixels().map(|pixel| Vec3::from(pixel.0)).collect();
    Ok(LightImage { width: image.width(), height: image.height(), light })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_goes_through_a_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("light.exr");
        let light = vec![Vec3::new(0.25, 4.0, 0.0), Vec3::splat(1e-3)];
        write_light(&path, 2, 1, &light).expect("written");
        let back = read_light(&path).expect("readable");
        assert_eq!(back, LightImage { width: 2, height: 1, light: light.clone() });
        let error = write_light(&path, 2, 2, &light).expect_err("refused").to_string();
        assert_eq!(error, "light: needed 2 × 2 pixels, found 2");
        let other = folder.path().join("light.hdr");
        let error = write_light(&other, 2, 1, &light).expect_err("refused").to_string();
        assert!(error.ends_with("needed a file of light, .exr, found .hdr"), "{error}");
        assert!(!other.exists());
    }

    #[test]
    fn other_pictures_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("picture.png");
        image::RgbImage::new(2, 2).save(&path).expect("written");
        let error = read_light(&path).expect_err("refused").to_string();
        assert!(error.contains("needed linear light") && error.ends_with("Rgb8"), "{error}");
        let error = read_light(Path::new("nowhere.hdr")).expect_err("refused").to_string();
        assert_eq!(error, "cannot open nowhere.hdr");
    }
}
