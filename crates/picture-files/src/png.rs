//! Pictures as PNG.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use ::png::{
    BitDepth, ColorType, Compression, Encoder, EncodingError, Filter, StreamWriter, Writer,
};
use metaball_core::Image;

use crate::PictureFileError;
use crate::draft::Draft;
use crate::pixel_count::PixelCount;

/// A PNG on its way to the disk: eight bits a channel, sRGB. Its pixels come in parts, and the part written
/// last is all of them that is held.
pub(crate) struct PngFile {
    draft: Draft,
    pixels: StreamWriter<'static, File>,
    count: PixelCount,
}

impl PngFile {
    /// A file of this size.
    ///
    /// # Errors
    /// When the file cannot be made, or the size is none.
    pub(crate) fn create(path: &Path, width: u32, height: u32) -> Result<Self, PictureFileError> {
        let draft = Draft::create(path)?;
        let file = draft.file().map_err(draft.error())?;
        let begun = encoder(file, width, height).write_header();
        let pixels = begun.and_then(Writer::into_stream_writer).map_err(refused())?;
        Ok(Self { draft, pixels, count: PixelCount::new("picture", width, height) })
    }

    /// Writes the next pixels, four bytes each.
    pub(crate) fn write_bytes(&mut self, rgba: &[u8]) -> Result<(), PictureFileError> {
        self.count.add(rgba.len() / 4)?;
        self.pixels.write_all(rgba).map_err(self.draft.error())
    }

    /// Moves the file to its place.
    pub(crate) fn finish(self) -> Result<(), PictureFileError> {
        self.count.finish()?;
        self.pixels.finish().map_err(refused())?;
        self.draft.keep()
    }
}

impl std::fmt::Debug for PngFile {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("PngFile").field("draft", &self.draft).finish_non_exhaustive()
    }
}

/// Encodes an image as PNG: eight bits a channel, sRGB.
///
/// # Errors
/// When the image's size and its bytes do not agree.
pub fn encode_png(image: &Image) -> Result<Vec<u8>, PictureFileError> {
    encode_png_with(image, |_| Ok(()))
}

/// The same with what is added to the file's start.
pub(crate) fn encode_png_with(
    image: &Image,
    add: impl FnOnce(&mut Encoder<'_, &mut Vec<u8>>) -> Result<(), EncodingError>,
) -> Result<Vec<u8>, PictureFileError> {
    let mut count = PixelCount::new("picture", image.width, image.height);
    count.add(image.rgba.len() / 4)?;
    count.finish()?;
    let mut bytes = Vec::new();
    let mut encoder = encoder(&mut bytes, image.width, image.height);
    let written = add(&mut encoder).and_then(|()| encoder.write_header()).and_then(|mut writer| {
        let mut pixels = writer.stream_writer()?;
        pixels.write_all(&image.rgba)?;
        pixels.finish()?;
        writer.finish()
    });
    written.map_err(refused())?;
    Ok(bytes)
}

/// Encodes quickly: a picture is drawn in less time than it takes to find its smallest file.
fn encoder<W: Write>(out: W, width: u32, height: u32) -> Encoder<'static, W> {
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    encoder
}

/// To be given the encoder's reason.
fn refused() -> impl FnOnce(EncodingError) -> PictureFileError {
    PictureFileError::encode("a PNG")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use metaball_core::Color;

    use super::*;
    use crate::{PictureFile, write_picture};

    fn pixels(count: u8) -> Vec<Color> {
        (0..count).map(|index| Color::srgb(index, 255 - index, 7 * (index % 9))).collect()
    }

    #[test]
    fn a_png_reads_back() {
        let image = Image::new(2, 1, &[Color::srgb(255, 0, 0), Color::srgb(0, 128, 0)]);
        let png = encode_png(&image).expect("encoded");
        let back = image::load_from_memory(&png).expect("a PNG").into_rgba8();
        assert_eq!((back.dimensions(), back.into_raw()), ((2, 1), image.rgba.clone()));
        let broken = Image { width: 2, height: 2, ..image };
        let error = encode_png(&broken).expect_err("refused").to_string();
        assert_eq!(error, "picture: needed 2 × 2 pixels, found 2");
    }

    #[test]
    fn parts_make_the_whole() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("parts.png");
        let pixels = pixels(7 * 9);
        let whole = encode_png(&Image::new(7, 9, &pixels)).expect("encoded");
        for part in [1, 4, 7, 21, 63] {
            let mut file = PictureFile::create(&path, 7, 9).expect("begun");
            for pixels in pixels.chunks(part) {
                file.write(pixels).expect("written");
            }
            file.finish().expect("finished");
            assert_eq!(fs::read(&path).expect("readable"), whole, "parts of {part}");
        }
        let image = Image::new(7, 9, &pixels);
        write_picture(&path, &image).expect("written");
        assert_eq!(fs::read(&path).expect("readable"), whole);
        let odd = Image { rgba: image.rgba[..250].to_vec(), ..image };
        assert!(write_picture(&path, &odd).is_err() && encode_png(&odd).is_err());
        assert_eq!(fs::read(&path).expect("the one before"), whole);
    }

    #[test]
    fn half_a_picture_is_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("half.png");
        let pixels = pixels(7 * 9);
        let half = || {
            let mut file = PictureFile::create(&path, 7, 9).expect("begun");
            file.write(&pixels[..30]).expect("written");
            file
        };
        drop(half());
        let error = half().finish().expect_err("incomplete").to_string();
        assert_eq!(error, "picture: needed 7 × 9 pixels, found 30");
        let error = half().write(&pixels).expect_err("too many").to_string();
        assert_eq!(error, "picture: needed 7 × 9 pixels, found 93");
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 0);
    }
}
