//! Particles of files: path → bytes → format → table → particles.

use std::borrow::Cow;
use std::path::Path;

use crate::error::{Flaw, LoadError};
use crate::file::{self, named};
use crate::formats::{Format, Request, Span, Wanted};
use crate::interpret;
use crate::notes::{Notes, counted};
use crate::options::{ReadOptions, parameter};
use crate::particles::Particles;
use crate::periodic;
use crate::table::Table;
use crate::text;

/// The particles of a file, whose format its content says; `-` is standard input.
///
/// # Errors
/// Names the file, with line and column or key, what was needed and what was found.
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Particles, LoadError> {
    let path = path.as_ref();
    Content::new(path, file::read(path)?.into())?.particles(options)
}

/// The particles of the bytes of a file: [`read`] without the file system. Errors name `name`, and its
/// ending decides where the bytes could be of several formats.
///
/// # Errors
/// As [`read`].
pub fn parse(
    name: impl AsRef<Path>,
    bytes: &[u8],
    options: &ReadOptions,
) -> Result<Particles, LoadError> {
    let name = name.as_ref();
    Content::new(name, file::unpacked(name, bytes.into())?)?.particles(options)
}

/// The particles of a table, which need not come from a file: [`read`] after the table.
///
/// # Errors
/// Names the column, what was needed and what was found.
pub fn particles_of(table: Table, options: &ReadOptions) -> Result<Particles, LoadError> {
    options.check()?;
    let formula = options.formula.formula()?;
    let mut notes = Notes::default();
    notes.read(table.counted());
    Ok(periodic::repeated(interpret::particles(table, options, formula, notes)?, options)?)
}

/// The particles of a frame that are kept, with all columns, before anything is decided; `-` is standard
/// input.
///
/// # Errors
/// As [`read`].
pub fn read_table(
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<(Table, Notes), LoadError> {
    let path = path.as_ref();
    Content::new(path, file::read(path)?.into())?.whole_table(options)
}

/// The bytes of a file with their format and frames.
#[derive(Debug)]
pub(crate) struct Content<'a> {
    file: String,
    format: Format,
    bytes: Cow<'a, [u8]>,
    frames: Vec<Span>,
    notes: Notes,
}

impl<'a> Content<'a> {
    /// Recognises the format of unpacked bytes, and finds its frames.
    pub(crate) fn new(path: &Path, bytes: Cow<'a, [u8]>) -> Result<Self, LoadError> {
        let file = named(path);
        let ending = file::ending(path);
        let mut notes = Notes::default();
        let binary = Format::of_binary(&bytes);
        let bytes = match binary {
            Some(_) => bytes,
            None => text::decoded(bytes, &mut notes).map_err(|flaw| flaw.in_file(&file))?,
        };
        let format = binary.or_else(|| Format::of_text(&bytes, ending.as_deref()));
        let hinted = || ending.as_deref().filter(|_| !bytes.is_empty()).and_then(Format::of_ending);
        let format = format.or_else(hinted).ok_or_else(|| unknown(&file, &bytes))?;
        notes.read(recognized(format, ending.as_deref()));
        let frames = (format.reader().frames)(&bytes).map_err(|flaw| flaw.in_file(&file))?;
        Ok(Self { file, format, bytes, frames, notes })
    }

    /// Number of frames.
    pub(crate) fn frames(&self) -> usize {
        self.frames.len()
    }

    /// The particles of the frame that is asked for.
    pub(crate) fn particles(&self, options: &ReadOptions) -> Result<Particles, LoadError> {
        options.check()?;
        let formula = options.formula.formula()?;
        let mut notes = self.notes_of_frame(options)?;
        let table = self.joined_table(&options.request(), options, &mut notes)?;
        notes.read(table.counted());
        let in_file = |flaw: Flaw| flaw.in_file(&self.file);
        let particles = interpret::particles(table, options, formula, notes);
        let particles = particles.map_err(in_file)?;
        let particles = periodic::repeated(particles, options).map_err(in_file)?;
        Ok(Particles { file: Some(self.file.clone()), ..particles })
    }

    /// The particles of the frame that is asked for, of those that are kept, with all columns.
    pub(crate) fn whole_table(&self, options: &ReadOptions) -> Result<(Table, Notes), LoadError> {
        let request = Request { wanted: Wanted::All, ..options.request() };
        let mut notes = self.notes_of_frame(options)?;
        let table = self.joined_table(&request, options, &mut notes)?;
        let kept = options.selection.of(table, &mut notes);
        Ok((kept.map_err(|flaw| flaw.in_file(&self.file))?, notes))
    }

    /// The frame that is asked for, with the columns of its topology.
    fn joined_table(
        &self,
        request: &Request,
        options: &ReadOptions,
        notes: &mut Notes,
    ) -> Result<Table, LoadError> {
        let table = self.table(self.frame_of(options)?, request, notes)?;
        match &options.topology {
            Some(topology) => self.joined(table, topology, request, notes),
            None => {
                if self.format.is_trajectory() {
                    notes.read("no elements: they are in a structure file (--topology FILE)");
                }
                Ok(table)
            }
        }
    }

    /// The particles with the columns of another file, which must have as many.
    fn joined(
        &self,
        mut table: Table,
        topology: &Path,
        request: &Request,
        notes: &mut Notes,
    ) -> Result<Table, LoadError> {
        let of_topology = Content::new(topology, file::read(topology)?.into())?;
        let other = match of_topology.frames() {
            0 => Table::default(),
            _ => of_topology.table(0, request, notes)?,
        };
        if other.len() != table.len() {
            let needed = format!("{} as {} has", counted(other.len(), "atom"), of_topology.file);
            return Err(Flaw::needed(&needed, table.len()).in_file(&self.file));
        }
        notes.read(format!("elements and other columns from {}", of_topology.file));
        let own: Vec<_> =
            other.columns.into_iter().filter(|of| table.column(&of.name).is_none()).collect();
        table.columns.splice(0..0, own);
        table.atoms = other.atoms;
        Ok(table)
    }

    fn table(
        &self,
        frame: usize,
        request: &Request,
        notes: &mut Notes,
    ) -> Result<Table, LoadError> {
        let span = &self.frames[frame];
        let read = self.format.reader().table;
        read(&self.bytes, span, request, notes).map_err(|flaw| flaw.in_file(&self.file))
    }

    fn frame_of(&self, options: &ReadOptions) -> Result<usize, LoadError> {
        self.check_model(options)?;
        let frame = options.frame.unwrap_or(0) as usize;
        if frame < self.frames() {
            return Ok(frame);
        }
        let frames = match self.frames() {
            1 => "0, the only one there is".to_owned(),
            frames => format!("a number from 0 to {}", frames.saturating_sub(1)),
        };
        Err(parameter(&format!("frame of {}", self.file), &frames, frame))
    }

    fn check_model(&self, options: &ReadOptions) -> Result<(), LoadError> {
        let Some(model) = options.model else { return Ok(()) };
        if !self.format.has_models() {
            let needed = "a file whose format has models, such as PDB and mmCIF";
            return Err(parameter(&format!("model {model}"), needed, &self.file));
        }
        match options.frame {
            Some(_) => Err(parameter("model", "a model or a frame", "both")),
            None => Ok(()),
        }
    }

    fn notes_of_frame(&self, options: &ReadOptions) -> Result<Notes, LoadError> {
        let mut notes = self.notes.clone();
        match (self.frames(), options.frame) {
            (0 | 1, _) => {}
            (frames, Some(frame)) => {
                notes.read(format!("frame {frame} of {frames}, counted from 0"));
            }
            // The reader says which models it leaves out.
            (_, None) if options.model.is_some() => {}
            (frames, None) => notes.left_out(format!(
                "{} after the first (--frame N draws another, animate all)",
                counted(frames - 1, "frame")
            )),
        }
        Ok(notes)
    }
}

fn recognized(format: Format, ending: Option<&str>) -> String {
    match ending {
        Some(ending) if format.has_ending(ending) => format.to_string(),
        _ => format!("{format} by its content"),
    }
}

fn unknown(file: &str, bytes: &[u8]) -> LoadError {
    let (line, _) = text::first_line(bytes);
    let start = text::word(&line[..line.len().min(60)]).into_owned();
    LoadError::UnknownFormat {
        file: file.to_owned(),
        formats: Format::all().map(|format| format.to_string()).collect::<Vec<_>>().join(", "),
        found: match bytes.is_empty() {
            true => "an empty file".to_owned(),
            false => format!("text that starts with {start:?}"),
        },
    }
}
