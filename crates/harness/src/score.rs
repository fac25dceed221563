//! How far a method's hits are from the reference: the one set of definitions for all methods.

use metaball_core::reference::Truth;
use metaball_core::{Hit, Verdict};
use serde::{Deserialize, Serialize};

use crate::fronts::WRONG_FRONT;
use crate::reference::Reference;
use crate::stats::{quantile, sorted};

/// A normal's length may differ from 1 by this much, far above rounding and far below a wrong one.
const UNIT_TOLERANCE: f64 = 1e-3;

/// Comparison of one picture with the reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Rays compared.
    pub rays: usize,
    /// Rays that the reference says hit, or start inside.
    pub oracle_hits: usize,
    /// Unambiguous rays that hit and were called a miss.
    pub false_negative: usize,
    /// Unambiguous rays that miss and were called a hit.
    pub false_positive: usize,
    /// Unambiguous rays that both hit, more than [`WRONG_FRONT`] apart.
    pub wrong_front: usize,
    /// Rays whose margin is at most [`Truth::AMBIGUOUS`]; in none of the three counts above.
    pub ambiguous: usize,
    /// Root of the mean square of (t − t*)/t* over all rays that both hit, wrong fronts and
    /// ambiguous rays included, starts inside (t* = 0) left out. `None`: there is no such ray.
    pub rel_rms_t: Option<f64>,
    /// |t − t*| over the smallest support radius at the true hit, over all rays that both hit.
    pub t_error_over_radius: Option<RadiusError>,
    /// Angle between the normals, over all rays that both hit.
    pub normal_degrees: Option<NormalDegrees>,
    /// Which rays were compared, in words.
    pub subset: String,
}

/// Distribution of distance errors in support radii.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RadiusError {
    /// Median.
    pub p50: f64,
    /// One in a hundred is larger.
    pub p99: f64,
    /// Largest.
    pub max: f64,
}

/// Distribution of angles between normals, degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NormalDegrees {
    /// Mean.
    pub mean: f64,
    /// One in a hundred is larger.
    pub p99: f64,
    /// Largest.
    pub max: f64,
}

impl Accuracy {
    /// False negatives, false positives and wrong fronts together.
    pub fn wrong_verdicts(&self) -> usize {
        self.false_negative + self.false_positive + self.wrong_front
    }
}

/// What became of one ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judgement {
    /// Whether the reference itself is too close to call; then no finding is held against a method.
    pub ambiguous: bool,
    /// The comparison.
    pub finding: Finding,
}

/// A method's verdict on a ray against the reference's. A start inside counts as a hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Finding {
    /// Both miss.
    Miss,
    /// Both hit.
    Hit {
        /// |t − t*| over the smallest support radius at the true hit; infinite when the method's t
        /// is no number.
        error: f64,
    },
    /// The ray hits; the method says miss.
    FalseNegative,
    /// The ray misses; the method says hit.
    FalsePositive,
    /// The method left the ray undecided.
    Undecided,
}

impl Judgement {
    /// Compares a method's hit with the truth along the same ray.
    pub fn new(truth: &Truth, hit: &Hit) -> Self {
        let finding = match (is_hit(truth), hit.is_hit()) {
            _ if hit.verdict == Verdict::Undecided => Finding::Undecided,
            (false, false) => Finding::Miss,
            (true, false) => Finding::FalseNegative,
            (false, true) => Finding::FalsePositive,
            (true, true) => {
                let error = (f64::from(hit.t) - truth.t).abs() / f64::from(truth.smallest_radius);
                Finding::Hit { error: if error.is_nan() { f64::INFINITY } else { error } }
            }
        };
        Self { ambiguous: truth.is_ambiguous(), finding }
    }

    /// Whether the verdict is wrong and the ray clear enough to say so.
    pub fn is_wrong(&self) -> bool {
        !self.ambiguous
            && match self.finding {
                Finding::FalseNegative | Finding::FalsePositive => true,
                Finding::Hit { error } => error > WRONG_FRONT,
                Finding::Miss | Finding::Undecided => false,
            }
    }
}

/// Whether so many of the rays are ambiguous, more than one in a thousand, that a scene should say so.
pub fn many_are_ambiguous(ambiguous: usize, rays: usize) -> bool {
    ambiguous * 1000 > rays
}

/// Whether the reference finds a surface point along the ray.
pub fn is_hit(truth: &Truth) -> bool {
    matches!(truth.verdict, Verdict::Hit | Verdict::Inside)
}

/// Compares a method's image, row by row from the top left, with the reference.
///
/// # Errors
/// When the image has another number of pixels than the reference's.
pub fn score(reference: &Reference, hits: &[Hit]) -> anyhow::Result<Accuracy> {
    anyhow::ensure!(
        hits.len() == reference.image_pixels(),
        "hits: needed {} × {} pixels, found {}",
        reference.width(),
        reference.height(),
        hits.len()
    );
    let mut accuracy = Accuracy {
        rays: reference.truths().len(),
        oracle_hits: 0,
        false_negative: 0,
        false_positive: 0,
        wrong_front: 0,
        ambiguous: 0,
        rel_rms_t: None,
        t_error_over_radius: None,
        normal_degrees: None,
        subset: reference.subset().to_owned(),
    };
    let (mut squares, mut errors, mut angles) = (Vec::new(), Vec::new(), Vec::new());
    for (pixel, truth) in reference.rays() {
        let hit = &hits[pixel];
        let judgement = Judgement::new(truth, hit);
        accuracy.oracle_hits += usize::from(is_hit(truth));
        accuracy.ambiguous += usize::from(judgement.ambiguous);
        if judgement.is_wrong() {
            *match judgement.finding {
                Finding::FalseNegative => &mut accuracy.false_negative,
                Finding::FalsePositive => &mut accuracy.false_positive,
                _ => &mut accuracy.wrong_front,
            } += 1;
        }
        if let Finding::Hit { error } = judgement.finding {
            errors.push(error);
            angles.push(normal_degrees(truth, hit));
            if truth.t > 0.0 {
                let relative = (f64::from(hit.t) - truth.t) / truth.t;
                squares.push(if relative.is_nan() { f64::INFINITY } else { relative * relative });
            }
        }
    }

    let mean = |numbers: &[f64]| {
        (!numbers.is_empty()).then(|| numbers.iter().sum::<f64>() / numbers.len() as f64)
    };
    accuracy.rel_rms_t = mean(&squares).map(f64::sqrt);
    let mean_angle = mean(&angles);
    let (errors, angles) = (sorted(errors), sorted(angles));
    accuracy.t_error_over_radius = quantile(&errors, 1.0).map(|max| RadiusError {
        p50: quantile(&errors, 0.5).unwrap_or(max),
        p99: quantile(&errors, 0.99).unwrap_or(max),
        max,
    });
    accuracy.normal_degrees = quantile(&angles, 1.0).map(|max| NormalDegrees {
        mean: mean_angle.unwrap_or(max),
        p99: quantile(&angles, 0.99).unwrap_or(max),
        max,
    });
    Ok(accuracy)
}

/// The angle between the normals. A vector that is no unit vector is as wrong as can be: 180°.
fn normal_degrees(truth: &Truth, hit: &Hit) -> f64 {
    let normal = hit.normal.as_dvec3();
    let is_unit = (normal.length() - 1.0).abs() < UNIT_TOLERANCE;
    if !is_unit {
        return 180.0;
    }
    // acos loses all digits near 0°, where the answers are.
    normal.cross(truth.normal).length().atan2(normal.dot(truth.normal)).to_degrees()
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use metaball_core::{Camera, Ray, View};

    use super::*;

    const SIZE: u32 = 48;

    /// The surface of balls that do not touch is spheres: truth without any oracle.
    fn truth(spheres: &[(DVec3, f64)], ray: &Ray) -> Truth {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let nearest = spheres
            .iter()
            .filter_map(|&(center, radius)| {
                let to_center = center - origin;
                let middle = to_center.dot(direction);
                let rise = radius * radius - (to_center - middle * direction).length_squared();
                (rise >= 0.0).then(|| (middle - rise.sqrt(), center))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((t, center)) = nearest else {
            return Truth {
                verdict: Verdict::Miss,
                t: f64::INFINITY,
                exit: f64::INFINITY,
                normal: DVec3::ZERO,
                margin: 1.0,
                smallest_radius: 0.0,
            };
        };
        Truth {
            verdict: Verdict::Hit,
            t,
            exit: t + 0.1,
            normal: (origin + t * direction - center).normalize(),
            margin: 1.0,
            smallest_radius: 2.0,
        }
    }

    fn rays() -> Vec<Ray> {
        let eye = Vec3::new(0.0, 0.0, 6.0);
        let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 50.0).expect("legal");
        let view = View::new(camera, SIZE, SIZE).expect("legal");
        let pixel = |index: u32| {
            let direction =
                view.camera().exact_direction(index % SIZE, index / SIZE, SIZE, SIZE).as_vec3();
            Ray::new(eye, direction)
        };
        (0..SIZE * SIZE).map(pixel).collect()
    }

    const TWO: [(DVec3, f64); 2] =
        [(DVec3::new(-1.3, 0.0, 0.0), 1.0), (DVec3::new(1.3, 0.4, 0.0), 0.9)];

    fn reference() -> Reference {
        let truths = rays().iter().map(|ray| truth(&TWO, ray)).collect();
        Reference::of_every_pixel((SIZE, SIZE), truths)
    }

    /// What a method that is right to f32 finds.
    fn good() -> Vec<Hit> {
        reference().hits()
    }

    #[test]
    fn a_right_picture_scores_well() {
        let accuracy = score(&reference(), &good()).expect("equal sizes");
        assert_eq!(accuracy.rays, (SIZE * SIZE) as usize);
        assert!(accuracy.oracle_hits > 100);
        assert_eq!((accuracy.wrong_verdicts(), accuracy.ambiguous), (0, 0));
        // Rounding t < 8 to f32 errs by at most 2.4e-7, normals by 6e-8 in each coordinate.
        assert!(accuracy.t_error_over_radius.expect("hits").max < 2.4e-7);
        assert!(accuracy.rel_rms_t.expect("hits") < 6e-8);
        assert!(accuracy.normal_degrees.expect("hits").max < 1.1e-7_f64.to_degrees());
    }

    #[test]
    fn canary_shifted_by_a_pixel() {
        let mut hits = good();
        hits.rotate_right(1);
        let accuracy = score(&reference(), &hits).expect("equal sizes");
        assert!(accuracy.false_negative > 10 && accuracy.false_positive > 10, "{accuracy:?}");
    }

    #[test]
    fn canary_flipped_normal() {
        let mut hits = good();
        let hit = hits.iter_mut().find(|hit| hit.is_hit()).expect("there are hits");
        hit.normal = -hit.normal;
        let accuracy = score(&reference(), &hits).expect("equal sizes");
        assert!(accuracy.normal_degrees.expect("hits").max > 179.9);
    }

    #[test]
    fn canary_missing_ball() {
        let without: Vec<_> = rays().iter().map(|ray| truth(&TWO[..1], ray)).collect();
        let hits = Reference::of_every_pixel((SIZE, SIZE), without).hits();
        assert!(score(&reference(), &hits).expect("equal sizes").false_negative > 50);
    }

    #[test]
    fn canary_truncated_buffer() {
        let mut hits = good();
        hits.pop();
        let error = score(&reference(), &hits).expect_err("a pixel is missing");
        assert_eq!(error.to_string(), "hits: needed 48 × 48 pixels, found 2303");
    }

    #[test]
    fn broken_numbers_are_never_good() {
        let mut hits = good();
        let hit = hits.iter_mut().find(|hit| hit.is_hit()).expect("there are hits");
        hit.t = f32::NAN;
        hit.normal = Vec3::NAN;
        let accuracy = score(&reference(), &hits).expect("equal sizes");
        assert_eq!(accuracy.wrong_front, 1);
        assert_eq!(accuracy.t_error_over_radius.expect("hits").max, f64::INFINITY);
        assert_eq!(accuracy.rel_rms_t, Some(f64::INFINITY));
        assert_eq!(accuracy.normal_degrees.expect("hits").max, 180.0);
    }

    fn judge(truth: Truth, hit: Hit) -> Judgement {
        Judgement::new(&truth, &hit)
    }

    #[test]
    fn fronts_are_wrong_beyond_a_twentieth_of_a_radius() {
        let ray = Ray::new(Vec3::new(-1.3, 0.0, 6.0), Vec3::NEG_Z);
        let truth = truth(&TWO, &ray);
        assert!((truth.t - 5.0).abs() < 1e-12 && truth.smallest_radius == 2.0);
        let at = |t| Hit { verdict: Verdict::Hit, fallback: false, t, normal: Vec3::Z };
        assert!(!judge(truth, at(5.09)).is_wrong());
        assert!(judge(truth, at(5.11)).is_wrong());
        assert!(judge(truth, at(4.89)).is_wrong());
        assert!(judge(truth, Hit::MISS).is_wrong());
        // The same error on an ambiguous ray is counted there and not here.
        let ambiguous = Truth { margin: 1e-5, ..truth };
        assert!(judge(ambiguous, Hit::MISS).ambiguous && !judge(ambiguous, Hit::MISS).is_wrong());
        let clear = Truth { margin: 1.1e-5, ..truth };
        assert!(judge(clear, Hit::MISS).is_wrong());
    }

    #[test]
    fn inside_counts_as_a_hit_and_undecided_as_neither() {
        let ray = Ray::new(Vec3::new(-1.3, 0.0, 6.0), Vec3::NEG_Z);
        let inside = Truth { verdict: Verdict::Inside, t: 0.0, ..truth(&TWO, &ray) };
        let hit = Hit { verdict: Verdict::Inside, fallback: false, t: 0.0, normal: Vec3::Z };
        assert_eq!(judge(inside, hit).finding, Finding::Hit { error: 0.0 });
        let reference = Reference::of_every_pixel((1, 1), vec![inside]);
        let accuracy = score(&reference, &[hit]).expect("equal sizes");
        assert_eq!((accuracy.oracle_hits, accuracy.rel_rms_t), (1, None));

        let undecided = Hit { verdict: Verdict::Undecided, ..hit };
        assert!(!judge(inside, undecided).is_wrong());
        let accuracy = score(&reference, &[undecided]).expect("equal sizes");
        assert_eq!((accuracy.wrong_verdicts(), accuracy.t_error_over_radius), (0, None));
    }
}
