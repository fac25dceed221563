//! Whether the field is above or below T in a whole box.
//!
//! Over a box every ball's part of the field is largest at the box's nearest point to the centre and
//! smallest at its farthest, so sums of the two bound the field.
//!
//! Sums of either kind end as soon as they are above T. So a few balls suffice to show that a box is
//! solid, or that it is not empty; and balls that do not contain the whole box, most of them in all but
//! the smallest boxes, add nothing to the lower bound. Boxes that are neither, which are only divided
//! further, need no certainty: f32 decides most of them, and f64 confirms only what f32 finds solid or
//! empty.

use glam::{DVec3, Vec3A};
use metaball_core::Aabb;

use super::Builder;
use super::ball::Ball;

/// Sums of n ≤ 2³² non-negative f64 terms of a few products each err by less than this share.
const ROUNDING: f64 = 1e-6;

impl Builder {
    /// Whether the field is certainly at T or below in the whole box.
    pub(super) fn is_empty(&self, list: &[Ball], bounds: &Aabb) -> bool {
        let (near_low, near_high) = (Vec3A::from(bounds.min), Vec3A::from(bounds.max));
        let mut most = 0.0;
        let is_reached = list.iter().any(|ball| {
            let center = ball.center();
            most += self.near_part_at(ball, center - center.clamp(near_low, near_high));
            most > self.threshold
        });
        if is_reached {
            return false;
        }
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let threshold = f64::from(self.threshold) * (1.0 - ROUNDING);
        let mut most = 0.0;
        list.iter().all(|ball| {
            let center = ball.center().as_dvec3();
            most += self.part_at(ball, center - center.clamp(low, high));
            most <= threshold
        })
    }

    /// Whether the field is certainly above T in the whole box.
    pub(super) fn is_solid(&self, list: &[Ball], bounds: &Aabb) -> bool {
        // A ball that adds anything everywhere contains the box.
        if self.radius.is_some_and(|radius| bounds.extent().length() > 2.0 * radius) {
            return false;
        }
        let (near_low, near_high) = (Vec3A::from(bounds.min), Vec3A::from(bounds.max));
        let mut near_least = 0.0;
        let may_be = list.iter().any(|ball| {
            let center = ball.center();
            let farthest = (center - near_low).max(near_high - center);
            if farthest.length_squared() >= ball.radius() * ball.radius() {
                return false;
            }
            near_least += self.near_part_at(ball, farthest);
            near_least > self.threshold
        });
        if !may_be {
            return false;
        }
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let threshold = f64::from(self.threshold) * (1.0 + ROUNDING);
        let mut least = 0.0;
        list.iter().any(|ball| {
            let center = ball.center().as_dvec3();
            least += self.part_at(ball, (center - low).max(high - center));
            least > threshold
        })
    }

    /// [`Builder::part_at`] in f32, for what that confirms, or what need not be certain.
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
    use glam::Vec3;
    use metaball_core::Kernel;
    use proptest::prelude::*;

    use super::*;
    use crate::Options;
    use crate::builder::common;

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
        let ball = (point(), radius, 0.1f32..3.0);
        let copies = prop::sample::select(vec![1usize, 1, 1, 40]);
        let side = || prop_oneof![0.0f32..2.0, Just(0.0f32), Just(0.5f32), 1e-4f32..1e-2];
        let sides = [side(), side(), side()].prop_map(Vec3::from);
        (prop::collection::vec(ball, 1..12), copies, point(), sides).prop_map(
            |(balls, copies, min, sides)| {
                let copied = balls.into_iter().flat_map(|ball| std::iter::repeat_n(ball, copies));
                let numbered = copied.enumerate().map(|(index, (center, radius, strength))| {
                    Ball::new(center, radius, strength, index as u32)
                });
                (numbered.collect(), Aabb { min, max: min + sides })
            },
        )
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
        lattice.chain(nearest).fold((f64::MAX, 0.0), |(least, most), point| {
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
                let builder = Builder {
                    kernel,
                    threshold,
                    max_depth: 64,
                    radius: common(&balls, Ball::radius),
                    strength: common(&balls, |ball| ball.strength),
                    options: Options::certified(),
                };
                let threshold = f64::from(threshold);
                if builder.is_solid(&balls, &bounds) {
                    prop_assert!(least > threshold, "solid, but {} <= {}", least, threshold);
                }
                if builder.is_empty(&balls, &bounds) {
                    prop_assert!(most <= threshold, "empty, but {} > {}", most, threshold);
                }
            }
        }
    }

    #[test]
    fn one_ball_decides_what_it_holds() {
        let ball = [Ball::new(Vec3::ZERO, 2.0, 1.0, 0)];
        // The quartic is 9/16 at distance 1 and 1/16 at √3.
        let builder = |threshold| Builder {
            kernel: Kernel::QUARTIC,
            threshold,
            max_depth: 64,
            radius: Some(2.0),
            strength: Some(1.0),
            options: Options::certified(),
        };
        let bounds = Aabb { min: Vec3::new(1.0, -1.0, -1.0), max: Vec3::ONE };
        assert!(builder(0.0624).is_solid(&ball, &bounds));
        assert!(!builder(0.0626).is_solid(&ball, &bounds));
        assert!(!builder(0.5624).is_empty(&ball, &bounds));
        assert!(builder(0.5626).is_empty(&ball, &bounds));
    }
}
