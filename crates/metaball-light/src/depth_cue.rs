//! Depth cueing: depth made visible by contrast.

use glam::Vec3;
use metaball_core::Hit;

use crate::Film;

impl Film {
    /// Unsharp masking of the depth buffer (Luft et al. 2006; Kanamori et al. 2008, figure 11): what lies
    /// behind something near is darkened around it, the near rim is brightened. With D from 0 at the
    /// nearest hit to 1 at the farthest and where there is none, the light of a pixel is multiplied by
    /// 1 + λ(G∗D − D), G a Gaussian over the picture.
    ///
    /// `hits` are the picture's first hits, `width` is the Gaussian's standard deviation in parts of the
    /// picture's height (0.02 is subtle), `strength` is λ. Without as many hits as pixels nothing changes.
    pub fn cue_depth(&mut self, hits: &[Hit], width: f32, strength: f32) {
        if hits.len() != self.light.len() {
            return;
        }
        let depths = depths(hits);
        let deviation = (width * self.height as f32).max(0.5);
        let (columns, rows) = (self.width as usize, self.height as usize);
        let across = blur(&depths, columns, 1, rows, columns, deviation);
        let blurred = blur(&across, rows, columns, columns, 1, deviation);
        for ((light, blurred), depth) in self.light.iter_mut().zip(blurred).zip(depths) {
            *light = (*light * (1.0 + strength * (blurred - depth))).max(Vec3::ZERO);
        }
    }
}

/// Depths from 0 at the nearest hit to 1 at the farthest and where there is none.
fn depths(hits: &[Hit]) -> Vec<f32> {
    let found = || hits.iter().filter(|hit| hit.is_hit()).map(|hit| hit.t);
    let nearest = found().fold(f32::MAX, f32::min);
    let extent = (found().fold(0.0, f32::max) - nearest).max(f32::MIN_POSITIVE);
    hits.iter().map(|hit| if hit.is_hit() { (hit.t - nearest) / extent } else { 1.0 }).collect()
}

/// A Gaussian along lines of `count` numbers, `step` apart; the lines begin `line_step` apart. Beyond
/// its ends a line continues with its last number.
fn blur(
    numbers: &[f32],
    count: usize,
    step: usize,
    lines: usize,
    line_step: usize,
    deviation: f32,
) -> Vec<f32> {
    let reach = (3.0 * deviation).ceil() as isize;
    let weight = |offset: isize| {
        let away = offset as f32 / deviation;
        libm::expf(-0.5 * away * away)
    };
    let total: f32 = (-reach..=reach).map(weight).sum();
    let mut blurred = vec![0.0; numbers.len()];
    for line in 0..lines {
        for index in 0..count {
            let near = |offset: isize| {
                let at = index.saturating_add_signed(offset).min(count - 1);
                weight(offset) * numbers[line * line_step + at * step]
            };
            blurred[line * line_step + index * step] =
                (-reach..=reach).map(near).sum::<f32>() / total;
        }
    }
    blurred
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
    fn even_depth_changes_nothing() {
        let mut cued = film();
        cued.cue_depth(&[hit(3.0); 45], 0.2, 5.0);
        assert!(cued.light.iter().all(|light| (light.x - 0.5).abs() < 1e-5));
        cued.cue_depth(&[Hit::MISS; 45], 0.2, 5.0);
        assert!(cued.light.iter().all(|light| (light.x - 0.5).abs() < 1e-5));
    }
}
