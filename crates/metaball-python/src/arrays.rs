//! Arrays of NumPy, read where they lie: f32 or f64, any strides.

use glam::DVec3;
use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use particle_files::Positions;
use pyo3::prelude::*;

/// Points of an array of shape (n, 3).
#[derive(FromPyObject)]
pub(crate) enum PointArray<'py> {
    #[pyo3(transparent, annotation = "float32 array of shape (n, 3)")]
    Single(PyReadonlyArray2<'py, f32>),
    #[pyo3(transparent, annotation = "float64 array of shape (n, 3)")]
    Double(PyReadonlyArray2<'py, f64>),
}

/// Numbers of an array of shape (n,).
#[derive(FromPyObject)]
pub(crate) enum NumberArray<'py> {
    #[pyo3(transparent, annotation = "float32 array of shape (n,)")]
    Single(PyReadonlyArray1<'py, f32>),
    #[pyo3(transparent, annotation = "float64 array of shape (n,)")]
    Double(PyReadonlyArray1<'py, f64>),
}

/// The points, for threads that do not hold the interpreter; those in C order are rows, which are quicker.
#[derive(Clone, Copy)]
pub(crate) enum Points<'a> {
    SingleRows(&'a [[f32; 3]]),
    DoubleRows(&'a [[f64; 3]]),
    Single(ArrayView2<'a, f32>),
    Double(ArrayView2<'a, f64>),
}

/// The numbers, likewise.
#[derive(Clone, Copy)]
pub(crate) enum Numbers<'a> {
    Single(ArrayView1<'a, f32>),
    Double(ArrayView1<'a, f64>),
}

impl PointArray<'_> {
    pub(crate) fn points(&self) -> Points<'_> {
        match self {
            Self::Single(array) => {
                let array = array.as_array();
                rows_of(array).map_or(Points::Single(array), Points::SingleRows)
            }
            Self::Double(array) => {
                let array = array.as_array();
                rows_of(array).map_or(Points::Double(array), Points::DoubleRows)
            }
        }
    }
}

/// The rows of an array of shape (n, 3), if it is in C order.
fn rows_of<T>(array: ArrayView2<'_, T>) -> Option<&[[T; 3]]> {
    let (rows, _) = array.to_slice()?.as_chunks();
    (array.ncols() == 3).then_some(rows)
}

impl NumberArray<'_> {
    pub(crate) fn numbers(&self) -> Numbers<'_> {
        match self {
            Self::Single(array) => Numbers::Single(array.as_array()),
            Self::Double(array) => Numbers::Double(array.as_array()),
        }
    }
}

/// Points that are rows.
pub(crate) struct Rows<'a, T>(pub(crate) &'a [[T; 3]]);

impl<T: Copy + Into<f64> + Sync> Positions for Rows<'_, T> {
    fn count(&self) -> usize {
        self.0.len()
    }

    #[inline]
    fn at(&self, index: usize) -> DVec3 {
        DVec3::from_array(self.0[index].map(Into::into))
    }
}

impl Positions for Points<'_> {
    fn count(&self) -> usize {
        match self {
            Self::SingleRows(rows) => rows.len(),
            Self::DoubleRows(rows) => rows.len(),
            Self::Single(array) => array.nrows(),
            Self::Double(array) => array.nrows(),
        }
    }

    #[inline]
    fn at(&self, index: usize) -> DVec3 {
        match self {
            Self::SingleRows(rows) => Rows(rows).at(index),
            Self::DoubleRows(rows) => Rows(rows).at(index),
            Self::Single(array) => {
                DVec3::from_array([0, 1, 2].map(|axis| f64::from(array[[index, axis]])))
            }
            Self::Double(array) => DVec3::from_array([0, 1, 2].map(|axis| array[[index, axis]])),
        }
    }
}

impl Numbers<'_> {
    #[inline]
    pub(crate) fn at(&self, index: usize) -> f32 {
        match self {
            Self::Single(array) => array[index],
            Self::Double(array) => array[index] as f32,
        }
    }

    pub(crate) fn count(&self) -> usize {
        match self {
            Self::Single(array) => array.len(),
            Self::Double(array) => array.len(),
        }
    }
}

impl<'a> Numbers<'a> {
    /// As a slice of f32, without a copy where they are one.
    pub(crate) fn to_slice(self) -> std::borrow::Cow<'a, [f32]> {
        match self {
            Self::Single(array) => match array.to_slice() {
                Some(slice) => slice.into(),
                None => array.iter().copied().collect::<Vec<_>>().into(),
            },
            Self::Double(array) => {
                array.iter().map(|number| *number as f32).collect::<Vec<_>>().into()
            }
        }
    }
}
