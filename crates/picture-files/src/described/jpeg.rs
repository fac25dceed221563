//! A JPEG's text: its comments (ITU-T T.81, B.2.4.5), one behind the other, in UTF-8.

use std::fs;
use std::path::Path;

use metaball_core::Image;

use super::WholePicture;
use crate::PictureFileError;
use crate::jpeg::encode_jpeg;

/// Start and end of an image; a comment; the start of a scan.
const START: [u8; 2] = [0xff, 0xd8];
const END: [u8; 2] = [0xff, 0xd9];
const COMMENT: [u8; 2] = [0xff, 0xfe];
const SCAN: [u8; 2] = [0xff, 0xda];

/// Bytes of text in a comment: its length, of two bytes, counts itself.
const LONGEST: usize = u16::MAX as usize - 2;

/// Encodes an image with a text.
pub(super) fn encode(image: &Image, text: &str) -> Result<Vec<u8>, PictureFileError> {
    let mut jpeg = encode_jpeg(image)?;
    // JFIF wants its own segment to be the first.
    let first = Segments::of(&jpeg).next().map_or(START.len(), |segment| segment.end);
    let comments: Vec<u8> = text.as_bytes().chunks(LONGEST).flat_map(comment).collect();
    jpeg.splice(first..first, comments);
    Ok(jpeg)
}

fn comment(text: &[u8]) -> Vec<u8> {
    let length = (text.len() + 2) as u16;
    [&COMMENT, &length.to_be_bytes(), text].concat()
}

/// The picture in a whole file.
pub(super) fn whole(path: &Path) -> Option<WholePicture> {
    let jpeg = fs::read(path).ok()?;
    if !jpeg.ends_with(&END) {
        return None;
    }
    let image = image::load_from_memory_with_format(&jpeg, image::ImageFormat::Jpeg).ok()?;
    let comments = Segments::of(&jpeg).filter(|segment| segment.marker == COMMENT);
    let text: Vec<u8> =
        comments.flat_map(|comment| &jpeg[comment.start..comment.end]).copied().collect();
    let description = String::from_utf8(text).ok().filter(|text| !text.is_empty());
    Some(WholePicture { size: (image.width(), image.height()), description })
}

/// What stands before the first scan.
struct Segment {
    marker: [u8; 2],
    /// Its content: bytes from the file's start.
    start: usize,
    end: usize,
}

struct Segments<'a> {
    jpeg: &'a [u8],
    at: usize,
}

impl<'a> Segments<'a> {
    fn of(jpeg: &'a [u8]) -> Self {
        Self { jpeg, at: if jpeg.starts_with(&START) { START.len() } else { jpeg.len() } }
    }
}

impl Iterator for Segments<'_> {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        let &[ff, kind, high, low] = self.jpeg[self.at..].first_chunk()?;
        let length = usize::from(u16::from_be_bytes([high, low]));
        let segment = Segment { marker: [ff, kind], start: self.at + 4, end: self.at + 2 + length };
        let whole = ff == 0xff && length >= 2 && segment.end <= self.jpeg.len();
        self.at = segment.end.min(self.jpeg.len());
        (whole && segment.marker != SCAN).then_some(segment)
    }
}
