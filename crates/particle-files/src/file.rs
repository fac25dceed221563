//! Files by name: their ending, and their bytes.

use std::borrow::Cow;
use std::io::{self, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::error::{Flaw, LoadError};

/// The name that stands for standard input.
pub(crate) const STANDARD_INPUT: &str = "-";

/// What a file's name ends in, in lower case and without the dot. A `.gz` or `.zst` after it is left out.
pub(crate) fn ending(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
    let unpacked = [".gz", ".zst"].iter().find_map(|packing| name.strip_suffix(packing));
    let (_, ending) = unpacked.unwrap_or(&name).rsplit_once('.')?;
    Some(ending.to_owned())
}

/// How a file is called in messages.
pub(crate) fn named(path: &Path) -> String {
    if path == Path::new(STANDARD_INPUT) {
        return "standard input".to_owned();
    }
    path.display().to_string()
}

/// The bytes of a file, unpacked.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, LoadError> {
    let bytes = if path == Path::new(STANDARD_INPUT) {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        std::fs::read(path)
    };
    let bytes = bytes.map_err(|source| unreadable(path, source))?;
    Ok(unpacked(path, bytes.into())?.into_owned())
}

fn unreadable(path: &Path, source: io::Error) -> LoadError {
    let names_many = path.file_name().is_some_and(|name| name.to_string_lossy().contains('%'));
    if names_many && source.kind() == io::ErrorKind::NotFound {
        return Flaw::needed("the name of one file", "a pattern of many")
            .or("animate draws them all; for one picture name one of them")
            .in_file(&named(path));
    }
    LoadError::Read { file: named(path), source }
}

/// The bytes of a file of that name, unpacked where they are packed, once or twice.
pub(crate) fn unpacked<'a>(path: &Path, bytes: Cow<'a, [u8]>) -> Result<Cow<'a, [u8]>, LoadError> {
    let bytes = unpacked_once(path, unpacked_once(path, bytes)?)?;
    match other_packing_of(&bytes) {
        Some(packing) => Err(other_packing(path, packing)),
        None => Ok(bytes),
    }
}

fn unpacked_once<'a>(path: &Path, bytes: Cow<'a, [u8]>) -> Result<Cow<'a, [u8]>, LoadError> {
    let mut unpacked = Vec::new();
    let read = match *bytes {
        [0x1f, 0x8b, ..] => MultiGzDecoder::new(&*bytes).read_to_end(&mut unpacked),
        [0x28, 0xb5, 0x2f, 0xfd, ..] => unpack_zstd(&bytes, &mut unpacked),
        _ => return Ok(bytes),
    };
    match read {
        Ok(_) => Ok(unpacked.into()),
        Err(source) => Err(LoadError::Read { file: named(path), source }),
    }
}

/// A packing that is not read.
fn other_packing_of(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [b'B', b'Z', b'h', b'1'..=b'9', ..] => Some("bzip2"),
        [0xfd, b'7', b'z', b'X', b'Z', ..] => Some("xz"),
        [b'7', b'z', 0xbc, 0xaf, ..] => Some("7z"),
        [b'P', b'K', 3, 4, ..] if !is_npz(bytes) => Some("zip"),
        _ if bytes.get(257..262) == Some(b"ustar") => Some("tar"),
        _ => None,
    }
}

/// Whether the first file of a zip archive is an array of NumPy.
fn is_npz(bytes: &[u8]) -> bool {
    let length = bytes.get(26..28).map_or(0, |length| u16::from_le_bytes([length[0], length[1]]));
    let name = bytes.get(30..30 + usize::from(length)).unwrap_or_default();
    name.ends_with(b".npy")
}

/// All frames of a zstd file, one behind the other.
fn unpack_zstd(mut packed: &[u8], unpacked: &mut Vec<u8>) -> io::Result<usize> {
    while !packed.is_empty() {
        let mut decoder =
            ruzstd::decoding::StreamingDecoder::new(&mut packed).map_err(io::Error::other)?;
        decoder.read_to_end(unpacked)?;
    }
    Ok(unpacked.len())
}

fn other_packing(path: &Path, packing: &str) -> LoadError {
    Flaw::needed("a file that is plain, or packed with gzip or zstd", packing)
        .or(format!("unpack it and pack it with gzip, or read it from {packing} with -"))
        .in_file(&named(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_are_those_before_packing() {
        for (name, expected) in
            [("b.CIF.gz", "cif"), ("a/b.xyz.zst", "xyz"), ("c.csv", "csv"), ("d.csv.bz2", "bz2")]
        {
            assert_eq!(ending(Path::new(name)).as_deref(), Some(expected));
        }
        assert_eq!(ending(Path::new("csv")), None);
    }

    #[test]
    fn a_pattern_is_told_from_a_file() {
        let message = |name: &str| read(Path::new(name)).expect_err("missing").to_string();
        assert!(message("frame-%04d.xyz").contains("animate draws them all"));
        assert_eq!(message("frame.xyz"), "cannot read frame.xyz");
    }

    #[test]
    fn other_packings_are_named() {
        let error = unpacked(Path::new("a.pdb.bz2"), b"BZh91AY"[..].into()).expect_err("refused");
        assert!(error.to_string().contains("gzip or zstd, found bzip2"), "{error}");
        let mut zip = b"PK\x03\x04".to_vec();
        zip.resize(30, 0);
        zip[26] = 5;
        let refused = |bytes: &[u8]| {
            let unpacked = unpacked(Path::new("a"), bytes.into());
            unpacked.map(Cow::into_owned).map_err(|error| error.to_string())
        };
        assert!(refused(&[&zip[..], b"a.csv"].concat()).is_err_and(|error| error.contains("zip")));
        assert!(refused(&[&zip[..], b"a.npy"].concat()).is_ok());
        let tar = [&[b'a'; 257][..], b"ustar"].concat();
        assert!(refused(&tar).is_err_and(|error| error.contains("found tar")));
    }

    #[test]
    fn what_is_packed_twice_is_unpacked() {
        use std::io::Write;
        let pack = |bytes: &[u8]| {
            let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
            packer.write_all(bytes).expect("memory");
            packer.finish().expect("memory")
        };
        let twice = pack(&pack(b"x,y,z"));
        let bytes = unpacked(Path::new("a.csv.gz"), Cow::Borrowed(&twice)).expect("legal");
        assert_eq!(*bytes, *b"x,y,z");
    }
}
