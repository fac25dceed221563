//! Values that are written on the command line.

use std::ops::Range;
use std::path::PathBuf;

use glam::{DVec3, Vec3};
use metaball_core::Kernel;
use particle_files::{LoadError, kernel_named};

/// Pixels across and down.
pub(crate) fn size(text: &str) -> Result<(u32, u32), String> {
    text.split_once('x')
        .and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)))
        .filter(|&(width, height): &(u32, u32)| width > 0 && height > 0)
        .ok_or_else(|| "needed WIDTHxHEIGHT in pixels, such as 640x480".to_owned())
}

/// Numbers of frames, the last one not included.
pub(crate) fn frame_range(text: &str) -> Result<Range<u32>, String> {
    text.split_once("..")
        .and_then(|(first, end)| Some(first.parse().ok()?..end.parse().ok()?))
        .filter(|range: &Range<u32>| !range.is_empty())
        .ok_or_else(|| "needed FIRST..END, such as 0..48 for the frames 0 to 47".to_owned())
}

/// A kernel by name; a power kernel with its default exponent.
pub(crate) fn kernel(name: &str) -> Result<Kernel, LoadError> {
    kernel_named(name, None)
}

/// An error in mean support radii.
pub(crate) fn max_error(text: &str) -> Result<f64, String> {
    let error = text.parse().ok().filter(|error: &f64| error.is_finite() && *error > 0.0);
    error.ok_or_else(|| "needed a number above 0, in mean support radii, such as 1e-3".to_owned())
}

/// A name and a file.
pub(crate) fn named_file(text: &str) -> Result<(String, PathBuf), String> {
    text.split_once('=')
        .filter(|(name, file)| !name.is_empty() && !file.is_empty())
        .map(|(name, file)| (name.to_owned(), PathBuf::from(file)))
        .ok_or_else(|| "needed NAME=FILE, such as mine=hits.exr".to_owned())
}

/// So many finite numbers with commas between.
pub(crate) fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let numbers: [f64; N] = numbers.ok()?.try_into().ok()?;
    numbers.iter().all(|number| number.is_finite()).then_some(numbers)
}

/// Three coordinates with commas between.
pub(crate) fn point(text: &str) -> Result<DVec3, String> {
    let point = numbers(text).map(DVec3::from_array);
    point.ok_or_else(|| "needed three numbers such as 0.5,1,-0.3".to_owned())
}

/// Three numbers with commas between.
pub(crate) fn vector(text: &str) -> Result<Vec3, String> {
    point(text).map(DVec3::as_vec3).and_then(|vector| match vector.is_finite() {
        true => Ok(vector),
        false => Err("needed numbers that f32 holds".to_owned()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_three_numbers() {
        assert_eq!(vector("1,-2, 0.5"), Ok(Vec3::new(1.0, -2.0, 0.5)));
        assert!(vector("1,2").is_err() && vector("1,2,nan").is_err() && vector("a,b,c").is_err());
    }
}
