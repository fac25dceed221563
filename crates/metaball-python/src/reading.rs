//! Particles of files, and of tables that other packages hold.

use std::path::PathBuf;

use glam::DVec3;
use metaball::{Cell, FormulaOptions, Notes, Overrides, ReadOptions, Rule, Selection, Unit};
use metaball_core::Color;
use numpy::ndarray::Array2;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use particle_files::{
    Column, LoadError, NoteKind, Particles, Positions, Sizes, Table, Values, Words, particles_of,
    read,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::PointArray;
use crate::errors::{raised, refused};

/// The keywords of reading, `metaball.ReadOptions`; what is left out is `None`.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Reading {
    substance: Option<String>,
    radius: Option<f32>,
    support_radius: Option<f32>,
    radius_scale: Option<f32>,
    units: Option<String>,
    frame: Option<u32>,
    model: Option<i64>,
    columns: Option<Vec<String>>,
    topology: Option<PathBuf>,
    keep: Option<Rules>,
    drop: Option<Rules>,
    color_by: Option<String>,
    repeat: Option<[u32; 3]>,
    sph: Option<bool>,
    preset: Option<String>,
    support_per_h: Option<f64>,
    particle_mass: Option<f64>,
    resolution: Option<f64>,
    radius_offset: Option<f64>,
    smoothness: Option<f64>,
    smoothing_length: Option<f64>,
}

/// A rule, or some.
#[derive(FromPyObject)]
enum Rules {
    #[pyo3(transparent, annotation = "str")]
    One(String),
    #[pyo3(transparent, annotation = "a sequence of str")]
    Some(Vec<String>),
}

impl Rules {
    fn parsed(rules: Option<Self>) -> Result<Vec<Rule>, LoadError> {
        match rules {
            None => Ok(Vec::new()),
            Some(Self::One(rule)) => Ok(vec![rule.parse()?]),
            Some(Self::Some(rules)) => rules.iter().map(|rule| rule.parse()).collect(),
        }
    }
}

impl Reading {
    pub(crate) fn options(self) -> Result<ReadOptions, LoadError> {
        Ok(ReadOptions {
            substance: self.substance.map(|name| name.parse()).transpose()?,
            radius: self.radius,
            support_radius: self.support_radius,
            radius_scale: self.radius_scale,
            units: self.units.map(|name| name.parse()).transpose()?,
            frame: self.frame,
            model: self.model,
            columns: self.columns,
            topology: self.topology,
            selection: Selection {
                keep: Rules::parsed(self.keep)?,
                drop: Rules::parsed(self.drop)?,
            },
            color_by: self.color_by.map(|text| text.parse()).transpose()?,
            repeat: self.repeat,
            formula: FormulaOptions {
                sph: self.sph.unwrap_or(false),
                preset: self.preset.map(|name| name.parse()).transpose()?,
                support_per_h: self.support_per_h,
                particle_mass: self.particle_mass,
                resolution: self.resolution,
                radius_offset: self.radius_offset,
                smoothness: self.smoothness,
                smoothing_length: self.smoothing_length,
            },
            ..ReadOptions::default()
        })
    }
}

/// A reader's notes, as pairs of kind and text.
pub(crate) type Said = Vec<(&'static str, String)>;

/// The arguments of `metaball.Particles`, and the reader's notes.
type Read<'py> = (Bound<'py, PyDict>, Said);

/// The particles of a file.
#[pyfunction]
pub(crate) fn read_particles(
    py: Python<'_>,
    path: PathBuf,
    reading: Reading,
) -> PyResult<Read<'_>> {
    let read = py.detach(|| reading.options().and_then(|options| read(&path, &options)));
    arguments(py, read.map_err(raised)?)
}

/// A column of a table.
#[derive(FromPyObject)]
enum ColumnValues<'py> {
    #[pyo3(transparent, annotation = "numbers")]
    Numbers(PyReadonlyArray1<'py, f64>),
    #[pyo3(transparent, annotation = "a sequence of str")]
    Words(Vec<String>),
}

/// A `metaball.tables.Table`, whose positions are columns where it has none.
#[derive(FromPyObject)]
pub(crate) struct TableArrays<'py> {
    positions: Option<PointArray<'py>>,
    columns: Vec<(String, ColumnValues<'py>)>,
    edges: Option<[[f64; 3]; 3]>,
    atoms: bool,
}

impl TableArrays<'_> {
    pub(crate) fn table(self) -> PyResult<Table> {
        let Self { positions, columns, edges, atoms } = self;
        let column = |(name, values): (String, ColumnValues<'_>)| Column {
            name,
            values: match values {
                ColumnValues::Numbers(numbers) => {
                    Values::Numbers(numbers.as_array().iter().copied().collect())
                }
                ColumnValues::Words(words) => {
                    Values::Words(words.iter().map(String::as_str).collect::<Words>())
                }
            },
        };
        let columns = columns.into_iter().map(column).collect();
        let table = match positions {
            None => Table::of_columns(columns).map_err(raised)?,
            Some(positions) => {
                let points = positions.points();
                let positions = (0..points.count()).map(|index| points.at(index)).collect();
                Table { positions, columns, ..Table::default() }
            }
        };
        let cell = edges.and_then(|edges| Cell::new(edges.map(DVec3::from_array)));
        Ok(Table { cell, atoms, unit: atoms.then_some(Unit::Angstrom), ..table })
    }
}

/// The particles of a table.
#[pyfunction]
pub(crate) fn table_particles<'py>(
    py: Python<'py>,
    table: TableArrays<'py>,
    reading: Reading,
) -> PyResult<Read<'py>> {
    let table = table.table()?;
    let particles =
        py.detach(|| reading.options().and_then(|options| particles_of(table, &options)));
    arguments(py, particles.map_err(raised)?)
}

/// A kernel and a threshold instead of those that something says of itself.
pub(crate) fn overrides(kernel: Option<&str>, threshold: Option<f32>) -> PyResult<Overrides> {
    let kernel = kernel.map(str::parse).transpose().map_err(raised)?;
    Ok(Overrides { kernel, threshold, ..Overrides::default() })
}

fn arguments(py: Python<'_>, particles: Particles) -> PyResult<Read<'_>> {
    let Particles { positions, sizes, strengths, colors, notes, .. } = particles;
    let arguments = PyDict::new(py);
    let coordinates = positions.iter().flat_map(DVec3::to_array).collect();
    arguments.set_item("centers", rows(py, coordinates)?)?;
    match sizes {
        Sizes::Support(radii) => {
            arguments.set_item("support_radius", PyArray1::from_vec(py, radii))?;
        }
        Sizes::Shown(radii) => arguments.set_item("radius", PyArray1::from_vec(py, radii))?,
        Sizes::Spacing(radius) => arguments.set_item("support_radius", radius)?,
        Sizes::Smoothing(_) => {
            let needed = "radii, as files are read for without a formula of SPH";
            return Err(refused("sizes", needed, "smoothing lengths"));
        }
    }
    if let Some(strengths) = strengths {
        arguments.set_item("strength", PyArray1::from_vec(py, strengths))?;
    }
    if let Some(colors) = colors {
        let channels = colors.into_iter().flat_map(Color::to_srgb).collect();
        arguments.set_item("color", rows(py, channels)?)?;
    }
    Ok((arguments, said(&notes)))
}

/// Notes for Python.
pub(crate) fn said(notes: &Notes) -> Said {
    notes.into_iter().map(|note| (kind(note.kind), note.text.clone())).collect()
}

/// An array of three numbers a row.
pub(crate) fn rows<T: numpy::Element>(
    py: Python<'_>,
    numbers: Vec<T>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let rows = Array2::from_shape_vec((numbers.len() / 3, 3), numbers)
        .map_err(|error| refused("rows", "three numbers each", error))?;
    Ok(PyArray2::from_owned_array(py, rows))
}

/// The name of a kind of note.
fn kind(kind: NoteKind) -> &'static str {
    match kind {
        NoteKind::Guessed => "guessed",
        NoteKind::LeftOut => "left out",
        NoteKind::Changed => "changed",
        _ => "read",
    }
}
