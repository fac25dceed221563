//! Units of length that files are in.

use std::fmt;
use std::str::FromStr;

use crate::error::LoadError;

/// A unit of length. Atoms are drawn in ångströms; particles that are no atoms keep their file's unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unit {
    /// 10⁻¹⁰ m.
    Angstrom,
    /// 10⁻⁹ m.
    Nanometre,
    /// The metre.
    Metre,
}

impl Unit {
    /// How many ångströms it is.
    pub fn angstroms(self) -> f64 {
        match self {
            Self::Angstrom => 1.0,
            Self::Nanometre => 10.0,
            Self::Metre => 1e10,
        }
    }
}

impl fmt::Display for Unit {
    /// As [`Unit::from_str`] reads it.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Angstrom => "A",
            Self::Nanometre => "nm",
            Self::Metre => "m",
        })
    }
}

impl FromStr for Unit {
    type Err = LoadError;

    fn from_str(name: &str) -> Result<Self, LoadError> {
        match name {
            "A" | "Å" => Ok(Self::Angstrom),
            "nm" => Ok(Self::Nanometre),
            "m" => Ok(Self::Metre),
            _ => Err(LoadError::Parameter {
                name: "units".to_owned(),
                needed: "A, nm or m".to_owned(),
                found: format!("{name:?}"),
            }),
        }
    }
}
