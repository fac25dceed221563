//! How files are read, where the reader cannot know or is to do otherwise.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use crate::coloring::ColorBy;
use crate::error::LoadError;
use crate::formats::{Request, Wanted};
use crate::formula::{Formula, FormulaOptions};
use crate::select::Selection;
use crate::units::Unit;

/// What a reader is told; the default is to go by what the file says.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadOptions {
    /// What the particles are.
    pub substance: Option<Substance>,
    /// The radius at which every particle alone shows, in the file's unit.
    pub radius: Option<f32>,
    /// The support radius R of every particle, in the file's unit.
    pub support_radius: Option<f32>,
    /// What all radii are multiplied by.
    pub radius_scale: Option<f32>,
    /// The unit of the file's lengths.
    pub units: Option<Unit>,
    /// The frame, counted from 0; the first where this is `None`.
    pub frame: Option<u32>,
    /// The model of a structure, by its number in the file; the first where this is `None`.
    pub model: Option<i64>,
    /// Names of a table's columns, in their order, instead of its own.
    pub columns: Option<Vec<String>>,
    /// The file that says what the particles of a trajectory are: its columns are theirs.
    pub topology: Option<PathBuf>,
    /// Which particles are kept.
    pub selection: Selection,
    /// The formula that makes a field of what the file says, if another than radii say.
    pub formula: FormulaOptions,
    /// What gives particles their colours.
    pub color_by: Option<ColorBy>,
    /// How often the periodic cell is drawn along each of its edges; once where this is `None`.
    pub repeat: Option<[u32; 3]>,
    /// Whether particles of neighbouring periodic cells that reach into this one are added.
    pub periodic: bool,
    /// Whether the camera of a file without one frames all particles, those far out too.
    pub frame_all: bool,
}

/// What particles are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Substance {
    /// Atoms, which have van der Waals radii and the colours of their elements.
    Molecule,
    /// Anything else.
    Particles,
}

impl ReadOptions {
    /// What a format's reader is asked for.
    pub(crate) fn request(&self) -> Request {
        let mut names = self.selection.columns();
        names.extend(self.color_by.as_ref().map(|by| by.name.clone()));
        names.extend(self.formula.columns().iter().map(|name| (*name).to_owned()));
        Request { wanted: Wanted::Named(names), model: self.model, names: self.columns.clone() }
    }

    /// Refuses numbers that no reader can use.
    pub(crate) fn check(&self) -> Result<(), LoadError> {
        let radii = [
            ("radius", self.radius),
            ("support radius", self.support_radius),
            ("radius scale", self.radius_scale),
        ];
        for (name, value) in radii {
            if let Some(found) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
                return Err(parameter(name, "a finite number above 0", found));
            }
        }
        if self.radius.is_some() && self.support_radius.is_some() {
            return Err(parameter("radius", "a radius or a support radius", "both"));
        }
        let formula = self.formula.formula()?;
        let sized = radii.iter().find(|(_, value)| value.is_some());
        if let (Some((name, _)), true) = (sized, formula.is_some_and(|of| !of.takes_sizes())) {
            let needed = "none for molmap, whose resolution says how wide all atoms are";
            return Err(parameter(name, needed, "one"));
        }
        if formula.is_some_and(Formula::is_of_fluids) && self.substance == Some(Substance::Molecule)
        {
            return Err(parameter("as", "particles for sph and splashsurf", "molecule"));
        }
        match self.repeat {
            Some(repeat) if repeat.contains(&0) => {
                Err(parameter("repeat", "numbers above 0", format_args!("{repeat:?}")))
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Substance {
    /// As [`Substance::from_str`] reads it.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Molecule => "molecule",
            Self::Particles => "particles",
        })
    }
}

impl FromStr for Substance {
    type Err = LoadError;

    fn from_str(name: &str) -> Result<Self, LoadError> {
        match name {
            "molecule" => Ok(Self::Molecule),
            "particles" => Ok(Self::Particles),
            _ => Err(parameter("as", "molecule or particles", format_args!("{name:?}"))),
        }
    }
}

pub(crate) fn parameter(name: &str, needed: &str, found: impl fmt::Display) -> LoadError {
    LoadError::Parameter {
        name: name.to_owned(),
        needed: needed.to_owned(),
        found: found.to_string(),
    }
}
