//! Linear light: pictures before they are tone mapped, and surroundings.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{SpecificChannels, WritableImage};
use glam::Vec3;
use image::{DynamicImage, ImageReader};

use crate::{PictureFileError, write_atomically};

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

/// Writes linear light as OpenEXR: three f32 channels.
///
/// # Errors
/// When there is not one value for each pixel, or the file cannot be written.
pub fn write_light(
    path: &Path,
    width: u32,
    height: u32,
    light: &[Vec3],
) -> Result<(), PictureFileError> {
    let (across, down) = (width as usize, height as usize);
    if light.len() != across * down {
        return Err(PictureFileError::Size {
            what: "light".to_owned(),
            needed: format!("{width} × {height} pixels"),
            found: light.len(),
        });
    }
    let pixel = |at: exr::math::Vec2<usize>| {
        let light = light[at.y() * across + at.x()];
        (light.x, light.y, light.z)
    };
    let mut file = Cursor::new(Vec::new());
    exr::image::Image::from_channels((across, down), SpecificChannels::rgb(pixel))
        .write()
        .to_buffered(&mut file)
        .map_err(PictureFileError::encode(path.display().to_string()))?;
    write_atomically(path, file.get_ref())
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
