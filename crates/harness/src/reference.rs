//! The oracle's answers for one picture, for every pixel or a stated part of them.

use bench_scenes::mean_overlap;
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Hit, Ray, Scene};

use crate::subset::Subset;

/// The truth along some rays of an image.
#[derive(Debug, Clone)]
pub struct Reference {
    width: u32,
    height: u32,
    /// Rising indices of the pixels that `truths` is about.
    pixels: Vec<usize>,
    truths: Vec<Truth>,
    subset: String,
}

/// A large picture is always scored on every fourth pixel across and down.
const STRIDE: usize = 4;

/// Pictures with up to this many pixels are compared whole: on two cores the oracle takes some ten
/// seconds for the densest of the known scenes.
const COMPARED_WHOLE_PIXELS: usize = 640 * 480;

/// Scenes with up to this many balls are compared whole at any size.
const COMPARED_WHOLE_BALLS: usize = 10_000;

/// Scenes in which a ball's centre lies in more supports than this are not: the oracle's time grows with
/// the square of the balls that a ray meets, to minutes.
const COMPARED_WHOLE_OVERLAP: f64 = 100.0;

impl Reference {
    /// From the truths of all pixels, row by row from the top left.
    ///
    /// # Panics
    /// When there are not width times height of them.
    pub fn of_every_pixel((width, height): (u32, u32), truths: Vec<Truth>) -> Self {
        let pixels = width as usize * height as usize;
        assert_eq!(truths.len(), pixels, "a truth for each pixel");
        let subset = "every pixel".to_owned();
        Self { width, height, pixels: (0..pixels).collect(), truths, subset }
    }

    /// The truth that pictures of a scene are held against, along the rays of all pixels: for every pixel
    /// of small pictures and sparse scenes, and where that is asked for; else for [those that tell the
    /// images apart](Self::of_telling_pixels).
    pub fn of_pictures(
        scene: &Scene,
        rays: &[Ray],
        size: (u32, u32),
        images: &[&[Hit]],
        every_pixel: bool,
    ) -> Self {
        let oracle = Oracle::new(scene);
        let is_small =
            || rays.len() <= COMPARED_WHOLE_PIXELS || scene.len() <= COMPARED_WHOLE_BALLS;
        let is_sparse = || mean_overlap(scene) <= COMPARED_WHOLE_OVERLAP;
        if every_pixel || (is_small() && is_sparse()) {
            return Self::of_every_pixel(size, oracle.first_hits(rays));
        }
        let radius = scene.supports().iter().map(|ball| ball.radius).fold(f32::INFINITY, f32::min);
        Self::of_telling_pixels(&oracle, rays, size, images, radius)
    }

    /// Traces the oracle's rays of a lattice of pixels, every pixel where two of the images disagree, and
    /// two pixels around every edge that an image or the oracle's lattice shows. `rays` are those of
    /// all pixels; `radius` is the smallest support radius of the scene.
    pub fn of_telling_pixels(
        oracle: &Oracle<'_>,
        rays: &[Ray],
        (width, height): (u32, u32),
        images: &[&[Hit]],
        radius: f32,
    ) -> Self {
        let lattice = Subset::lattice(width, height, STRIDE);
        let coarse_pixels: Vec<_> = lattice.pixels().collect();
        let coarse_truths = truths_of(oracle, rays, &coarse_pixels);

        let mut wanted = Subset::empty(width, height);
        wanted.add_disagreements(images, radius);
        for image in images {
            wanted.add_edges(image, radius, 1);
        }
        let mut coarse_image = vec![Hit::MISS; rays.len()];
        for (&pixel, truth) in coarse_pixels.iter().zip(&coarse_truths) {
            coarse_image[pixel] = as_hit(truth);
        }
        wanted.add_edges(&coarse_image, radius, STRIDE);

        let more: Vec<_> = wanted.pixels().filter(|&pixel| !lattice.contains(pixel)).collect();
        let more_truths = truths_of(oracle, rays, &more);
        let mut answers: Vec<_> = coarse_pixels
            .into_iter()
            .zip(coarse_truths)
            .chain(more.into_iter().zip(more_truths))
            .collect();
        answers.sort_unstable_by_key(|&(pixel, _)| pixel);
        let (pixels, truths) = answers.into_iter().unzip();
        let subset = format!(
            "every {STRIDE}th pixel across and down, every pixel where two methods disagree, and \
             two pixels around every edge of a method or of the reference's lattice"
        );
        Self { width, height, pixels, truths, subset }
    }

    /// Pixels across.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels down.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Pixels of the image, of which [`Reference::rays`] may be a part.
    pub fn image_pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The truths, in the order of [`Reference::rays`].
    pub fn truths(&self) -> &[Truth] {
        &self.truths
    }

    /// Index of the pixel and truth of each ray, by rising index.
    pub fn rays(&self) -> impl ExactSizeIterator<Item = (usize, &Truth)> {
        self.pixels.iter().copied().zip(&self.truths)
    }

    /// Which rays these are, in words.
    pub fn subset(&self) -> &str {
        &self.subset
    }

    /// Whether no pixel is left out.
    pub fn is_complete(&self) -> bool {
        self.pixels.len() == self.image_pixels()
    }

    /// The image to show: a pixel without an answer shows that of the middle of its lattice cell.
    pub fn hits(&self) -> Vec<Hit> {
        let mut answers = vec![None; self.image_pixels()];
        for (pixel, truth) in self.rays() {
            answers[pixel] = Some(as_hit(truth));
        }
        let (width, height) = (self.width as usize, self.height as usize);
        let show = |pixel: usize| {
            let (row, column) = (middle(pixel / width, height), middle(pixel % width, width));
            answers[pixel].or(answers[row * width + column]).unwrap_or(Hit::MISS)
        };
        (0..answers.len()).map(show).collect()
    }
}

/// The lattice coordinate of the cell that a coordinate below `end` lies in; cells cut off at the
/// end have none and take the one before.
fn middle(coordinate: usize, end: usize) -> usize {
    let middle = coordinate / STRIDE * STRIDE + STRIDE / 2;
    if middle < end { middle } else { middle.saturating_sub(STRIDE) }
}

fn truths_of(oracle: &Oracle<'_>, rays: &[Ray], pixels: &[usize]) -> Vec<Truth> {
    let rays: Vec<_> = pixels.iter().map(|&pixel| rays[pixel]).collect();
    oracle.first_hits(&rays)
}

/// The truth rounded to what a method would write.
fn as_hit(truth: &Truth) -> Hit {
    Hit {
        verdict: truth.verdict,
        fallback: false,
        t: truth.t as f32,
        normal: truth.normal.as_vec3(),
    }
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};
    use metaball_core::Verdict;

    use super::*;

    #[test]
    fn a_part_agrees_with_the_whole() {
        let bench = load("random-200", &Overrides::default()).expect("known");
        let size = (64, 48);
        let rays: Vec<_> = (0..size.0 * size.1)
            .map(|pixel| {
                let (column, row) = (pixel % size.0, pixel / size.0);
                let direction = bench.camera.exact_direction(column, row, size.0, size.1);
                Ray::new(bench.camera.eye(), direction.as_vec3())
            })
            .collect();
        let oracle = Oracle::new(&bench.scene);
        let whole = Reference::of_every_pixel(size, oracle.first_hits(&rays));
        let image = whole.hits();
        let mut other = image.clone();
        other[0] = Hit { verdict: Verdict::Hit, t: 1.0, ..Hit::MISS };

        let part = Reference::of_telling_pixels(&oracle, &rays, size, &[&image, &other], 1e-3);
        assert!(whole.is_complete() && !part.is_complete());
        assert!(part.rays().any(|(pixel, _)| pixel == 0), "a disagreement");
        let middle = (2 * 64 + 2, &whole.truths()[2 * 64 + 2]);
        assert!(part.rays().any(|ray| ray == middle), "the lattice");
        assert!(part.rays().zip(part.rays().skip(1)).all(|(one, next)| one.0 < next.0));
        assert!(part.rays().all(|(pixel, truth)| *truth == whole.truths()[pixel]));

        // What is filled in differs from the truth only where nothing was traced.
        let filled = part.hits();
        for (pixel, truth) in part.rays() {
            assert_eq!(filled[pixel].verdict, truth.verdict);
        }
        let hits = |image: &[Hit]| image.iter().filter(|hit| hit.is_hit()).count();
        assert!(hits(&image) > 100);
        assert_eq!(hits(&filled), hits(&image), "edges are traced, so silhouettes are right");
    }

    #[test]
    fn cut_off_cells_take_the_one_before() {
        assert_eq!([0, 3, 4, 7].map(|x| middle(x, 8)), [2, 2, 6, 6]);
        assert_eq!([8, 9].map(|x| middle(x, 10)), [6, 6]);
        assert_eq!(middle(0, 1), 0);
    }
}
