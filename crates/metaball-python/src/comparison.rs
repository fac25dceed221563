//! Hits of anyone, held against the reference.

use metaball_core::Hit;
use metaball_core::reference::{Oracle, Truth};
use numpy::PyArray1;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scoring::{Accuracy, Finding, Judgement, score};

use crate::rays::{Rays, each_batch};
use crate::reading::rows;
use crate::watch::Watched;

/// The truth along rays: t and normals, verdicts, and how clear these are.
pub(crate) type TruthArrays<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray1<f64>>,
);

/// What became of each ray: finding, error, whether it is ambiguous and whether it is wrong; and all of it
/// in numbers.
pub(crate) type ComparisonArrays<'py> = (
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyDict>,
);

/// The truth along rays.
pub(crate) fn truths(
    oracle: &Oracle<'_>,
    rays: &Rays<'_>,
    watched: &Watched<'_>,
) -> PyResult<Vec<Truth>> {
    let mut truths = Vec::with_capacity(rays.count());
    let answer = |rays: &[_]| truths.append(&mut oracle.first_hits(rays));
    each_batch(rays, answer, watched)?;
    Ok(truths)
}

pub(crate) fn truth_arrays<'py>(py: Python<'py>, truths: &[Truth]) -> PyResult<TruthArrays<'py>> {
    let normals = truths.iter().flat_map(|truth| truth.normal.to_array()).collect();
    let verdicts = truths.iter().map(|truth| truth.verdict as u8);
    Ok((
        PyArray1::from_iter(py, truths.iter().map(|truth| truth.t)),
        rows(py, normals)?,
        PyArray1::from_iter(py, verdicts),
        PyArray1::from_iter(py, truths.iter().map(|truth| truth.margin)),
    ))
}

/// Hits against the truth along the same rays.
pub(crate) fn comparison<'py>(
    py: Python<'py>,
    truths: &[Truth],
    hits: &[Hit],
) -> PyResult<ComparisonArrays<'py>> {
    let pairs = || truths.iter().zip(hits);
    let each: Vec<_> = pairs().map(|(truth, hit)| Judgement::new(truth, hit)).collect();
    let accuracy = score(pairs(), "every ray");
    Ok((
        PyArray1::from_iter(py, each.iter().map(|judgement| number(judgement.finding))),
        PyArray1::from_iter(py, each.iter().map(|judgement| error(judgement.finding))),
        PyArray1::from_iter(py, each.iter().map(|judgement| judgement.ambiguous)),
        PyArray1::from_iter(py, each.iter().map(Judgement::is_wrong)),
        arguments(py, &accuracy)?,
    ))
}

/// The number of `metaball.Finding`.
fn number(finding: Finding) -> u8 {
    match finding {
        Finding::Miss => 0,
        Finding::Hit { .. } => 1,
        Finding::FalseNegative => 2,
        Finding::FalsePositive => 3,
        Finding::Undecided => 4,
    }
}

fn error(finding: Finding) -> f64 {
    match finding {
        Finding::Hit { error } => error,
        _ => f64::NAN,
    }
}

/// The arguments of `metaball.Score`.
fn arguments<'py>(py: Python<'py>, accuracy: &Accuracy) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    arguments.set_item("rays", accuracy.rays)?;
    arguments.set_item("true_hits", accuracy.oracle_hits)?;
    arguments.set_item("false_negative", accuracy.false_negative)?;
    arguments.set_item("false_positive", accuracy.false_positive)?;
    arguments.set_item("wrong_front", accuracy.wrong_front)?;
    arguments.set_item("ambiguous", accuracy.ambiguous)?;
    arguments.set_item("rel_rms_t", accuracy.rel_rms_t)?;
    let errors = accuracy.t_error_over_radius.map(|error| (error.p50, error.p99, error.max));
    arguments.set_item("t_error_over_radius", errors)?;
    let degrees = accuracy.normal_degrees.map(|error| (error.mean, error.p99, error.max));
    arguments.set_item("normal_degrees", degrees)?;
    Ok(arguments)
}
