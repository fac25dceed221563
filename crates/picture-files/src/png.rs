//! Pictures as PNG.

use std::io::Cursor;

use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use metaball_core::Image;

use crate::PictureFileError;

/// Encodes an image as PNG: eight bits a channel, sRGB.
///
/// # Errors
/// When the image's size and its bytes do not agree.
pub fn encode_png(image: &Image) -> Result<Vec<u8>, PictureFileError> {
    check_size(image)?;
    let mut png = Cursor::new(Vec::new());
    PngEncoder::new(&mut png)
        .write_image(&image.rgba, image.width, image.height, ExtendedColorType::Rgba8)
        .map_err(PictureFileError::encode("a PNG"))?;
    Ok(png.into_inner())
}

/// Whether there are four bytes for each pixel.
pub(crate) fn check_size(image: &Image) -> Result<(), PictureFileError> {
    let (needed, found) = (image.width as usize * image.height as usize * 4, image.rgba.len());
    if found == needed {
        return Ok(());
    }
    Err(PictureFileError::Size {
        what: format!("picture of {} × {}", image.width, image.height),
        needed: format!("{needed} bytes"),
        found,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_png_reads_back() {
        let rgba = vec![255, 0, 0, 255, 0, 128, 0, 255];
        let image = Image { width: 2, height: 1, rgba };
        let png = encode_png(&image).expect("encoded");
        let back = image::load_from_memory(&png).expect("a PNG").into_rgba8();
        assert_eq!((back.dimensions(), back.into_raw()), ((2, 1), image.rgba.clone()));
        let broken = Image { width: 2, height: 2, ..image };
        let error = encode_png(&broken).expect_err("refused").to_string();
        assert_eq!(error, "picture of 2 × 2: needed 16 bytes, found 8");
    }
}
