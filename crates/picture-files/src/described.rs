//! Pictures that say what they show: so a run that is resumed knows which frames are its own, and whole.

mod jpeg;
mod png;

use std::path::Path;

use metaball_core::Image;

use crate::picture::PictureFormat;
use crate::{PictureFileError, write_atomically};

/// A file that is a picture to its last byte.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WholePicture {
    /// Pixels across and down.
    pub size: (u32, u32),
    /// What it says it shows, if anything.
    pub description: Option<String>,
}

/// Writes an image, as [`write_picture`](crate::write_picture) does, with a text that
/// [`whole_picture`] finds: in a PNG as the text `Description`, in a JPEG as its comment.
///
/// # Errors
/// When the image's size and its bytes do not agree, the ending is another, or the file cannot be
/// written.
pub fn write_described(path: &Path, image: &Image, text: &str) -> Result<(), PictureFileError> {
    let bytes = match PictureFormat::of_size(path, image.width, image.height)? {
        PictureFormat::Png => png::encode(image, text)?,
        PictureFormat::Jpeg => jpeg::encode(image, text)?,
    };
    write_atomically(path, &bytes)
}

/// The picture in a file; `None` where there is no file, or no whole picture of the format that its ending
/// names.
pub fn whole_picture(path: &Path) -> Option<WholePicture> {
    if !path.is_file() {
        return None;
    }
    match PictureFormat::of(path).ok()? {
        PictureFormat::Png => png::whole(path),
        PictureFormat::Jpeg => jpeg::whole(path),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn image() -> Image {
        let rgba = (0..20 * 20).flat_map(|index| [(index * 37 % 251) as u8, 7, 200, 255]).collect();
        Image { width: 20, height: 20, rgba }
    }

    fn description_in(path: &Path) -> Option<String> {
        whole_picture(path)?.description
    }

    #[test]
    fn only_whole_frames_say_what_they_show() {
        let folder = tempfile::tempdir().expect("a folder");
        let image = image();
        for name in ["frame.png", "frame.jpg"] {
            let path = folder.path().join(name);
            assert_eq!(description_in(&path), None);
            write_described(&path, &image, "frame 1 of Pfütze").expect("written");
            assert_eq!(description_in(&path).as_deref(), Some("frame 1 of Pfütze"));

            let bytes = fs::read(&path).expect("readable");
            for length in [0, 3, 50, bytes.len() / 2, bytes.len() - 13, bytes.len() - 1] {
                fs::write(&path, &bytes[..length]).expect("written");
                assert_eq!(whole_picture(&path), None, "{length} of {} bytes", bytes.len());
            }
            crate::write_picture(&path, &image).expect("written");
            let plain = WholePicture { size: (20, 20), description: None };
            assert_eq!(whole_picture(&path), Some(plain));
            assert!(write_described(&path, &Image { width: 21, ..image.clone() }, "").is_err());
        }
    }

    #[test]
    fn a_text_changes_no_pixel() {
        let folder = tempfile::tempdir().expect("a folder");
        let image = image();
        for name in ["frame.png", "frame.jpg"] {
            let path = folder.path().join(name);
            let pixels = || image::open(&path).expect("a picture").into_rgba8().into_raw();
            crate::write_picture(&path, &image).expect("written");
            let plain = pixels();
            let long = "Pfütze ".repeat(20_000);
            write_described(&path, &image, &long).expect("written");
            assert_eq!(description_in(&path), Some(long));
            assert!(pixels() == plain, "{name}");
        }
    }

    /// Bytes that look like segments do no harm.
    #[test]
    fn no_jpeg_panics() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("frame.jpg");
        write_described(&path, &image(), "a text").expect("written");
        let bytes = fs::read(&path).expect("readable");
        for at in 0..bytes.len().min(700) {
            let mut mutated = bytes.clone();
            mutated[at] = mutated[at].wrapping_add(1 + (at % 255) as u8);
            fs::write(&path, &mutated).expect("written");
            let _ = whole_picture(&path);
        }
    }
}
