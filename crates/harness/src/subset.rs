//! Pixels at which methods may differ: a set of pixels of an image, grown from hits.

use std::ops::RangeInclusive;

use metaball_core::Hit;

use crate::fronts::WRONG_FRONT;

/// Around an edge, pixels up to this far away (in both directions) are traced.
const EDGE_MARGIN: usize = 2;

/// A depth step between neighbours counts as an edge from this many smallest support radii on: the
/// depth of field in which one front can hide another.
const EDGE_STEP: f32 = 0.5;

/// A set of pixels of an image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Subset {
    width: usize,
    chosen: Vec<bool>,
}

impl Subset {
    /// No pixel of an image of this size.
    pub fn empty(width: u32, height: u32) -> Self {
        let (width, height) = (width as usize, height as usize);
        Self { width, chosen: vec![false; width * height] }
    }

    /// Every `stride`th pixel across and down, from half a stride in.
    pub fn lattice(width: u32, height: u32, stride: usize) -> Self {
        let mut subset = Self::empty(width, height);
        let (width, height) = (width as usize, height as usize);
        for row in (stride / 2..height).step_by(stride) {
            for column in (stride / 2..width).step_by(stride) {
                subset.chosen[row * width + column] = true;
            }
        }
        subset
    }

    /// Adds every pixel at which any two images differ: in whether there is a hit, or in distance by
    /// what makes a wrong front at the given support radius.
    pub fn add_disagreements(&mut self, images: &[&[Hit]], radius: f32) {
        let tolerance = WRONG_FRONT as f32 * radius;
        for (pixel, chosen) in self.chosen.iter_mut().enumerate() {
            *chosen |= images.iter().enumerate().any(|(index, one)| {
                images[..index].iter().any(|other| step(&one[pixel], &other[pixel]) > tolerance)
            });
        }
    }

    /// Adds the pixels between and around every two neighbours that have an edge between them: one
    /// hits and the other does not, or they differ in depth by half the given support radius.
    /// Neighbours are pixels of the [lattice](Subset::lattice) of the given stride, and `hits` need
    /// be right only there; with a stride of 1 that is every pixel.
    pub fn add_edges(&mut self, hits: &[Hit], radius: f32, stride: usize) {
        let (width, height) = (self.width, self.chosen.len() / self.width.max(1));
        for row in (stride / 2..height).step_by(stride) {
            for column in (stride / 2..width).step_by(stride) {
                let pixel = row * width + column;
                let is_edge = |other: usize| step(&hits[pixel], &hits[other]) > EDGE_STEP * radius;
                if column + stride < width && is_edge(pixel + stride) {
                    self.add_around(column..=column + stride, row..=row);
                }
                if row + stride < height && is_edge(pixel + stride * width) {
                    self.add_around(column..=column, row..=row + stride);
                }
            }
        }
    }

    /// Indices of the pixels, rising.
    pub fn pixels(&self) -> impl Iterator<Item = usize> + '_ {
        self.chosen.iter().enumerate().filter_map(|(pixel, &chosen)| chosen.then_some(pixel))
    }

    /// Whether the pixel belongs to the set.
    pub fn contains(&self, pixel: usize) -> bool {
        self.chosen.get(pixel).copied().unwrap_or(false)
    }

    /// Adds a rectangle of pixels and the margin around it.
    fn add_around(&mut self, columns: RangeInclusive<usize>, rows: RangeInclusive<usize>) {
        let height = self.chosen.len() / self.width;
        let first = columns.start().saturating_sub(EDGE_MARGIN);
        let last = (columns.end() + EDGE_MARGIN).min(self.width - 1);
        let bottom = (rows.end() + EDGE_MARGIN).min(height - 1);
        for row in rows.start().saturating_sub(EDGE_MARGIN)..=bottom {
            self.chosen[row * self.width + first..=row * self.width + last].fill(true);
        }
    }
}

/// How far apart two hits are in depth: infinite between a hit and a miss or an undecided pixel.
fn step(a: &Hit, b: &Hit) -> f32 {
    match (a.is_hit(), b.is_hit()) {
        (true, true) if (a.t - b.t).is_nan() => f32::INFINITY,
        (true, true) => (a.t - b.t).abs(),
        (false, false) if a.verdict == b.verdict => 0.0,
        _ => f32::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use metaball_core::Verdict;

    use super::*;

    fn hit(t: f32) -> Hit {
        Hit { verdict: Verdict::Hit, fallback: false, t, normal: Vec3::Z }
    }

    fn pixels(subset: &Subset) -> Vec<usize> {
        subset.pixels().collect()
    }

    #[test]
    fn lattices_are_even() {
        assert_eq!(pixels(&Subset::lattice(8, 4, 4)), [2 * 8 + 2, 2 * 8 + 6]);
        assert_eq!(Subset::lattice(3, 2, 1).pixels().count(), 6);
    }

    #[test]
    fn disagreements_are_seen() {
        let one = [Hit::MISS, hit(1.0), hit(1.0), hit(1.0), hit(f32::NAN)];
        let two = [hit(1.0), hit(1.04), hit(1.06), Hit::MISS, hit(1.0)];
        let mut subset = Subset::empty(5, 1);
        subset.add_disagreements(&[&one, &two], 1.0);
        assert_eq!(pixels(&subset), [0, 2, 3, 4]);
        let mut same = Subset::empty(5, 1);
        same.add_disagreements(&[&two, &two], 1.0);
        assert!(pixels(&same).is_empty());
        // With one picture there is no other to disagree with.
        same.add_disagreements(&[&one], 1.0);
        assert!(pixels(&same).is_empty());
    }

    #[test]
    fn edges_bring_two_pixels_on_each_side() {
        // A step between columns 5 and 6 of one row; a gentle slope elsewhere.
        let mut row: Vec<_> = (0..12).map(|column| hit(0.1 * column as f32)).collect();
        for later in &mut row[6..] {
            later.t += 1.0;
        }
        let mut subset = Subset::empty(12, 1);
        subset.add_edges(&row, 1.0, 1);
        assert_eq!(pixels(&subset), [3, 4, 5, 6, 7, 8]);
    }

    #[test]
    fn silhouettes_are_edges_in_both_directions() {
        let mut image = vec![Hit::MISS; 9 * 9];
        image[4 * 9 + 4] = hit(1.0);
        let mut subset = Subset::empty(9, 9);
        subset.add_edges(&image, 1.0, 1);
        assert!(subset.contains(4 * 9 + 4) && subset.contains(9 + 4) && subset.contains(4 * 9 + 1));
        assert!(!subset.contains(0) && !subset.contains(9 * 9 + 5));
    }

    #[test]
    fn lattice_edges_fill_the_gap() {
        let mut row = vec![Hit::MISS; 20];
        row[10] = hit(1.0);
        let mut subset = Subset::empty(20, 1);
        // Stride 4 visits columns 2, 6, 10, 14, 18.
        subset.add_edges(&row, 1.0, 4);
        assert_eq!(pixels(&subset), Vec::<usize>::new());
        let mut tall = vec![Hit::MISS; 20 * 4];
        tall[2 * 20 + 10] = hit(1.0);
        let mut subset = Subset::empty(20, 4);
        subset.add_edges(&tall, 1.0, 4);
        let columns: Vec<_> = pixels(&subset).into_iter().map(|p| p % 20).collect();
        assert_eq!(columns.iter().min(), Some(&4));
        assert_eq!(columns.iter().max(), Some(&16));
    }
}
