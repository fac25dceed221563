//! Bézier clipping of sums along random rays, against the oracle's roots.

use glam::{DVec3, Vec3};
use metaball_core::gpu::Gpu;
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Kernel, Metaball, Ray, Scene, Verdict};

use super::random::Random;
use super::records::{Record, evaluate, record_shader};
use crate::Clipping;

/// First roots of sums less T over intervals: a record is T, the number of balls, and of each ball a,
/// the strength, and the interval's ends in parts of the chord.
const SUMS: &str = record_shader!(
    "#import kanamori_peel::bernstein::{along_chord, Curve, degree}\n\
     #import kanamori_peel::bezier::part\n\
     #import kanamori_peel::clipping::first_root",
    "
                var sum = Curve();
                for (var i = 0u; i <= degree(); i++) {
                    sum.d[i] = -record[0];
                }
                for (var ball = 0u; ball < u32(record[1]); ball++) {
                    let at = 2u + 4u * ball;
                    let whole = along_chord(record[at], record[at + 1u]);
                    let own = part(whole, record[at + 2u], record[at + 3u]);
                    for (var i = 0u; i <= degree(); i++) {
                        sum.d[i] += own.d[i];
                    }
                }
                outcome[0] = first_root(sum);"
);

/// Balls of a scene: as many as a record holds.
const BALLS: usize = 4;

/// A ball along a ray.
struct Chord {
    strength: f64,
    middle: f64,
    /// Half the chord, in the ray's t.
    half: f64,
    /// Q²/R².
    a: f64,
}

/// A few balls, and a ray that meets one at least.
struct Sum {
    balls: Vec<Metaball>,
    ray: Ray,
    chords: Vec<Chord>,
    kernel: Kernel,
    threshold: f32,
}

impl Sum {
    /// Of four in a row the first has a threshold that the ray reaches aslant or not at all; the others
    /// one that its first rise just touches, just passes, and just does not reach, by 0.4 %.
    fn random(random: &mut Random, kernel: Kernel, index: usize) -> Self {
        let mut point =
            |reach: f32| Vec3::from([(); 3].map(|()| reach * (2.0 * random.unit() - 1.0)));
        let (centers, target) = ([(); BALLS].map(|()| point(0.7)), point(0.3));
        let eye = 4.0 * point(1.0).normalize_or(Vec3::Z);
        let ray = Ray::new(eye, (target - eye).normalize());
        let balls: Vec<_> = centers
            .into_iter()
            .map(|center| {
                let (radius, strength) = (0.4 + 0.6 * random.unit(), 0.3 + 0.7 * random.unit());
                Metaball { center, radius, strength }
            })
            .collect();
        let chords = balls.iter().filter_map(|ball| Chord::new(ball, &ray)).collect();
        let mut sum = Self { balls, ray, chords, kernel, threshold: 0.1 + 0.8 * random.unit() };
        let nudge = [None, Some(1.0), Some(0.996), Some(1.004)][index % 4];
        if let (Some(nudge), Some(rise)) = (nudge, sum.first_rise()) {
            sum.threshold = (nudge * rise) as f32;
        }
        sum
    }

    fn field(&self, t: f64) -> f64 {
        let of = |chord: &Chord| {
            // 1 − v, with v = 4a s(1 − s) and s the position on the chord.
            let aside = (t - chord.middle) / chord.half;
            let v = chord.a * (1.0 - aside * aside);
            if v > 0.0 { chord.strength * self.kernel.value(1.0 - v) } else { 0.0 }
        };
        self.chords.iter().map(of).sum()
    }

    /// The field's first local maximum along the ray of at least 0.25, by thirds of a fine grid's cells.
    fn first_rise(&self) -> Option<f64> {
        const STEP: f64 = 0.005;
        let at = |index: u32| self.field(2.0 + STEP * f64::from(index));
        let top = (1..800).find(|&index| {
            at(index) >= 0.25 && at(index) > at(index - 1) && at(index) >= at(index + 1)
        })?;
        let (mut low, mut high) =
            (2.0 + STEP * f64::from(top - 1), 2.0 + STEP * f64::from(top + 1));
        for _ in 0..60 {
            let third = (high - low) / 3.0;
            if self.field(low + third) < self.field(high - third) {
                low += third;
            } else {
                high -= third;
            }
        }
        Some(self.field(0.5 * (low + high)))
    }

    /// Intervals between the chords' ends in which there are balls, with their records.
    fn intervals(&self) -> Vec<([f64; 2], Record)> {
        let ends = |chord: &Chord| [chord.middle - chord.half, chord.middle + chord.half];
        let mut points: Vec<_> = self.chords.iter().flat_map(ends).collect();
        points.sort_by(f64::total_cmp);
        let interval = |pair: &[f64]| {
            let (low, high) = (pair[0], pair[1]);
            let active = self
                .chords
                .iter()
                .filter(|chord| (0.5 * (low + high) - chord.middle).abs() < chord.half);
            let mut record = Record::default();
            record[0] = self.threshold;
            for chord in active {
                let position =
                    |t: f64| (((t - chord.middle) / chord.half + 1.0) / 2.0).clamp(0.0, 1.0) as f32;
                let at = 2 + 4 * record[1] as usize;
                let own = [chord.a as f32, chord.strength as f32, position(low), position(high)];
                record[at..at + 4].copy_from_slice(&own);
                record[1] += 1.0;
            }
            (record[1] > 0.0).then_some(([low, high], record))
        };
        points.windows(2).filter_map(interval).collect()
    }

    /// The truth with a threshold that is so much higher.
    fn truth(&self, higher: f64) -> Truth {
        let threshold = (f64::from(self.threshold) + higher) as f32;
        let scene = Scene::new(self.balls.clone(), self.kernel, threshold).expect("legal");
        Oracle::new(&scene).first_hit(&self.ray)
    }
}

impl Chord {
    fn new(ball: &Metaball, ray: &Ray) -> Option<Self> {
        let direction: DVec3 = ray.direction.as_dvec3();
        let to_center = ball.center.as_dvec3() - ray.origin.as_dvec3();
        let middle = to_center.dot(direction) / direction.length_squared();
        let radius_squared = f64::from(ball.radius).powi(2);
        let half_squared = radius_squared - (to_center - middle * direction).length_squared();
        (half_squared > 0.0).then(|| Self {
            strength: f64::from(ball.strength),
            middle,
            half: (half_squared / direction.length_squared()).sqrt(),
            a: half_squared / radius_squared,
        })
    }
}

/// What is wrong with the first roots found along rays, and how many rays hit and miss.
///
/// f32 moves a sum of four strengths up to 1 by at most 4 · 128 · 2⁻²³ (`bernstein_forms_are_the_kernel`),
/// and clipping it by 200 roundings of numbers up to 4: 2e-4 with a margin. What was found must therefore
/// not come before the oracle's root for a threshold that is as much lower, nor after that for one as much
/// higher: touches and double roots need no exception. The ways of clipping that take a touch for a root
/// (`clipping_finds_the_first_root`) do so from 60 w² below, for four strengths. Along the ray a root is as
/// near as the threshold w promises.
fn judge(
    gpu: &Gpu,
    sums: &[Sum],
    clipping: Clipping,
    width: f64,
    allowed_width: f64,
) -> (Vec<String>, [usize; 2]) {
    let unclear = match clipping {
        Clipping::ShortStack => 2e-4,
        Clipping::Iterative | Clipping::Original => 2e-4 + 60.0 * width * width,
    };
    let mut constants = vec![("33", width)];
    if clipping == Clipping::ShortStack {
        constants.push(("34", 3.0));
    }
    let intervals: Vec<_> = sums.iter().map(Sum::intervals).collect();
    let records: Vec<_> = intervals.iter().flatten().map(|&(_, record)| record).collect();
    let mut roots = evaluate(gpu, SUMS, sums[0].kernel, clipping, &constants, &records).into_iter();
    let (mut wrong, mut verdicts) = (Vec::new(), [0, 0]);
    for (sum, intervals) in sums.iter().zip(&intervals) {
        let mut found = None;
        for (&([low, high], _), root) in intervals.iter().zip(&mut roots) {
            let root = f64::from(root[0]);
            if found.is_none() && root <= 1.0 {
                found = Some((low + (high - low) * root, allowed_width * (high - low) + 4e-6));
            }
        }
        let (lower, higher) = (sum.truth(-unclear), sum.truth(unclear));
        let is_right = match found {
            Some((t, near)) => lower.t <= t + near && higher.t >= t - near,
            None => higher.verdict == Verdict::Miss,
        };
        verdicts[usize::from(found.is_none())] += 1;
        if !is_right {
            wrong.push(format!("{clipping:?}, {}: {found:?}, {lower:?}, {higher:?}", sum.kernel));
        }
    }
    (wrong, verdicts)
}

#[test]
fn clipping_finds_the_oracle_s_roots() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut random = Random::new(5);
    for kernel in [Kernel::QUARTIC, Kernel::Wyvill] {
        let sums: Vec<_> = (0..400).map(|index| Sum::random(&mut random, kernel, index)).collect();
        let touched = sums.iter().filter(|sum| sum.truth(0.0).margin < 1e-6).count();
        assert!(touched > 50, "{touched} rays touch");
        for (clipping, width) in [
            (Clipping::ShortStack, 1e-3),
            (Clipping::ShortStack, 1e-4),
            (Clipping::Iterative, 1e-3),
            (Clipping::Original, 1e-3),
        ] {
            let (wrong, [hits, misses]) = judge(&gpu, &sums, clipping, width, width);
            assert!(wrong.is_empty(), "{} of {}: {:?}", wrong.len(), sums.len(), wrong[0]);
            assert!(hits > 100 && misses > 50, "{hits} hits, {misses} misses");
        }
        let (wrong, _) = judge(&gpu, &sums, Clipping::ShortStack, 0.2, 1e-3);
        assert!(wrong.len() > 20, "the canary sings: {} are wrong", wrong.len());
    }
}
