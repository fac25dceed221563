//! Parts of a picture: whole rows of it.

use std::ops::Range;

use glam::Vec3;
use metaball_core::{Color, Hit, View};
use serde::Serialize;

use crate::summary::Tally;

/// Some rows of a picture, row by row from the top left; a plane that is not kept is empty.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Band {
    /// Counted from the top.
    pub(crate) rows: Range<u32>,
    /// The picture.
    pub(crate) pixels: Vec<Color>,
    /// First hits of the rays through the middles of pixels.
    pub(crate) hits: Vec<Hit>,
    /// Linear light.
    pub(crate) light: Vec<Vec3>,
    /// What became of the rays.
    pub(crate) tally: Tally,
}

/// What is kept of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) struct Planes {
    pub(crate) pixels: bool,
    pub(crate) hits: bool,
    pub(crate) light: bool,
}

impl Band {
    /// Drops the other planes.
    pub(crate) fn keep(&mut self, planes: Planes) {
        if !planes.pixels {
            self.pixels = Vec::new();
        }
        if !planes.hits {
            self.hits = Vec::new();
        }
        if !planes.light {
            self.light = Vec::new();
        }
    }

    /// Adds the rows below.
    pub(crate) fn append(&mut self, mut below: Self) {
        self.rows.end = below.rows.end;
        self.pixels.append(&mut below.pixels);
        self.hits.append(&mut below.hits);
        self.light.append(&mut below.light);
        self.tally += below.tally;
    }
}

/// The bands that a view is drawn in, from a row on: their rows. Each has about so many pixels.
pub(crate) fn bands(
    view: &View,
    first: u32,
    pixels: u32,
) -> impl Iterator<Item = Range<u32>> + use<> {
    /// Rows are traced in packets of two, in tasks of eight, lit in tiles of sixteen, and zipped in
    /// blocks of sixteen: multiples of this many are drawn as in the whole picture.
    const MULTIPLE: u32 = 16;
    let height = view.height();
    let rows = (pixels / view.width()).next_multiple_of(MULTIPLE).max(MULTIPLE);
    (first..height).step_by(rows as usize).map(move |row| row..row.saturating_add(rows).min(height))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use metaball_core::Camera;

    use super::*;

    #[test]
    fn bands_cover_the_rest_of_a_view() {
        let camera = Camera::look_at(Vec3::Z, Vec3::ZERO, Vec3::Y, 38.0).expect("legal");
        for (width, height, pixels) in [(640, 480, 1 << 16), (16384, 100, 1), (1, 65, 1 << 20)] {
            let view = View::new(camera, width, height).expect("a size");
            let mut row = 16;
            for band in bands(&view, 16, pixels) {
                assert!(band.start == row && (band.len() % 16 == 0 || band.end == height));
                row = band.end;
            }
            assert_eq!(row, height);
            assert_eq!(bands(&view, height, pixels).count(), 0);
        }
    }
}
