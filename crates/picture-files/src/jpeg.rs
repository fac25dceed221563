//! Pictures as JPEG.

use std::io::Write;
use std::path::Path;

use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder};
use metaball_core::Image;

use crate::PictureFileError;
use crate::draft::Draft;
use crate::pixel_count::PixelCount;

/// Of 100: smooth shading shows no blocks.
const QUALITY: u8 = 95;

/// Pixels across or down that the format can count.
pub(crate) const LONGEST_SIDE: u32 = u16::MAX as u32;

/// A JPEG on its way to the disk: eight bits a channel, sRGB. All of its pixels are held until it is
/// [finished](Self::finish), three bytes each, since they are encoded together.
#[derive(Debug)]
pub(crate) struct JpegFile {
    draft: Draft,
    size: (u32, u32),
    rgb: Vec<u8>,
    count: PixelCount,
}

impl JpegFile {
    /// A file of this size, which the format can have.
    pub(crate) fn create(path: &Path, width: u32, height: u32) -> Result<Self, PictureFileError> {
        let count = PixelCount::new("picture", width, height);
        Ok(Self { draft: Draft::create(path)?, size: (width, height), rgb: Vec::new(), count })
    }

    /// Takes the next pixels, four bytes each.
    pub(crate) fn write_bytes(&mut self, rgba: &[u8]) -> Result<(), PictureFileError> {
        self.count.add(rgba.len() / 4)?;
        self.rgb.extend(opaque(rgba));
        Ok(())
    }

    /// Encodes the picture and moves the file to its place.
    pub(crate) fn finish(self) -> Result<(), PictureFileError> {
        self.count.finish()?;
        let jpeg = encode(&self.rgb, self.size)?;
        let written = self.draft.file().and_then(|mut file| file.write_all(&jpeg));
        written.map_err(self.draft.error())?;
        self.draft.keep()
    }
}

/// Encodes an image as JPEG.
pub(crate) fn encode_jpeg(image: &Image) -> Result<Vec<u8>, PictureFileError> {
    let &Image { width, height, ref rgba } = image;
    let mut count = PixelCount::new("picture", width, height);
    count.add(rgba.len() / 4)?;
    count.finish()?;
    encode(&opaque(rgba).collect::<Vec<_>>(), (width, height))
}

/// Encodes three bytes a pixel.
pub(crate) fn encode(rgb: &[u8], (width, height): (u32, u32)) -> Result<Vec<u8>, PictureFileError> {
    let mut jpeg = Vec::new();
    JpegEncoder::new_with_quality(&mut jpeg, QUALITY)
        .write_image(rgb, width, height, ExtendedColorType::Rgb8)
        .map_err(PictureFileError::encode("a JPEG"))?;
    Ok(jpeg)
}

/// The format has no opacity, and pictures are opaque.
fn opaque(rgba: &[u8]) -> impl Iterator<Item = u8> {
    rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
}

#[cfg(test)]
mod tests {
    use std::fs;

    use metaball_core::Color;

    use super::*;
    use crate::write_picture;

    /// Smooth, as shaded surfaces are.
    fn image(width: u32, height: u32) -> Image {
        let pixels: Vec<Color> = (0..width * height)
            .map(|pixel| (pixel % width, pixel / width))
            .map(|(x, y)| Color::srgb((4 * x) as u8, (5 * y) as u8, 200))
            .collect();
        Image::new(width, height, &pixels)
    }

    #[test]
    fn a_jpeg_shows_the_picture() {
        let folder = tempfile::tempdir().expect("a folder");
        let [jpg, parts] = ["a.jpg", "b.JPEG"].map(|name| folder.path().join(name));
        let image = image(61, 47);
        write_picture(&jpg, &image).expect("written");
        let mut file = JpegFile::create(&parts, 61, 47).expect("begun");
        for part in image.rgba.chunks(4 * 100) {
            file.write_bytes(part).expect("taken");
        }
        file.finish().expect("finished");
        let bytes = fs::read(&jpg).expect("written");
        assert!(bytes == fs::read(&parts).expect("written"), "parts make the whole");

        let found = image::load_from_memory_with_format(&bytes, image::ImageFormat::Jpeg);
        let found = found.expect("a JPEG").into_rgba8();
        assert_eq!(found.dimensions(), (61, 47));
        let difference = |other: &[u8]| {
            let each = found.as_raw().iter().zip(other).map(|(a, b)| a.abs_diff(*b));
            each.max().expect("pixels")
        };
        assert!(difference(&image.rgba) <= 4, "{}", difference(&image.rgba));
        let mut upside_down = image.rgba.clone();
        upside_down.reverse();
        assert!(difference(&upside_down) > 100, "the comparison sees no difference");
    }

    #[test]
    fn half_a_picture_is_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("half.jpg");
        let mut file = JpegFile::create(&path, 3, 1).expect("begun");
        file.write_bytes(&[0; 8]).expect("taken");
        assert!(file.write_bytes(&[0; 8]).is_err());
        assert!(file.finish().is_err());
        let odd = Image { rgba: vec![0; 8], ..image(2, 2) };
        assert!(write_picture(&path, &odd).is_err());
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 0);
    }
}
