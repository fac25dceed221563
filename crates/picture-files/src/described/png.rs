//! A PNG's text: a chunk iTXt of the keyword Description.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use ::png::Decoder;
use metaball_core::Image;

use super::WholePicture;
use crate::PictureFileError;
use crate::png::encode_png_with;

const KEYWORD: &str = "Description";

/// Encodes an image with a text.
pub(super) fn encode(image: &Image, text: &str) -> Result<Vec<u8>, PictureFileError> {
    encode_png_with(image, |png| png.add_itxt_chunk(KEYWORD.to_owned(), text.to_owned()))
}

/// The picture in a whole file.
pub(super) fn whole(path: &Path) -> Option<WholePicture> {
    let mut reader = Decoder::new(BufReader::new(File::open(path).ok()?)).read_info().ok()?;
    let mut pixels = vec![0; reader.output_buffer_size()?];
    reader.next_frame(&mut pixels).ok()?;
    reader.finish().ok()?;
    let texts = &reader.info().utf8_text;
    let text = texts.iter().find(|text| text.keyword == KEYWORD);
    let description = text.and_then(|text| text.get_text().ok());
    Some(WholePicture { size: reader.info().size(), description })
}
