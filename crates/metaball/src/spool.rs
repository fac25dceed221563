//! The finished bands of a picture that is not complete: a file beside it, from which an interrupted run
//! goes on.
//!
//! It begins with [`MAGIC`] and the [`Description`] of the picture, and goes on with one
//! [record](mod@record) a band. Numbers are as the machine has them. What follows the last record that is
//! whole is written anew.

mod description;
mod record;

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use metaball_core::View;
use picture_files::{PictureFileError, Target};

pub(crate) use self::description::Description;
use crate::Error;
use crate::band::{Band, Planes};

/// First bytes of the file.
const MAGIC: &[u8; 16] = b"metaball spool 1";

/// A file of finished bands, locked for as long as it is open.
#[derive(Debug)]
pub(crate) struct Spool {
    /// Its name; where it has none, the folder that it is in.
    path: PathBuf,
    is_named: bool,
    file: File,
    size: (u32, u32),
    planes: Planes,
    /// Where the first record begins, bytes.
    start: u64,
    /// Where the next one will.
    end: u64,
    /// Rows that are finished.
    rows: u32,
}

impl Spool {
    /// The spool of a picture: `picture.png.spool` beside `picture.png`, behind all links; none where the
    /// picture is no regular file.
    fn path_beside(picture: &Path) -> Result<Option<PathBuf>, PictureFileError> {
        Ok(match Target::of(picture)? {
            Target::File(path) => {
                let mut path = path.into_os_string();
                path.push(".spool");
                Some(path.into())
            }
            Target::Stream(_) => None,
        })
    }

    /// Whether there is a spool of a picture.
    pub(crate) fn is_beside(picture: &Path) -> Result<bool, Error> {
        Ok(Self::path_beside(picture)?.is_some_and(|path| path.exists()))
    }

    /// Opens the spool of a view's picture: where `resume` asks for it with the bands that an interrupted
    /// run left, else without any.
    ///
    /// # Errors
    /// When another run has it open; when it holds bands of another picture and `resume` asks for those of
    /// this one; when it holds bands of this very picture and `resume` does not ask for them; when `resume`
    /// asks where none are kept; when it is no spool, or cannot be read or written.
    pub(crate) fn open(
        picture: &Path,
        view: &View,
        planes: Planes,
        description: &Description,
        resume: bool,
    ) -> Result<Self, Error> {
        let size = (view.width(), view.height());
        let spool = |path, is_named, file| Self {
            path,
            is_named,
            file,
            size,
            planes,
            start: 0,
            end: 0,
            rows: 0,
        };
        let Some(path) = Self::path_beside(picture)? else {
            if resume {
                return Err(nothing_kept(picture));
            }
            let folder = std::env::temp_dir();
            let file = tempfile::tempfile_in(&folder).map_err(io_error("write", &folder))?;
            return spool(folder, false, file).begun(description);
        };
        let file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
        let file = file.map_err(io_error("open", &path))?;
        // Where a file system has no locks, there is none to respect.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(Error::SpoolInUse { path });
        }
        let mut spool = spool(path, true, file);
        let Some(found) = spool.description()? else { return spool.begun(description) };
        let Some([what, needed, found]) = description.difference(&found) else {
            spool.recover()?;
            let Self { path, rows, .. } = &spool;
            if *rows == 0 || resume {
                return Ok(spool);
            }
            return Err(Error::Unfinished { path: path.clone(), rows: *rows, height: size.1 });
        };
        if resume {
            return Err(Error::OtherPicture { path: spool.path, what, needed, found });
        }
        spool.begun(description)
    }

    /// Rows that are finished, from the top.
    pub(crate) fn rows(&self) -> u32 {
        self.rows
    }

    /// Adds the band below the last.
    pub(crate) fn append(&mut self, band: &Band) -> Result<(), Error> {
        let record = record::encode(band, self.planes);
        let written =
            self.file.seek(SeekFrom::Start(self.end)).and_then(|_| self.file.write_all(&record));
        written.map_err(io_error("write", &self.path))?;
        self.end += record.len() as u64;
        self.rows = band.rows.end;
        Ok(())
    }

    /// The finished bands, from the top.
    pub(crate) fn bands(&self) -> impl Iterator<Item = Result<Band, Error>> {
        let mut at = self.start;
        std::iter::from_fn(move || {
            (at < self.end).then(|| {
                let (band, bytes) = self.read(at).map_err(io_error("read", &self.path))?;
                at += bytes;
                Ok(band)
            })
        })
    }

    /// Deletes the file: the picture is complete.
    pub(crate) fn remove(self) -> Result<(), Error> {
        let Self { path, is_named, file, .. } = self;
        drop(file);
        if !is_named {
            return Ok(());
        }
        Ok(fs::remove_file(&path).map_err(io_error("remove", &path))?)
    }

    /// What the file says that it is of; `None` where it does not say so yet.
    fn description(&mut self) -> Result<Option<Description>, Error> {
        let mut start = Vec::new();
        let head = (MAGIC.len() + size_of::<u64>()) as u64;
        let read = (&self.file).take(head).read_to_end(&mut start);
        read.map_err(io_error("read", &self.path))?;
        if !start.is_empty() && !start.starts_with(MAGIC) {
            return Err(Error::NoSpool { path: self.path.clone() });
        }
        let Some(length) = start[start.len().min(MAGIC.len())..].first_chunk() else {
            return Ok(None);
        };
        let length = u64::from_ne_bytes(*length);
        let mut text = Vec::new();
        let read = (&self.file).take(length).read_to_end(&mut text);
        read.map_err(io_error("read", &self.path))?;
        (self.start, self.end) = (head + length, head + length);
        Ok(Description::from_json(&text))
    }

    /// The same file without any bands.
    fn begun(mut self, description: &Description) -> Result<Self, Error> {
        let text = description.to_json();
        let length = (text.len() as u64).to_ne_bytes();
        let start = [MAGIC.as_slice(), &length, &text].concat();
        let mut write = || {
            self.file.set_len(0)?;
            self.file.rewind()?;
            self.file.write_all(&start)
        };
        write().map_err(io_error("write", &self.path))?;
        (self.start, self.end) = (start.len() as u64, start.len() as u64);
        Ok(self)
    }

    /// Finds the bands that are whole, and cuts off what follows them.
    fn recover(&mut self) -> Result<(), Error> {
        while let Ok((band, bytes)) = self.read(self.end) {
            if band.rows.start != self.rows {
                break;
            }
            self.rows = band.rows.end;
            self.end += bytes;
        }
        self.file.set_len(self.end).map_err(io_error("write", &self.path))?;
        Ok(())
    }

    /// The band at a byte, and the length of its record.
    fn read(&self, at: u64) -> io::Result<(Band, u64)> {
        (&self.file).seek(SeekFrom::Start(at))?;
        record::read(&self.file, self.size, self.planes)
    }
}

/// Why a picture that is no regular file cannot be resumed.
fn nothing_kept(picture: &Path) -> Error {
    Error::Option {
        option: "resume",
        needed: "a picture that is a file, beside which its rows are kept".to_owned(),
        found: picture.display().to_string(),
    }
}

/// To be given the system's reason.
fn io_error(verb: &'static str, path: &Path) -> impl FnOnce(io::Error) -> PictureFileError {
    move |source| PictureFileError::Io { verb, path: path.to_owned(), source }
}

#[cfg(test)]
mod tests;
