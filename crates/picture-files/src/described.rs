//! PNGs that say what they show: so a run that is resumed knows which frames are its own, and whole.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use ::png::Decoder;
use metaball_core::Image;

use crate::PictureFileError;
use crate::png::encode_png_with;

/// Keyword of the text.
const KEYWORD: &str = "Description";

/// Encodes an image, eight bits a channel, with a text that [`description_in_png`] finds.
///
/// # Errors
/// When the image's size and its bytes do not agree.
pub fn encode_described_png(image: &Image, description: &str) -> Result<Vec<u8>, PictureFileError> {
    encode_png_with(image, |png| png.add_itxt_chunk(KEYWORD.to_owned(), description.to_owned()))
}

/// The text in a file; `None` where there is no file, no whole PNG, or no text.
pub fn description_in_png(path: &Path) -> Option<String> {
    let mut reader = Decoder::new(BufReader::new(File::open(path).ok()?)).read_info().ok()?;
    let mut pixels = vec![0; reader.output_buffer_size()?];
    reader.next_frame(&mut pixels).ok()?;
    reader.finish().ok()?;
    let texts = &reader.info().utf8_text;
    texts.iter().find(|text| text.keyword == KEYWORD)?.get_text().ok()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn only_whole_frames_say_what_they_show() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("frame.png");
        assert_eq!(description_in_png(&path), None);

        let rgba: Vec<u8> = (0..4 * 20 * 20).map(|index| (index * 37 % 251) as u8).collect();
        let image = Image { width: 20, height: 20, rgba };
        let bytes = encode_described_png(&image, "frame 1 of Pfütze").expect("encoded");
        fs::write(&path, &bytes).expect("written");
        assert_eq!(description_in_png(&path).as_deref(), Some("frame 1 of Pfütze"));
        let back = image::load_from_memory(&bytes).expect("a PNG").into_rgba8();
        assert_eq!(back.into_raw(), image.rgba);

        for length in [0, 50, bytes.len() / 2, bytes.len() - 13] {
            fs::write(&path, &bytes[..length]).expect("written");
            assert_eq!(description_in_png(&path), None, "{length} of {} bytes", bytes.len());
        }
        let plain = crate::encode_png(&image).expect("encoded");
        fs::write(&path, plain).expect("written");
        assert_eq!(description_in_png(&path), None);
        assert!(encode_described_png(&Image { width: 21, ..image }, "").is_err());
    }
}
