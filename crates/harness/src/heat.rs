//! Heat maps of the difference to the reference.

use metaball_core::{Hit, Image};

use crate::reference::Reference;
use crate::score::{Finding, Judgement};

/// Errors up to the first and from the second on, in smallest support radii, have the palest and the
/// darkest blue; between them the scale is logarithmic.
pub const ERROR_RANGE: (f64, f64) = (1e-7, 1e-1);

/// The blue scale, palest first, evenly spaced. One hue, so that it survives grey printers and eyes
/// that confuse red and green (after ColorBrewer's Blues).
pub const SCALE: [[u8; 3]; 5] =
    [[222, 235, 247], [158, 202, 225], [66, 146, 198], [8, 81, 156], [8, 29, 72]];

/// Wrong verdicts: orange, blue's opposite for all kinds of colour vision.
pub const WRONG: [u8; 3] = [230, 85, 13];
/// Pixels that the method left undecided.
pub const UNDECIDED: [u8; 3] = [244, 200, 60];
/// Pixels too close to call for the reference.
pub const AMBIGUOUS: [u8; 3] = [150, 150, 150];
/// Both miss.
pub const MISS: [u8; 3] = [255, 255, 255];
/// Pixels that were not compared.
pub const NOT_COMPARED: [u8; 3] = [240, 238, 233];

/// The mark of a wrong verdict reaches so small a part of the picture's width to each side: one pixel
/// where pictures are shown small, side by side.
const MARK_SHARE: usize = 320;

/// Draws |t − t*| over the smallest support radius at each compared pixel. A wrong verdict also
/// covers the pixels around it, so that a single one is seen. `hits` is the whole image, row by row
/// from the top left.
pub fn heat_map(reference: &Reference, hits: &[Hit]) -> Image {
    let (width, height) = (reference.width() as usize, reference.height() as usize);
    let mut colors = vec![NOT_COMPARED; width * height];
    let mut wrong = Vec::new();
    for (pixel, truth) in reference.rays() {
        let judgement = Judgement::new(truth, &hits[pixel]);
        if judgement.is_wrong() {
            wrong.push(pixel);
        }
        colors[pixel] = color(&judgement);
    }
    let reach = (width / MARK_SHARE).max(1);
    for pixel in wrong {
        let (row, column) = (pixel / width, pixel % width);
        for row in row.saturating_sub(reach)..=(row + reach).min(height - 1) {
            let first = column.saturating_sub(reach);
            let last = (column + reach).min(width - 1);
            colors[row * width + first..=row * width + last].fill(WRONG);
        }
    }
    let rgba = colors.iter().flat_map(|&[red, green, blue]| [red, green, blue, 255]).collect();
    Image { width: reference.width(), height: reference.height(), rgba }
}

/// The colour of a pixel's judgement.
pub fn color(judgement: &Judgement) -> [u8; 3] {
    match judgement.finding {
        _ if judgement.ambiguous => AMBIGUOUS,
        _ if judgement.is_wrong() => WRONG,
        Finding::Hit { error } => error_color(error),
        Finding::Miss => MISS,
        Finding::Undecided => UNDECIDED,
        Finding::FalseNegative | Finding::FalsePositive => WRONG,
    }
}

/// The scale's colour for an error in support radii.
fn error_color(error: f64) -> [u8; 3] {
    let (low, high) = ERROR_RANGE;
    let share = ((error.max(low) / low).ln() / (high / low).ln()).min(1.0);
    let position = share * (SCALE.len() - 1) as f64;
    let below = (position as usize).min(SCALE.len() - 2);
    let weight = position - below as f64;
    std::array::from_fn(|channel| {
        let [from, to] = [below, below + 1].map(|index| f64::from(SCALE[index][channel]));
        (from + weight * (to - from)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use metaball_core::Verdict;
    use metaball_core::reference::Truth;

    use super::*;

    #[test]
    fn the_scale_is_logarithmic_and_closed() {
        assert_eq!(error_color(0.0), SCALE[0]);
        assert_eq!(error_color(1e-7), SCALE[0]);
        assert_eq!(error_color(1e-4), SCALE[2]);
        assert_eq!(error_color(0.1), SCALE[4]);
        assert_eq!(error_color(f64::INFINITY), SCALE[4]);
    }

    #[test]
    fn one_wrong_pixel_is_seen_as_nine() {
        let miss = Truth {
            verdict: Verdict::Miss,
            t: f64::INFINITY,
            exit: f64::INFINITY,
            normal: DVec3::ZERO,
            margin: 1.0,
            smallest_radius: 0.0,
        };
        let mut truths = vec![miss; 25];
        truths[24].margin = 0.0;
        let mut hits = vec![Hit::MISS; 25];
        hits[12] = Hit { verdict: Verdict::Hit, fallback: false, t: 1.0, normal: Vec3::Z };
        hits[24] = hits[12];
        let image = heat_map(&Reference::of_every_pixel((5, 5), truths), &hits);
        let count =
            |color: [u8; 3]| image.rgba.chunks_exact(4).filter(|pixel| pixel[..3] == color).count();
        assert_eq!((count(WRONG), count(AMBIGUOUS), count(MISS)), (9, 1, 15));
    }
}
