//! Surroundings from an image.

use glam::{Vec3, Vec4};
use thiserror::Error;

/// An equirectangular image of the surroundings: columns go around the y axis, from −z over +x; rows
/// from the zenith to the nadir.
#[derive(Debug, Clone, PartialEq)]
pub struct Panorama {
    columns: u32,
    rows: u32,
    light: Vec<Vec4>,
}

/// Why an image is no panorama.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PanoramaError {
    /// No pixels, or not one for each column and row.
    #[error(
        "panorama of {columns} × {rows}: needed as many pixels and at least one, found {found}"
    )]
    Size {
        /// Pixels around.
        columns: u32,
        /// Pixels from zenith to nadir.
        rows: u32,
        /// Pixels given.
        found: usize,
    },
    /// Light that is negative, infinite or NaN.
    #[error("panorama pixel {index}: needed finite light of at least 0, found {found}")]
    Light {
        /// Index, row by row.
        index: usize,
        /// The light.
        found: Vec3,
    },
}

impl Panorama {
    /// Linear light of each pixel, row by row from the zenith.
    ///
    /// # Errors
    /// When the size does not fit or a pixel is no light.
    pub fn new(
        columns: u32,
        rows: u32,
        light: impl IntoIterator<Item = Vec3>,
    ) -> Result<Self, PanoramaError> {
        let light: Vec<_> = light.into_iter().map(|light| light.extend(0.0)).collect();
        let found = light.len();
        if found == 0 || found as u64 != u64::from(columns) * u64::from(rows) {
            return Err(PanoramaError::Size { columns, rows, found });
        }
        let is_light = |light: &Vec4| light.is_finite() && light.min_element() >= 0.0;
        if let Some(index) = light.iter().position(|light| !is_light(light)) {
            return Err(PanoramaError::Light { index, found: light[index].truncate() });
        }
        Ok(Self { columns, rows, light })
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> (u32, u32) {
        (self.columns, self.rows)
    }

    pub(crate) fn light(&self) -> &[Vec4] {
        &self.light
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panoramas_are_checked() {
        assert!(Panorama::new(2, 1, [Vec3::ZERO, Vec3::ONE]).is_ok());
        let size = Panorama::new(2, 2, [Vec3::ONE]).expect_err("refused");
        assert_eq!(size, PanoramaError::Size { columns: 2, rows: 2, found: 1 });
        assert!(Panorama::new(0, 0, []).is_err());
        let light = Panorama::new(1, 1, [Vec3::new(0.0, -1.0, 0.0)]).expect_err("refused");
        assert!(light.to_string().starts_with("panorama pixel 0"), "{light}");
        assert!(Panorama::new(1, 1, [Vec3::NAN]).is_err());
    }
}
