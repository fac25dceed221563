//! A PNG's text: a chunk iTXt of the keyword Description.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use ::png::Decoder;
use metaball_core::Image;

use crate::PictureFileError;
use crate::png::encode_png_with;

const KEYWORD: &str = "Description";

/// Encodes an image with a text.
pub(super) fn encode(image: &Image, text: &str) -> Result<Vec<u8>, PictureFileError> {
    encode_png_with(image, |png| png.add_itxt_chunk(KEYWORD.to_owned(), text.to_owned()))
}

/// The text in a whole file.
pub(super) fn text_in(path: &Path) -> Option<String> {
    let mut reader = Decoder::new(BufReader::new(File::open(path).ok()?)).read_info().ok()?;
    let mut pixels = vec![0; reader.output_buffer_size()?];
    reader.next_frame(&mut pixels).ok()?;
    reader.finish().ok()?;
    let texts = &reader.info().utf8_text;
    texts.iter().find(|text| text.keyword == KEYWORD)?.get_text().ok()
}
