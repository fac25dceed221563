//! ZIP archives, as far as NumPy writes them: files stored or deflated, of any size.

use std::borrow::Cow;
use std::io::Read;

use flate2::Crc;
use flate2::read::DeflateDecoder;
use memchr::memmem;

use crate::error::Flaw;
use crate::notes::counted;
use crate::text::word;

/// What every file in an archive begins with.
pub(crate) const MAGIC: &[u8] = b"PK\x03\x04";

/// A file in an archive.
#[derive(Debug)]
pub(crate) struct Entry<'a> {
    pub(crate) name: String,
    is_encrypted: bool,
    method: u16,
    crc: u32,
    size: u64,
    packed: &'a [u8],
    /// Where its directory has it.
    at: usize,
}

/// The files of an archive, by its directory.
pub(crate) fn entries(bytes: &[u8]) -> Result<Vec<Entry<'_>>, Flaw> {
    let cut = || Flaw::needed("the directory at the end of a ZIP archive", "the end of the file");
    let end = memmem::rfind(bytes, b"PK\x05\x06").ok_or_else(cut)?;
    let record = Fields(bytes.get(end..).ok_or_else(cut)?);
    let (mut count, mut start) = (record.of(10, 2), record.of(16, 4));
    // Where archives are large, another record with wider numbers stands before.
    let locator = end.checked_sub(20).and_then(|at| bytes.get(at..end));
    if let Some(locator) = locator.filter(|locator| locator.starts_with(b"PK\x06\x07")) {
        let at = usize::try_from(Fields(locator).of(8, 8)?).ok();
        let record = Fields(at.and_then(|at| bytes.get(at..)).ok_or_else(cut)?);
        (count, start) = (record.of(32, 8), record.of(48, 8));
    }
    let (count, mut at) = (count?, usize::try_from(start?).map_err(|_| cut())?);
    let mut entries = Vec::new();
    for _ in 0..count {
        let record = Fields(bytes.get(at..).unwrap_or_default());
        if !record.0.starts_with(b"PK\x01\x02") {
            let needed = format!("{count} files in the directory of the archive");
            return Err(Flaw::needed(&needed, entries.len()).at_byte(at));
        }
        let (entry, length) = Entry::of(bytes, record, at).map_err(|flaw| flaw.at_byte(at))?;
        entries.push(entry);
        at += length;
    }
    // Files that share their bytes would unpack to far more than an archive holds.
    let packed = entries.iter().map(|entry| entry.packed.len()).fold(0, usize::saturating_add);
    if packed > bytes.len() {
        let needed = format!("files of up to {} in the archive", counted(bytes.len(), "byte"));
        return Err(Flaw::needed(&needed, packed));
    }
    Ok(entries)
}

/// Bytes with numbers in them whose least significant byte comes first.
#[derive(Clone, Copy)]
struct Fields<'a>(&'a [u8]);

impl Fields<'_> {
    /// The number of so many bytes at an offset.
    fn of(&self, at: usize, size: usize) -> Result<u64, Flaw> {
        let bytes = self.0.get(at..).and_then(|rest| rest.get(..size));
        let bytes = bytes.ok_or_else(|| {
            Flaw::needed("a whole record of a ZIP archive", "the end of the file")
        })?;
        Ok(bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte)))
    }
}

impl<'a> Entry<'a> {
    /// An entry of the directory, and its length there.
    fn of(bytes: &'a [u8], record: Fields<'_>, at: usize) -> Result<(Self, usize), Flaw> {
        let [name, extra, comment] =
            [record.of(28, 2)?, record.of(30, 2)?, record.of(32, 2)?].map(|length| length as usize);
        let length = 46 + name + extra + comment;
        let cut = || Flaw::needed("a whole entry of a ZIP directory", "the end of the file");
        let text = record.0.get(46..46 + name + extra).ok_or_else(cut)?;
        let (name, extra) = text.split_at(name);
        let numbers = [record.of(24, 4)?, record.of(20, 4)?, record.of(42, 4)?];
        let [size, packed, offset] = wide(numbers, extra)?;
        let name = word(name).into_owned();
        let data = data(bytes, offset, packed).ok_or_else(|| {
            let needed = format!("{} of {name:?}", counted(packed as usize, "byte"));
            Flaw::needed(&needed, "the end of the file")
        })?;
        let entry = Self {
            name,
            is_encrypted: record.of(8, 2)? & 1 == 1,
            method: record.of(10, 2)? as u16,
            crc: record.of(16, 4)? as u32,
            size,
            packed: data,
            at,
        };
        Ok((entry, length))
    }

    /// Its bytes, unpacked.
    pub(crate) fn unpacked(&self) -> Result<Cow<'a, [u8]>, Flaw> {
        self.unpack().map_err(|flaw| flaw.at_byte(self.at).at_key(&self.name))
    }

    fn unpack(&self) -> Result<Cow<'a, [u8]>, Flaw> {
        let bytes = match self.method {
            _ if self.is_encrypted => {
                return Err(Flaw::needed("a file without a password", "an encrypted one"));
            }
            0 => Cow::Borrowed(self.packed),
            8 => {
                let mut bytes = Vec::new();
                let mut decoder =
                    DeflateDecoder::new(self.packed).take(self.size.saturating_add(1));
                let read = decoder.read_to_end(&mut bytes);
                read.map_err(|error| Flaw::needed("deflated bytes", error))?;
                Cow::Owned(bytes)
            }
            other => {
                return Err(Flaw::needed(
                    "a file that is stored or deflated",
                    format_args!("method {other}"),
                ));
            }
        };
        if bytes.len() as u64 != self.size {
            return Err(Flaw::needed(&format!("{} bytes", self.size), bytes.len()));
        }
        let mut crc = Crc::new();
        crc.update(&bytes);
        match crc.sum() == self.crc {
            true => Ok(bytes),
            false => Err(Flaw::needed("bytes of the checksum that the archive says", "others")),
        }
    }
}

/// Size, packed size and offset: those that do not fit into 32 bits stand in an extra field.
fn wide(mut numbers: [u64; 3], mut extra: &[u8]) -> Result<[u64; 3], Flaw> {
    while extra.len() >= 4 {
        let (id, length) = (Fields(extra).of(0, 2)?, Fields(extra).of(2, 2)? as usize);
        if id == 1 {
            let mut at = 4;
            for number in numbers.iter_mut().filter(|number| **number == u64::from(u32::MAX)) {
                *number = Fields(extra).of(at, 8)?;
                at += 8;
            }
            break;
        }
        extra = extra.get(4 + length..).unwrap_or_default();
    }
    Ok(numbers)
}

/// The packed bytes of a file whose own header is at an offset.
fn data(bytes: &[u8], offset: u64, packed: u64) -> Option<&[u8]> {
    let header = bytes.get(usize::try_from(offset).ok()?..)?;
    let skipped = 30 + Fields(header).of(26, 2).ok()? + Fields(header).of(28, 2).ok()?;
    header.get(skipped as usize..)?.get(..usize::try_from(packed).ok()?)
}

#[cfg(test)]
pub(crate) mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::DeflateEncoder;
    use proptest::prelude::*;

    use super::*;

    /// An archive of these files, as NumPy writes it: sizes in an extra field of 64 bits.
    pub(crate) fn archive(files: &[(&str, &[u8])], is_deflated: bool) -> Vec<u8> {
        let (mut bytes, mut directory) = (Vec::new(), Vec::new());
        for (name, content) in files {
            let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(content).expect("a Vec takes all bytes");
            let packed = match is_deflated {
                true => encoder.finish().expect("a Vec takes all bytes"),
                false => content.to_vec(),
            };
            let method: u16 = if is_deflated { 8 } else { 0 };
            let mut crc = Crc::new();
            crc.update(content);
            let offset = bytes.len() as u32;
            let sizes = [content.len() as u64, packed.len() as u64].map(u64::to_le_bytes).concat();
            let extra = [&[1, 0, 16, 0], &sizes[..]].concat();
            let middle = [
                &method.to_le_bytes()[..],
                &[0; 4],
                &crc.sum().to_le_bytes(),
                &[0xff; 8],
                &(name.len() as u16).to_le_bytes(),
                &(extra.len() as u16).to_le_bytes(),
            ]
            .concat();
            bytes.extend(
                [MAGIC, &[45, 0, 0, 0], &middle, name.as_bytes(), &extra, &packed].concat(),
            );
            let end = [&[0; 10][..], &offset.to_le_bytes(), name.as_bytes(), &extra].concat();
            directory
                .extend([b"PK\x01\x02".as_slice(), &[45, 0, 45, 0, 0, 0], &middle, &end].concat());
        }
        let start = bytes.len() as u32;
        let count = (files.len() as u16).to_le_bytes();
        bytes.extend(&directory);
        bytes.extend([b"PK\x05\x06".as_slice(), &[0; 4], &count, &count].concat());
        bytes.extend([(directory.len() as u32).to_le_bytes(), start.to_le_bytes()].concat());
        bytes.extend([0; 2]);
        bytes
    }

    fn read(bytes: &[u8]) -> Result<Vec<(String, Vec<u8>)>, Flaw> {
        let file = |entry: Entry<'_>| Ok((entry.name.clone(), entry.unpacked()?.into_owned()));
        entries(bytes)?.into_iter().map(file).collect()
    }

    const FILES: [(&str, &[u8]); 2] = [("a.npy", b"aaaaaaaaaaaaaaaaaaaaaaaa"), ("b.npy", b"")];

    #[test]
    fn files_are_unpacked() {
        for is_deflated in [false, true] {
            let read = read(&archive(&FILES, is_deflated)).expect("legal");
            let expected = FILES.map(|(name, bytes)| (name.to_owned(), bytes.to_vec()));
            assert_eq!(read, expected);
        }
    }

    #[test]
    fn damage_is_found() {
        let good = archive(&FILES, false);
        let mut other = good.clone();
        let at = memmem::find(&good, b"aaaa").expect("is there");
        other[at] = b'b';
        let problem = |bytes: &[u8]| read(bytes).expect_err("refused").problem;
        assert!(problem(&other).contains("checksum"));
        assert!(problem(&good[..good.len() - 30]).contains("needed the directory"));
        let mut other = good.clone();
        other[good.len() - 12] = 3;
        assert_eq!(problem(&other), "needed 3 files in the directory of the archive, found 2");
        let mut other = archive(&FILES, true);
        let at = memmem::find(&other, b"PK\x01\x02").expect("is there") + 10;
        other[at] = 12;
        assert!(problem(&other).contains("stored or deflated, found method 12"));
        other[at - 2] = 1;
        assert!(problem(&other).contains("without a password"));
    }

    proptest! {
        #[test]
        fn no_mutated_archive_panics(at: prop::sample::Index, byte: u8, cut: prop::sample::Index) {
            for is_deflated in [false, true] {
                let mut bytes = archive(&FILES, is_deflated);
                let cut = cut.index(bytes.len());
                let at = at.index(bytes.len());
                bytes[at] = byte;
                let _ = (read(&bytes), read(&bytes[..cut]), read(&bytes[cut..]));
            }
        }
    }
}
