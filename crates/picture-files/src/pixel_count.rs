//! A picture that comes in parts has exactly its pixels.

use crate::PictureFileError;

/// Counts what is written of a picture, and knows how much there should be.
#[derive(Debug)]
pub(crate) struct PixelCount {
    what: &'static str,
    width: u32,
    height: u32,
    written: usize,
}

impl PixelCount {
    /// Of a picture's `what`, such as `hits`, nothing is written.
    pub(crate) fn new(what: &'static str, width: u32, height: u32) -> Self {
        Self { what, width, height, written: 0 }
    }

    /// So many pixels more.
    pub(crate) fn add(&mut self, pixels: usize) -> Result<(), PictureFileError> {
        self.written += pixels;
        if self.written > self.needed() { Err(self.error()) } else { Ok(()) }
    }

    /// Whether that was all.
    pub(crate) fn finish(&self) -> Result<(), PictureFileError> {
        if self.written == self.needed() { Ok(()) } else { Err(self.error()) }
    }

    fn needed(&self) -> usize {
        self.width as usize * self.height as usize
    }

    fn error(&self) -> PictureFileError {
        PictureFileError::Size {
            what: self.what.to_owned(),
            needed: format!("{} × {} pixels", self.width, self.height),
            found: self.written,
        }
    }
}
