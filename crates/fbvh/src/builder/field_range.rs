//! Whether the field is above or below T in a whole box.
//!
//! Over a box every ball's part of the field is largest at the box's nearest point to the centre and
//! smallest at its farthest, so sums of the two bound the field. Negative balls have sums of their own: what
//! they take away at least, or at most, raises the level that the others have to reach.
//!
//! Sums are made in f32 first, and decide wherever they are farther from T than all of their rounding.
//! A lower bound ends as soon as it is certainly above T, an upper one as soon as it is above: a box that
//! is not empty is only divided further, which needs no certainty. What is left open is summed in f64.

use glam::{DVec3, Vec3A};
use metaball_core::Aabb;

use super::Builder;
use super::ball::Ball;

/// Sums of n ≤ 2³² non-negative f64 terms of a few products each err by less than this share.
const ROUNDING: f64 = 1e-6;

/// The depth of a ball, at most 1 in size, errs in f32 by ten roundings of 6e-8: two of each offset, three
/// of their squares' sum, the radius's square, the quotient and the difference. And what a kernel's own
/// roundings are worth in depth.
const DEPTH_ROUNDING: f64 = 6e-7 + 5e-7;

/// What else a kernel's own roundings are, of values up to 1.
const VALUE_ROUNDING: f64 = 2e-6;

/// A sum of n terms that are not negative errs in f32 by less than n times this share of it, for n up to
/// [`MOST_TERMS`]: each addition by a factor of 1 + 2⁻²⁴, and (1 + 2⁻²⁴)ⁿ − 1 ≤ 1.72n·2⁻²⁴.
const SUM_ROUNDING: f64 = 1.1e-7;

/// The longest list that is summed in f32 for certain.
const MOST_TERMS: usize = 1 << 24;

impl Builder<'_> {
    /// Whether the field is certainly at T or below in the whole box.
    pub(super) fn is_empty(&self, list: &[Ball], bounds: &Aabb) -> bool {
        let (near_low, near_high) = (Vec3A::from(bounds.min), Vec3A::from(bounds.max));
        let (negative, list) = self.by_sign(list);
        let near_level =
            self.near_level(negative, |center| (center - near_low).max(near_high - center));
        let mut near_most = 0.0;
        let is_reached = list.iter().any(|ball| {
            let center = ball.center();
            near_most += self.near_part_at(ball, center - center.clamp(near_low, near_high));
            near_most > near_level
        });
        if is_reached {
            return false;
        }
        let certain = f64::from(near_level) - self.error(negative.len(), near_level);
        let certain = certain * (1.0 - ROUNDING) * (1.0 - ROUNDING);
        if f64::from(near_most) + self.error(list.len(), near_most) < certain {
            return true;
        }
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let level = self.level(negative, |center| (center - low).max(high - center));
        let level = level * (1.0 - ROUNDING);
        let mut most = 0.0;
        list.iter().all(|ball| {
            let center = ball.center().as_dvec3();
            most += self.part_at(ball, center - center.clamp(low, high));
            most <= level
        })
    }

    /// Whether the field is certainly above T in the whole box.
    pub(super) fn is_solid(&self, list: &[Ball], bounds: &Aabb) -> bool {
        // A ball that adds anything everywhere contains the box.
        if self.radius.is_some_and(|radius| bounds.extent().length() > 2.0 * radius) {
            return false;
        }
        let (near_low, near_high) = (Vec3A::from(bounds.min), Vec3A::from(bounds.max));
        let (negative, list) = self.by_sign(list);
        let near_level =
            self.near_level(negative, |center| center - center.clamp(near_low, near_high));
        let certain = f64::from(near_level) + self.error(negative.len(), near_level);
        let certain = certain * (1.0 + ROUNDING) * (1.0 + ROUNDING);
        let mut near_least = 0.0;
        let is_certain = list.iter().any(|ball| {
            let center = ball.center();
            let farthest = (center - near_low).max(near_high - center);
            if farthest.length_squared() >= ball.radius() * ball.radius() {
                return false;
            }
            near_least += self.near_part_at(ball, farthest);
            near_least > near_level
                && f64::from(near_least) - self.error(list.len(), near_least) > certain
        });
        if is_certain || near_least <= near_level {
            return is_certain;
        }
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let level = self.level(negative, |center| center - center.clamp(low, high));
        let level = level * (1.0 + ROUNDING);
        let mut least = 0.0;
        list.iter().any(|ball| {
            let center = ball.center().as_dvec3();
            least += self.part_at(ball, (center - low).max(high - center));
            least > level
        })
    }

    /// T, and what negative balls take away at these offsets from their centres: what the others have to add.
    fn level(&self, negative: &[Ball], offset: impl Fn(DVec3) -> DVec3) -> f64 {
        negative.iter().fold(f64::from(self.threshold), |level, ball| {
            level - self.part_at(ball, offset(ball.center().as_dvec3()))
        })
    }

    /// [`Builder::level`] in f32.
    #[inline]
    fn near_level(&self, negative: &[Ball], offset: impl Fn(Vec3A) -> Vec3A) -> f32 {
        negative.iter().fold(self.threshold, |level, ball| {
            level - self.near_part_at(ball, offset(ball.center()))
        })
    }

    /// What a sum in f32 over so many balls differs from the true one by, at most.
    fn error(&self, balls: usize, sum: f32) -> f64 {
        if balls > MOST_TERMS {
            return f64::INFINITY;
        }
        // Below the least normal number products err by less than that.
        let least = f64::from(f32::MIN_POSITIVE);
        let rounding = DEPTH_ROUNDING * self.kernel.steepest() + VALUE_ROUNDING;
        let term = rounding * f64::from(self.greatest_strength) + least;
        balls as f64 * (term + SUM_ROUNDING * f64::from(sum))
    }

    /// [`Builder::part_at`] in f32.
    #[inline]
    fn near_part_at(&self, ball: &Ball, offset: Vec3A) -> f32 {
        let radius = ball.radius();
        let depth = 1.0 - offset.length_squared() / (radius * radius);
        ball.strength * self.kernel.value_at_depth(depth)
    }

    /// What a ball adds to the field at an offset from its centre.
    fn part_at(&self, ball: &Ball, offset: DVec3) -> f64 {
        let radius = f64::from(ball.radius());
        let ratio = offset.length_squared() / (radius * radius);
        f64::from(ball.strength) * self.kernel.value(ratio)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use glam::Vec3;
    use metaball_core::Kernel;
    use proptest::prelude::*;

    use super::*;
    use crate::Options;
    use crate::builder::branch::GrownPieces;
    use crate::builder::{common, greatest_strength};

    /// A box among balls of radii that differ by up to 10,000. Coordinates are few, so that faces go
    /// through centres, rims and each other.
    fn balls_and_box() -> impl Strategy<Value = (Vec<Ball>, Aabb)> {
        let coordinate =
            || prop_oneof![-2.0f32..2.0, (-4i8..=4).prop_map(|at| f32::from(at) / 2.0)];
        let point = move || [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from);
        let radius = prop_oneof![
            3 => 0.5f32..2.0,
            1 => prop::sample::select(vec![1e-2f32, 1.0, 1.5, 1e2]),
        ];
        let ball = (point(), radius, prop_oneof![3 => 0.1f32..3.0, 1 => -2.0f32..-0.1]);
        let copies = prop::sample::select(vec![1usize, 1, 1, 40]);
        let side = || prop_oneof![0.0f32..2.0, Just(0.0f32), Just(0.5f32), 1e-4f32..1e-2];
        let sides = [side(), side(), side()].prop_map(Vec3::from);
        (prop::collection::vec(ball, 1..12), copies, point(), sides).prop_map(
            |(balls, copies, min, sides)| {
                let mut balls = balls;
                balls.sort_by_key(|&(.., strength)| strength > 0.0);
                let copied = balls.into_iter().flat_map(|ball| std::iter::repeat_n(ball, copies));
                let numbered = copied.enumerate().map(|(index, (center, radius, strength))| {
                    Ball::new(center, radius, strength, index as u32)
                });
                (numbered.collect(), Aabb { min, max: min + sides })
            },
        )
    }

    /// A builder of certified trees of these balls.
    fn builder(kernel: Kernel, threshold: f32, balls: &[Ball]) -> Builder<'static> {
        Builder {
            kernel,
            threshold,
            max_depth: 64,
            radius: common(balls, Ball::radius),
            strength: common(balls, |ball| ball.strength),
            greatest_strength: greatest_strength(balls),
            has_negative: balls.iter().any(Ball::is_negative),
            options: Options::certified(),
            grown: GrownPieces::default(),
            goes_on: &|| true,
            broken_off: AtomicBool::new(false),
        }
    }

    /// The field's range over the corners, faces and inside of a box, and the points nearest to the
    /// centres, from f64.
    fn sampled(kernel: Kernel, balls: &[Ball], bounds: &Aabb) -> (f64, f64) {
        const STEPS: usize = 6;
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let lattice = (0..(STEPS + 1).pow(3)).map(|at| {
            let step = |divisor: usize| (at / divisor % (STEPS + 1)) as f64 / STEPS as f64;
            let part = DVec3::new(step(1), step(STEPS + 1), step((STEPS + 1).pow(2)));
            low * (1.0 - part) + high * part
        });
        let nearest = balls.iter().map(|ball| ball.center().as_dvec3().clamp(low, high));
        lattice.chain(nearest).fold((f64::MAX, f64::MIN), |(least, most), point| {
            let field: f64 = balls
                .iter()
                .map(|ball| {
                    let radius = f64::from(ball.radius());
                    let offset = ball.center().as_dvec3() - point;
                    f64::from(ball.strength)
                        * kernel.value(offset.length_squared() / radius.powi(2))
                })
                .sum();
            (least.min(field), most.max(field))
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 2000,
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        /// T is set to what was sampled, so that verdicts are as tight as they get: where the field
        /// takes its least at a point of the lattice, a box is neither solid nor, for its most, empty.
        #[test]
        fn verdicts_hold_where_the_field_is_sampled(
            (balls, bounds) in balls_and_box(),
            kernel in prop::sample::select(Kernel::all().collect::<Vec<_>>()),
            part in prop::sample::select(vec![0.5f32, 0.99, 1.0, 1.01, 2.0]),
        ) {
            let (least, most) = sampled(kernel, &balls, &bounds);
            for threshold in [least, most].map(|field| field as f32 * part) {
                if threshold <= 0.0 {
                    continue;
                }
                let builder = builder(kernel, threshold, &balls);
                let threshold = f64::from(threshold);
                if builder.is_solid(&balls, &bounds) {
                    prop_assert!(least > threshold, "solid, but {} <= {}", least, threshold);
                }
                if builder.is_empty(&balls, &bounds) {
                    prop_assert!(most <= threshold, "empty, but {} > {}", most, threshold);
                }
            }
        }

        /// T is set to the bounds themselves, where sums in f32 are on either side of it by chance.
        #[test]
        fn sums_in_f32_decide_nothing_that_sums_in_f64_would_not(
            (balls, bounds) in balls_and_box(),
            kernel in prop::sample::select(Kernel::all().collect::<Vec<_>>()),
        ) {
            let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
            let any = builder(kernel, 1.0, &balls);
            let (negative, positive) = any.by_sign(&balls);
            let sum = |balls: &[Ball], offset: fn(DVec3, DVec3, DVec3) -> DVec3| {
                let part =
                    |ball: &Ball| any.part_at(ball, offset(ball.center().as_dvec3(), low, high));
                balls.iter().map(part).sum::<f64>()
            };
            let near = |center: DVec3, low: DVec3, high: DVec3| center - center.clamp(low, high);
            let far = |center: DVec3, low: DVec3, high: DVec3| (center - low).max(high - center);
            let (most, least) = (sum(positive, near), sum(positive, far));
            let taken = (-sum(negative, far), -sum(negative, near));
            for (added, taken, is_least) in [(most, taken.0, false), (least, taken.1, true)] {
                for part in [-4e-6, -2e-6, 0.0, 2e-6, 4e-6] {
                    let threshold = added * (1.0 + part) - taken;
                    if threshold < f64::from(f32::MIN_POSITIVE) {
                        continue;
                    }
                    let builder = builder(kernel, threshold as f32, &balls);
                    let level = f64::from(builder.threshold) + taken;
                    if is_least && builder.is_solid(&balls, &bounds) {
                        prop_assert!(added > level * (1.0 + ROUNDING));
                    }
                    if !is_least && builder.is_empty(&balls, &bounds) {
                        prop_assert!(added <= level * (1.0 - ROUNDING));
                    }
                }
            }
        }
    }

    /// The quartic is 9/16 at half the radius: of two balls that share a centre a part is left.
    #[test]
    fn what_is_taken_away_raises_what_is_needed() {
        let balls = [Ball::new(Vec3::ZERO, 2.0, -1.0, 1), Ball::new(Vec3::ZERO, 2.0, 3.0, 0)];
        let builder = |threshold| builder(Kernel::QUARTIC, threshold, &balls);
        let point = Aabb { min: Vec3::X, max: Vec3::X };
        assert!(builder(1.1249).is_solid(&balls, &point));
        assert!(!builder(1.1251).is_solid(&balls, &point));
        assert!(!builder(1.1249).is_empty(&balls, &point));
        assert!(builder(1.1251).is_empty(&balls, &point));
        // Over a box the bounds of both are apart.
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::X };
        assert!(builder(0.6874).is_solid(&balls, &bounds));
        assert!(!builder(0.6876).is_solid(&balls, &bounds));
        assert!(!builder(2.4374).is_empty(&balls, &bounds));
        assert!(builder(2.4376).is_empty(&balls, &bounds));
    }

    #[test]
    fn one_ball_decides_what_it_holds() {
        let ball = [Ball::new(Vec3::ZERO, 2.0, 1.0, 0)];
        // The quartic is 9/16 at distance 1 and 1/16 at √3.
        let builder = |threshold| builder(Kernel::QUARTIC, threshold, &ball);
        let bounds = Aabb { min: Vec3::new(1.0, -1.0, -1.0), max: Vec3::ONE };
        assert!(builder(0.0624).is_solid(&ball, &bounds));
        assert!(!builder(0.0626).is_solid(&ball, &bounds));
        assert!(!builder(0.5624).is_empty(&ball, &bounds));
        assert!(builder(0.5626).is_empty(&ball, &bounds));
    }
}
