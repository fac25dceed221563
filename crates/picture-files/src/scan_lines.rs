//! OpenEXR, block by block of scan lines.

use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

use exr::block::{BlockIndex, UncompressedBlock};
use exr::meta::attribute::{ChannelDescription, Compression, LineOrder, SampleType};
use exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use exr::meta::{BlockDescription, Headers, MetaData, compute_chunk_count, magic_number};
use exr::prelude::{Vec2, attribute::ChannelList};
use rayon::prelude::*;

use crate::PictureFileError;
use crate::draft::Draft;
use crate::pixel_count::PixelCount;

/// Few bytes: blocks of sixteen scan lines, zipped.
const COMPRESSION: Compression = Compression::ZIP16;

/// An OpenEXR file of N channels of f32 on its way to the disk: its pixels come in parts, and no more
/// of them is held than the part written last and a block.
#[derive(Debug)]
pub(crate) struct ScanLines<const N: usize> {
    draft: Draft,
    file: File,
    headers: Headers,
    width: usize,
    count: PixelCount,
    /// Pixels of blocks that are not complete.
    pending: Vec<[f32; N]>,
    /// Scan lines in the file.
    lines: usize,
    /// Where the table of blocks begins, the blocks, and the next of them: bytes from the file's start.
    table: u64,
    blocks: Vec<u64>,
    end: u64,
}

impl<const N: usize> ScanLines<N> {
    /// A file of a picture's `what`, with channels of these names in alphabetical order.
    pub(crate) fn create(
        path: &Path,
        what: &'static str,
        (width, height): (u32, u32),
        channels: [&str; N],
    ) -> Result<Self, PictureFileError> {
        let draft = Draft::create(path)?;
        let mut file = draft.file().map_err(draft.error())?;
        let header = header((width as usize, height as usize), channels);
        let table_bytes = header.chunk_count * size_of::<u64>();
        let headers = Headers::from_iter([header]);
        let mut start = start_of_file(&headers).map_err(encode_error(path))?;
        let table = start.len() as u64;
        start.resize(start.len() + table_bytes, 0);
        file.write_all(&start).map_err(draft.error())?;
        Ok(Self {
            draft,
            file,
            headers,
            width: width as usize,
            count: PixelCount::new(what, width, height),
            pending: Vec::new(),
            lines: 0,
            table,
            blocks: Vec::new(),
            end: start.len() as u64,
        })
    }

    /// Writes the next pixels, row by row from the top left: any number of them.
    pub(crate) fn write(
        &mut self,
        pixels: impl ExactSizeIterator<Item = [f32; N]>,
    ) -> Result<(), PictureFileError> {
        self.count.add(pixels.len())?;
        self.pending.extend(pixels);
        let block = self.width * COMPRESSION.scan_lines_per_block();
        let whole = self.pending.len() / block * block;
        self.write_blocks(whole)
    }

    /// Moves the file to its place.
    pub(crate) fn finish(mut self) -> Result<(), PictureFileError> {
        self.count.finish()?;
        self.write_blocks(self.pending.len())?;
        let table: Vec<u8> = self.blocks.iter().flat_map(|at| at.to_le_bytes()).collect();
        let mut write_table = || {
            self.file.seek(SeekFrom::Start(self.table))?;
            self.file.write_all(&table)
        };
        write_table().map_err(self.draft.error())?;
        drop(self.file);
        self.draft.keep()
    }

    /// Writes so many pending pixels, whole blocks or the last of all.
    fn write_blocks(&mut self, pixels: usize) -> Result<(), PictureFileError> {
        let lines = COMPRESSION.scan_lines_per_block();
        let tasks = self.pending[..pixels].par_chunks(self.width * lines).enumerate();
        let encode = |(index, pixels): (usize, &[[f32; N]])| {
            encode_block(&self.headers, self.width, self.lines + index * lines, pixels)
        };
        let blocks: Result<Vec<_>, _> = tasks.map(encode).collect();
        for block in blocks.map_err(encode_error(self.draft.path()))? {
            self.blocks.push(self.end);
            self.end += block.len() as u64;
            self.file.write_all(&block).map_err(self.draft.error())?;
        }
        self.lines += pixels / self.width;
        self.pending.drain(..pixels);
        Ok(())
    }
}

fn encode_error(path: &Path) -> impl FnOnce(exr::error::Error) -> PictureFileError {
    PictureFileError::encode(path.display().to_string())
}

/// One layer without a name.
fn header<const N: usize>(size: (usize, usize), channels: [&str; N]) -> Header {
    let size = Vec2(size.0, size.1);
    let blocks = BlockDescription::ScanLines;
    let channels = channels.map(|name| ChannelDescription::named(name, SampleType::F32));
    Header {
        channels: ChannelList::new(channels.into_iter().collect()),
        compression: COMPRESSION,
        blocks,
        line_order: LineOrder::Increasing,
        layer_size: size,
        deep: false,
        deep_data_version: None,
        chunk_count: compute_chunk_count(COMPRESSION, size, blocks),
        max_samples_per_pixel: None,
        shared_attributes: ImageAttributes::with_size(size),
        own_attributes: LayerAttributes::default(),
    }
}

/// All that stands before the table of blocks.
fn start_of_file(headers: &Headers) -> exr::error::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let requirements = MetaData::validate(headers, true)?;
    magic_number::write(&mut bytes)?;
    requirements.write(&mut bytes)?;
    Header::write_all(headers, &mut bytes, requirements.has_multiple_layers)?;
    Ok(bytes)
}

/// A block of whole scan lines, the first of them the `line`th of the picture.
fn encode_block<const N: usize>(
    headers: &Headers,
    width: usize,
    line: usize,
    pixels: &[[f32; N]],
) -> exr::error::Result<Vec<u8>> {
    let mut numbers = Vec::with_capacity(N * pixels.len());
    for line in pixels.chunks(width) {
        for channel in 0..N {
            numbers.extend(line.iter().map(|pixel| pixel[channel]));
        }
    }
    let block = UncompressedBlock {
        index: BlockIndex {
            layer: 0,
            pixel_position: Vec2(0, line),
            pixel_size: Vec2(width, pixels.len() / width),
            level: Vec2(0, 0),
        },
        data: bytemuck::cast_slice::<f32, u8>(&numbers).to_vec(),
    };
    let mut bytes = Vec::new();
    block.compress_to_chunk(headers)?.write(&mut bytes, headers.len())?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Cursor;

    use exr::prelude::{
        AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, WritableImage,
    };

    use super::*;

    const NAMES: [&str; 3] = ["A", "N.X", "Z"];

    fn pixels(count: u16) -> Vec<[f32; 3]> {
        (0..count).map(|i| [f32::from(i % 7), 1.0 / f32::from(i + 1), -f32::from(i)]).collect()
    }

    /// The same file by the library's writer of whole pictures.
    fn whole(size: (usize, usize), pixels: &[[f32; 3]]) -> Vec<u8> {
        let channel = |index: usize| {
            let samples = pixels.iter().map(|pixel| pixel[index]).collect();
            AnyChannel::new(NAMES[index], FlatSamples::F32(samples))
        };
        let channels = AnyChannels::sort((0..3).map(channel).collect());
        let attributes = LayerAttributes::default();
        let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels);
        let mut file = Cursor::new(Vec::new());
        Image::from_layer(layer).write().to_buffered(&mut file).expect("encoded");
        file.into_inner()
    }

    #[test]
    fn parts_make_the_whole() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("parts.exr");
        for (width, height) in [(5, 1), (5, 16), (5, 37)] {
            let pixels = pixels(width * height);
            let whole = whole((width.into(), height.into()), &pixels);
            for part in [1, 5, 40, 1000] {
                let size = (u32::from(width), u32::from(height));
                let mut file = ScanLines::create(&path, "numbers", size, NAMES).expect("begun");
                for pixels in pixels.chunks(part) {
                    file.write(pixels.iter().copied()).expect("written");
                }
                file.finish().expect("finished");
                let found = fs::read(&path).expect("readable");
                assert!(found == whole, "{height} lines in parts of {part} pixels");
            }
        }
    }

    #[test]
    fn half_a_picture_is_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("half.exr");
        let half = || {
            let mut file = ScanLines::create(&path, "numbers", (5, 40), NAMES).expect("begun");
            file.write(pixels(120).into_iter()).expect("written");
            file
        };
        drop(half());
        let error = half().finish().expect_err("incomplete").to_string();
        assert_eq!(error, "numbers: needed 5 × 40 pixels, found 120");
        let error = half().write(pixels(81).into_iter()).expect_err("too many").to_string();
        assert_eq!(error, "numbers: needed 5 × 40 pixels, found 201");
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 0);
    }
}
