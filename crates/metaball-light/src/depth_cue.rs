//! Depth cueing: depth made visible by contrast.

use std::collections::VecDeque;
use std::ops::Range;

use glam::Vec3;
use metaball_core::{Hit, ValueRange};
use rayon::prelude::*;

use crate::Film;

impl Film {
    /// Cues the depth of a whole picture: see [`DepthCue`]. `hits` are the picture's first hits; without as
    /// many as pixels nothing changes.
    pub fn cue_depth(&mut self, hits: &[Hit], width: f32, strength: f32) {
        if hits.is_empty() || hits.len() != self.light.len() {
            return;
        }
        let range = ValueRange::of_distances(hits);
        let mut cue = DepthCue::new((self.width, self.height), range, width, strength);
        cue.see(hits);
        cue.cue(0..self.height, hits, &mut self.light);
    }
}

/// Depth cueing of a picture that comes in rows, from the top.
///
/// Unsharp masking of the depth buffer (Luft et al. 2006; Kanamori et al. 2008, figure 11): what lies behind
/// something near is darkened around it, the near rim is brightened. With D from 0 at the nearest hit to 1 at
/// the farthest and where there is none, the light of a pixel is multiplied by 1 + λ(G∗D − D), G a Gaussian
/// over the picture.
///
/// It holds 4 bytes a pixel of the rows within three deviations of those that are cued.
#[derive(Debug)]
pub struct DepthCue {
    columns: usize,
    rows: usize,
    range: ValueRange,
    strength: f32,
    /// The Gaussian at −reach..=reach.
    weights: Vec<f32>,
    reach: usize,
    /// Depths of rows, blurred along them.
    blurred: VecDeque<Vec<f32>>,
    /// The first of those rows.
    first: usize,
}

impl DepthCue {
    /// For a picture of width × height pixels with these distances. `width` is the Gaussian's standard
    /// deviation in parts of the picture's height (0.02 is subtle), `strength` is λ.
    pub fn new((columns, rows): (u32, u32), range: ValueRange, width: f32, strength: f32) -> Self {
        let deviation = (width * rows as f32).max(0.5);
        let reach = (3.0 * deviation).ceil() as usize;
        let weight = |index: usize| {
            let away = (index as f32 - reach as f32) / deviation;
            libm::expf(-0.5 * away * away)
        };
        Self {
            columns: columns as usize,
            rows: rows as usize,
            range,
            strength,
            weights: (0..=2 * reach).map(weight).collect(),
            reach,
            blurred: VecDeque::new(),
            first: 0,
        }
    }

    /// Rows that it has seen, from the top.
    pub fn seen(&self) -> u32 {
        (self.first + self.blurred.len()) as u32
    }

    /// Rows that it has to see before it cues the rows up to `end`.
    pub fn needed(&self, end: u32) -> u32 {
        (end as usize + self.reach).min(self.rows) as u32
    }

    /// Sees the first hits of the next rows.
    pub fn see(&mut self, hits: &[Hit]) {
        let rows = hits.par_chunks(self.columns);
        let blurred: Vec<_> = rows.map(|row| self.blur_along(row)).collect();
        self.blurred.extend(blurred);
    }

    /// Cues the next rows: changes their light. `hits` are theirs.
    ///
    /// # Panics
    /// When it has not [seen](Self::see) the rows that it [needs](Self::needed), or cues rows again.
    pub fn cue(&mut self, rows: Range<u32>, hits: &[Hit], light: &mut [Vec3]) {
        let lines = light.par_chunks_mut(self.columns).zip(hits.par_chunks(self.columns));
        lines.zip(rows.clone().into_par_iter()).for_each(|((light, hits), row)| {
            let blurred = self.blur_across(row as usize);
            for ((light, hit), blurred) in light.iter_mut().zip(hits).zip(blurred) {
                let change = self.strength * (blurred - self.depth(hit));
                *light = (*light * (1.0 + change)).max(Vec3::ZERO);
            }
        });
        let done = (rows.end as usize).saturating_sub(self.reach + self.first);
        self.blurred.drain(..done.min(self.blurred.len()));
        self.first += done;
    }

    /// From 0 at the nearest hit to 1 at the farthest and where there is none.
    fn depth(&self, hit: &Hit) -> f32 {
        let ValueRange { low, high } = self.range;
        if hit.is_hit() { (hit.t - low) / (high - low).max(f32::MIN_POSITIVE) } else { 1.0 }
    }

    /// The depths of a row, blurred along it. Beyond its ends it continues with its last numbers.
    fn blur_along(&self, hits: &[Hit]) -> Vec<f32> {
        let depth = |column: usize| {
            self.depth(&hits[column.saturating_sub(self.reach).min(self.columns - 1)])
        };
        let depths: Vec<f32> = (0..self.columns + 2 * self.reach).map(depth).collect();
        self.blur(|offset| &depths[offset..])
    }

    /// A row of depths that are blurred along rows, blurred across them. Above the first row and below the
    /// last these go on.
    fn blur_across(&self, row: usize) -> Vec<f32> {
        self.blur(|offset| {
            let row = (row + offset).saturating_sub(self.reach).min(self.rows - 1);
            &self.blurred[row - self.first]
        })
    }

    /// The weighted mean of rows, one for each weight.
    fn blur<'a>(&self, row: impl Fn(usize) -> &'a [f32]) -> Vec<f32> {
        let mut sums = vec![0.0; self.columns];
        for (offset, weight) in self.weights.iter().enumerate() {
            for (sum, number) in sums.iter_mut().zip(row(offset)) {
                *sum += weight * number;
            }
        }
        let total: f32 = self.weights.iter().sum();
        for sum in &mut sums {
            *sum /= total;
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use metaball_core::Verdict;

    use super::*;

    fn film() -> Film {
        Film { width: 9, height: 5, light: vec![Vec3::splat(0.5); 45] }
    }

    fn hit(t: f32) -> Hit {
        Hit { verdict: Verdict::Hit, fallback: false, t, normal: Vec3::Z }
    }

    #[test]
    fn a_step_in_depth_is_darkened_behind_and_brightened_in_front() {
        let hits: Vec<_> =
            (0..45).map(|pixel| hit(if pixel % 9 < 4 { 1.0 } else { 2.0 })).collect();
        let mut cued = film();
        cued.cue_depth(&hits, 0.2, 1.0);
        assert!(cued.light[3].x > 0.55 && cued.light[4].x < 0.45, "{:?}", &cued.light[..9]);
        // Three pixels are three deviations away: 1e-3 of the Gaussian is left, and rounding.
        assert!((cued.light[0].x - 0.5).abs() < 2e-3 && (cued.light[8].x - 0.5).abs() < 2e-3);
    }

    #[test]
    fn rows_are_cued_as_in_the_whole_picture() {
        let (columns, rows) = (9_u32, 40_u32);
        let distance = |pixel: u32| hit(1.0 + (pixel * 37 % 101) as f32);
        let hits: Vec<_> = (0..columns * rows).map(distance).collect();
        let light = vec![Vec3::new(0.5, 0.25, 1.0); hits.len()];
        let mut whole = Film { width: columns, height: rows, light: light.clone() };
        whole.cue_depth(&hits, 0.05, 1.0);
        for band in [1, 3, 16, 40] {
            let range = ValueRange::of_distances(&hits);
            let mut cue = DepthCue::new((columns, rows), range, 0.05, 1.0);
            let mut light = light.clone();
            let at = |row: u32| (row * columns) as usize;
            for first in (0..rows).step_by(band) {
                let end = (first + band as u32).min(rows);
                while cue.seen() < cue.needed(end) {
                    let row = cue.seen();
                    cue.see(&hits[at(row)..at(row + 1)]);
                }
                let here = at(first)..at(end);
                cue.cue(first..end, &hits[here.clone()], &mut light[here]);
                assert!(cue.blurred.len() <= 2 * cue.reach + band);
            }
            assert!(light == whole.light, "{band} rows at a time");
        }
        assert_ne!(whole.light, light);
    }

    #[test]
    fn even_depth_changes_nothing() {
        let mut cued = film();
        cued.cue_depth(&[hit(3.0); 45], 0.2, 5.0);
        assert!(cued.light.iter().all(|light| (light.x - 0.5).abs() < 1e-5));
        cued.cue_depth(&[Hit::MISS; 45], 0.2, 5.0);
        assert!(cued.light.iter().all(|light| (light.x - 0.5).abs() < 1e-5));
    }
}
