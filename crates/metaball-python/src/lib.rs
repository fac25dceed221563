//! The native part of the Python package `metaball`: arrays in, arrays out, without the interpreter's lock
//! while something is computed. What people call is Python, in `python/metaball`.

#![allow(unsafe_code, reason = "PyO3's macros expand to it; none is written here")]
#![allow(clippy::needless_pass_by_value, reason = "PyO3 hands arguments over by value")]

mod arrays;
mod camera;
mod comparison;
mod errors;
mod image;
mod light;
mod options;
mod particles;
mod rays;
mod reading;
mod surface;
mod watch;

use pyo3::prelude::*;

/// The native part of metaball.
#[pymodule]
fn _metaball(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<surface::Surface>()?;
    module.add_function(wrap_pyfunction!(reading::read_particles, module)?)?;
    module.add_function(wrap_pyfunction!(reading::table_particles, module)?)?;
    module.add_function(wrap_pyfunction!(image::png, module)?)?;
    module.add_function(wrap_pyfunction!(image::save_picture, module)?)?;
    module.add_function(wrap_pyfunction!(image::save_hits, module)?)?;
    module.add_function(wrap_pyfunction!(image::save_light, module)?)?;
    Ok(())
}
