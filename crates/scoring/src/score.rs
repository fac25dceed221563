//! How far a method's hits are from the reference: the one set of definitions for all methods.

use metaball_core::reference::Truth;
use metaball_core::{Hit, Verdict};
use serde::{Deserialize, Serialize};

use crate::fronts::WRONG_FRONT;
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

/// Compares hits with the truth along the same rays; `subset` says in words which rays these are.
pub fn score<'a>(rays: impl Iterator<Item = (&'a Truth, &'a Hit)>, subset: &str) -> Accuracy {
    let mut accuracy = Accuracy {
        rays: 0,
        oracle_hits: 0,
        false_negative: 0,
        false_positive: 0,
        wrong_front: 0,
        ambiguous: 0,
        rel_rms_t: None,
        t_error_over_radius: None,
        normal_degrees: None,
        subset: subset.to_owned(),
    };
    let (mut squares, mut errors, mut angles) = (Vec::new(), Vec::new(), Vec::new());
    for (truth, hit) in rays {
        accuracy.rays += 1;
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
    accuracy
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
