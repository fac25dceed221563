//! Pixels of a display.

/// Colours, row by row from the top left.
pub(crate) struct Screen {
    width: usize,
    pixels: Vec<[u8; 3]>,
}

impl Screen {
    /// From X's pixels of 32 bits: blue, green, red, and nothing.
    pub(crate) fn new(width: usize, data: &[u8]) -> Self {
        let pixels = data.chunks_exact(4).map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect();
        Self { width, pixels }
    }

    pub(crate) fn at(&self, column: usize, row: usize) -> [u8; 3] {
        self.pixels[row * self.width + column]
    }

    /// Columns and rows of the picture in the upper left corner: up to the first column and the first row
    /// that have one colour, the panel's.
    pub(crate) fn picture(&self) -> Option<(usize, usize)> {
        let height = self.pixels.len() / self.width;
        let columns = (1..self.width)
            .find(|&column| (1..200).all(|row| self.at(column, row) == self.at(column, 0)))?;
        let rows = (1..height).find(|&row| {
            (1..columns).all(|column| self.at(column, row) == self.at(0, row))
                && self.at(0, row) == self.at(columns, 0)
        })?;
        Some((columns, rows))
    }

    /// How many pixels of the picture differ from one of its size, which has four bytes a pixel, by more
    /// than the graphics' rounding.
    pub(crate) fn differing(&self, (columns, rows): (usize, usize), rgba: &[u8]) -> usize {
        let differs = |(index, wanted): (usize, &[u8])| {
            let found = self.at(index % columns, index / columns);
            found.iter().zip(wanted).any(|(found, wanted)| found.abs_diff(*wanted) > 2)
        };
        assert_eq!(rgba.len(), 4 * columns * rows);
        rgba.chunks_exact(4).enumerate().filter(|pixel| differs(*pixel)).count()
    }
}
