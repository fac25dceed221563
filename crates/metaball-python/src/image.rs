//! Pictures, hits and light as files.

use std::path::PathBuf;

use glam::Vec3;
use metaball_core::Image;
use numpy::PyReadonlyArray3;
use picture_files::{encode_png, write_hits, write_light, write_picture};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::{raised, refused};
use crate::rays::HitColumns;

/// The image of an array of shape (height, width, 4).
fn image(pixels: &PyReadonlyArray3<'_, u8>) -> PyResult<Image> {
    let pixels = pixels.as_array();
    let (height, width, channels) = pixels.dim();
    match (u32::try_from(width), u32::try_from(height), channels) {
        (Ok(width), Ok(height), 4) => {
            Ok(Image { width, height, rgba: pixels.iter().copied().collect() })
        }
        _ => Err(refused("pixels", "shape (height, width, 4)", format_args!("{:?}", pixels.dim()))),
    }
}

/// The bytes of a PNG.
#[pyfunction]
pub(crate) fn png<'py>(
    py: Python<'py>,
    pixels: PyReadonlyArray3<'py, u8>,
) -> PyResult<Bound<'py, PyBytes>> {
    let image = image(&pixels)?;
    let bytes = py.detach(|| encode_png(&image)).map_err(raised)?;
    Ok(PyBytes::new(py, &bytes))
}

/// Writes a picture: `.png`, `.jpg` or `.jpeg`.
#[pyfunction]
pub(crate) fn save_picture(
    py: Python<'_>,
    path: PathBuf,
    pixels: PyReadonlyArray3<'_, u8>,
) -> PyResult<()> {
    let image = image(&pixels)?;
    py.detach(|| write_picture(&path, &image)).map_err(raised)
}

/// Writes hits, given as columns, row by row from the top left: `.exr` or `.npy`.
#[pyfunction]
pub(crate) fn save_hits(
    py: Python<'_>,
    path: PathBuf,
    size: (u32, u32),
    hits: HitColumns<'_>,
) -> PyResult<()> {
    let hits = hits.hits()?;
    py.detach(|| write_hits(&path, size.0, size.1, &hits)).map_err(raised)
}

/// Writes linear light of shape (height, width, 3): `.exr`.
#[pyfunction]
pub(crate) fn save_light(
    py: Python<'_>,
    path: PathBuf,
    light: PyReadonlyArray3<'_, f32>,
) -> PyResult<()> {
    let light = light.as_array();
    let (height, width, channels) = light.dim();
    let (Ok(width), Ok(height), 3) = (u32::try_from(width), u32::try_from(height), channels) else {
        let found = format!("{:?}", light.dim());
        return Err(refused("light", "shape (height, width, 3)", found));
    };
    let pixels = light.rows().into_iter();
    let pixels: Vec<_> = pixels.map(|pixel| Vec3::new(pixel[0], pixel[1], pixel[2])).collect();
    py.detach(|| write_light(&path, width, height, &pixels)).map_err(raised)
}
