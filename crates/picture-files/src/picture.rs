//! Pictures, in the format that their path's ending names.

use std::path::Path;

use metaball_core::{Color, Image};

use crate::ending::named_format;
use crate::jpeg::JpegFile;
use crate::png::PngFile;
use crate::{PictureFileError, jpeg};

/// A format of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PictureFormat {
    Png,
    Jpeg,
}

impl PictureFormat {
    /// By the ending of a path.
    pub(crate) fn of(path: &Path) -> Result<Self, PictureFileError> {
        let formats = [("png", Self::Png), ("jpg", Self::Jpeg), ("jpeg", Self::Jpeg)];
        named_format(path, &formats, "a picture, .png, .jpg or .jpeg")
    }

    /// The same for a picture of so many pixels across and down, which the format can have.
    pub(crate) fn of_size(path: &Path, width: u32, height: u32) -> Result<Self, PictureFileError> {
        let format = Self::of(path)?;
        if format == Self::Jpeg && width.max(height) > jpeg::LONGEST_SIDE {
            return Err(PictureFileError::Content {
                path: path.to_owned(),
                needed: "a .png, since a JPEG has at most 65,535 pixels a side",
                found: format!("{width} × {height} pixels"),
            });
        }
        Ok(format)
    }
}

/// A picture on its way to the disk, known by its ending: `.png`, or `.jpg` and `.jpeg` of quality 95;
/// eight bits a channel, sRGB. What is no regular file and has no ending gets a PNG.
///
/// Its pixels come in parts, row by row from the top left. Of a PNG the part written last is all that is
/// held; a JPEG is held whole, three bytes a pixel, and has at most 65,535 pixels a side.
/// [`finish`](Self::finish) moves the file to its place; dropped before, it is removed.
#[derive(Debug)]
pub struct PictureFile(Encoder);

#[derive(Debug)]
enum Encoder {
    Png(Box<PngFile>),
    Jpeg(JpegFile),
}

impl PictureFile {
    /// A file of this size, and of the format that its ending names.
    ///
    /// # Errors
    /// When the ending is another, the format has no such size, or the file cannot be made.
    pub fn create(path: &Path, width: u32, height: u32) -> Result<Self, PictureFileError> {
        Ok(Self(match PictureFormat::of_size(path, width, height)? {
            PictureFormat::Png => Encoder::Png(PngFile::create(path, width, height)?.into()),
            PictureFormat::Jpeg => Encoder::Jpeg(JpegFile::create(path, width, height)?),
        }))
    }

    /// Writes the next pixels, any number of them.
    ///
    /// # Errors
    /// When they are more than are left, or cannot be written.
    pub fn write(&mut self, pixels: &[Color]) -> Result<(), PictureFileError> {
        self.write_bytes(bytemuck::cast_slice(pixels))
    }

    /// Moves the file to its place.
    ///
    /// # Errors
    /// When pixels are missing, or the file cannot be written.
    pub fn finish(self) -> Result<(), PictureFileError> {
        match self.0 {
            Encoder::Png(file) => file.finish(),
            Encoder::Jpeg(file) => file.finish(),
        }
    }

    /// Four bytes a pixel.
    fn write_bytes(&mut self, rgba: &[u8]) -> Result<(), PictureFileError> {
        match &mut self.0 {
            Encoder::Png(file) => file.write_bytes(rgba),
            Encoder::Jpeg(file) => file.write_bytes(rgba),
        }
    }
}

/// Writes an image as a [`PictureFile`].
///
/// # Errors
/// When the image's size and its bytes do not agree, the ending is another, or the file cannot be
/// written.
pub fn write_picture(path: &Path, image: &Image) -> Result<(), PictureFileError> {
    let mut file = PictureFile::create(path, image.width, image.height)?;
    file.write_bytes(&image.rgba)?;
    file.finish()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn the_ending_says_the_format() {
        let folder = tempfile::tempdir().expect("a folder");
        let image = Image::new(2, 1, &[Color::srgb(255, 0, 0), Color::srgb(0, 128, 0)]);
        let starts = [("a.png", &b"\x89PNG"[..]), ("a.PNG", b"\x89PNG")];
        for (name, start) in starts.into_iter().chain([("a.jpg", &b"\xff\xd8"[..])]) {
            let path = folder.path().join(name);
            write_picture(&path, &image).expect("written");
            assert!(fs::read(&path).expect("written").starts_with(start), "{name}");
            fs::remove_file(&path).expect("removed");
        }
        for (name, found) in
            [("a.gif", ".gif"), ("a.exr", ".exr"), ("a", "no ending"), ("a.", "found .")]
        {
            let path = folder.path().join(name);
            let error = write_picture(&path, &image).expect_err("refused").to_string();
            let needed = "needed a picture, .png, .jpg or .jpeg, found ";
            assert!(error.contains(needed) && error.ends_with(found), "{error}");
        }
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 0);
    }

    #[test]
    fn sizes_fit_the_format() {
        let of = |path: &str, width| {
            let format = PictureFormat::of_size(Path::new(path), width, 1);
            format.map_err(|error| error.to_string())
        };
        assert_eq!(of("a.jpg", 65_535), Ok(PictureFormat::Jpeg));
        assert_eq!(of("a.png", 65_536), Ok(PictureFormat::Png));
        let error = of("a.jpg", 65_536).expect_err("too long");
        assert!(error.ends_with("at most 65,535 pixels a side, found 65536 × 1 pixels"), "{error}");
    }
}
