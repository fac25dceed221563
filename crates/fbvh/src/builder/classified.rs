//! Dividing a node of the certified tree: not in the paper.
//!
//! Over a box every ball's part of the field is largest at the box's nearest point to the centre and
//! smallest at its farthest, so sums of the two bound the field. A box in which the field stays at T
//! or below is dropped; one in which it is above T everywhere is a solid leaf, without a list. Only
//! boxes that could hold surface are divided: the cost follows the surface, not the volume.
//!
//! Sums of either kind end as soon as they are above T. So a few balls suffice to show that a box is
//! solid, or that it is not empty; and balls that do not contain the whole box, most of them in all but
//! the smallest boxes, add nothing to the lower bound. Boxes that are neither, which are only divided
//! further, need no certainty: f32 decides most of them, and f64 confirms only what f32 finds solid or
//! empty.

use glam::{DVec3, Vec3, Vec3A};
use metaball_core::Aabb;

use super::Builder;
use super::ball::Ball;
use super::fit::{Reach, keep_reaching};
use super::part::{Division, Halves, Part, divide};
use super::plane::{Plane, centers_of, cut, cut_space, face, longest_axis};
use crate::options::{Classes, Cost};

/// Sums of n ≤ 2³² non-negative f64 terms of a few products each err by less than this share.
const ROUNDING: f64 = 1e-6;

/// A plane whose cost is more than this share of a leaf's saves too little: the middle of the longest
/// side is as good, and separates surface from interior sooner.
const WORTHWHILE: f32 = 0.85;

/// Boxes whose side is fewer least radii than this have no such plane, since most balls reach across
/// the box: none is looked for.
const BINNED: f32 = 3.0;

/// A cut that leaves more than this share of the balls on both sides is not worth its two lists in a
/// box of at most twice as many balls as a leaf may have.
const SHARED: f32 = 0.6;

/// A list of more than so many full leaves is long: its box may be cut below the smallest side, by the
/// cube root of the number of leaves that it would fill. Most such boxes turn out to be solid or empty.
const LONG: f32 = 3.0;

/// Balls count as coincident where their centres are in a box of at most this share of the least
/// radius: even in boxes of the smallest side, nearly all of them would be on every list.
const COINCIDENT: f32 = 0.125;

/// A box of more least radii than this is cut whatever its list: in f32 a point of it is known to 2⁻²²
/// of the box, too little for the least ball.
const WIDEST: f32 = 16.0;

/// Lists hold what reaches the box widened by this share of its longest side, and solid boxes are solid
/// in that: rounding may take a tracer so far past its faces (`slack` in
/// `shaders/wgsl/fbvh/relative_ray.wgsl`).
const WIDENED: f32 = 4e-6;

impl Builder {
    /// Cuts the box of a node if it may hold surface and is too much for a leaf.
    pub(super) fn divide_classified(
        &self,
        classes: &Classes,
        pool: &mut Vec<Ball>,
        part: &Part,
    ) -> Division {
        let list = &pool[part.list.clone()];
        // A node that was found solid has no list.
        if list.is_empty() {
            return Division::Leaf(0..0);
        }
        if self.is_empty(list, &part.bounds) {
            return Division::Nothing;
        }
        let radii = self.radii(list);
        let plane = match self.classified_plane(classes, list, part, radii) {
            Some(plane) if part.depth < self.max_depth => plane,
            _ => return Division::Leaf(part.list.clone()),
        };
        let side = part.bounds.extent().max_element();
        let face = widened(&face(&part.bounds, &plane), side);
        let is_wide = side > WIDEST * radii.0;
        let (left, right) = divide(pool, &part.list, &plane, &face);
        let separates_none = left.len().min(right.len()) == part.list.len();
        if separates_none && !is_wide && are_coincident(&pool[part.list.clone()]) {
            return Division::Leaf(part.list.clone());
        }
        let (left_bounds, right_bounds) = cut(&part.bounds, plane.axis, plane.at);
        let depth = part.depth + 1;
        let left = Part { list: left, bounds: left_bounds, cell: part.cell, depth };
        let right = Part { list: right, bounds: right_bounds, cell: part.cell, depth };
        match (self.classify(pool, &left), self.classify(pool, &right)) {
            (None, None) => Division::Nothing,
            (Some(only), None) | (None, Some(only)) => Division::One(only),
            (Some(left), Some(right)) => {
                Division::Two(Halves { axis: plane.axis, left, right, left_own: 0 })
            }
        }
    }

    /// Drops the list of a part that is solid, and fits any other to where its balls can make a
    /// surface. `None` where they cannot.
    pub(super) fn classify(&self, pool: &mut [Ball], part: &Part) -> Option<Part> {
        let list = &mut pool[part.list.clone()];
        if self.is_solid(list, &widened(&part.bounds, part.bounds.extent().max_element())) {
            return Some(Part { list: part.list.start..part.list.start, ..*part });
        }
        let strength = match self.strength {
            Some(strength) => f64::from(strength) * list.len() as f64,
            None => list.iter().map(|ball| f64::from(ball.strength)).sum(),
        };
        let reach = Reach::per_ball(self.kernel, self.threshold, strength)?;
        let bounds = reach.clip(list, &part.bounds);
        if bounds.is_empty() {
            return None;
        }
        let mut kept = list.len();
        if bounds != part.bounds {
            kept = keep_reaching(list, &widened(&bounds, bounds.extent().max_element()));
        }
        // No list means solid; so a part that nothing reaches must not stay.
        (kept > 0).then(|| Part { list: part.list.start..part.list.start + kept, bounds, ..*part })
    }

    /// The plane to cut the node at; `None` where it is to be a leaf.
    fn classified_plane(
        &self,
        classes: &Classes,
        list: &[Ball],
        part: &Part,
        (least, largest): (f32, f32),
    ) -> Option<Plane> {
        let axis = longest_axis(&part.bounds);
        let side = part.bounds.extent()[axis];
        let filled = list.len() as f32 / classes.leaf_size.max(1) as f32;
        let smallest = classes.smallest_side / if filled > LONG { filled.cbrt() } else { 1.0 };
        let is_short = |radius: f32| side < smallest * radius;
        let is_wide = side > WIDEST * least;
        // The mean lies between the extremes, and takes longer to compute.
        let is_small = list.len() <= classes.leaf_size as usize
            || is_short(least)
            || is_short(largest) && is_short(self.mean_radius(list, &part.bounds));
        if is_small && !is_wide {
            return None;
        }
        let binned = || {
            let bins = self.options.bins as usize;
            cut_space(list, &part.bounds, bins, Cost::Linear)
                .filter(|plane| plane.cost < WORTHWHILE * list.len() as f32)
        };
        let middle = Plane { axis, at: part.bounds.center()[axis], cost: f32::MAX };
        let plane = if side > BINNED * least { binned().unwrap_or(middle) } else { middle };
        // Neighbouring floats have no middle.
        let (low, high) = (part.bounds.min[plane.axis], part.bounds.max[plane.axis]);
        let is_worthwhile = is_wide || Self::shortens_lists(classes, list, part, &plane);
        (low < plane.at && plane.at < high && is_worthwhile).then_some(plane)
    }

    /// Whether a cut shortens the lists, where a box is almost small enough for a leaf.
    fn shortens_lists(classes: &Classes, list: &[Ball], part: &Part, plane: &Plane) -> bool {
        if list.len() > 2 * classes.leaf_size as usize {
            return true;
        }
        let face = face(&part.bounds, plane);
        let crossing = list.iter().filter(|ball| ball.reaches(&face)).count();
        crossing as f32 <= SHARED * list.len() as f32
    }

    /// Whether the field is certainly at T or below in the whole box.
    fn is_empty(&self, list: &[Ball], bounds: &Aabb) -> bool {
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
    fn is_solid(&self, list: &[Ball], bounds: &Aabb) -> bool {
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

    /// The least and the largest radius of a list.
    fn radii(&self, list: &[Ball]) -> (f32, f32) {
        self.radius.map_or_else(|| radii(list), |radius| (radius, radius))
    }

    /// Mean radius of the balls, each weighted by the most that it adds in the box.
    fn mean_radius(&self, list: &[Ball], bounds: &Aabb) -> f32 {
        let (low, high) = (Vec3A::from(bounds.min), Vec3A::from(bounds.max));
        let (sum, weights) = list.iter().fold((0.0, 0.0), |(sum, weights), ball| {
            let offset = ball.center() - ball.center().clamp(low, high);
            let radius = ball.radius();
            let depth = 1.0 - offset.length_squared() / (radius * radius);
            let weight = ball.strength * self.kernel.value_at_depth(depth);
            (sum + weight * radius, weights + weight)
        });
        sum / weights.max(f32::MIN_POSITIVE)
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

/// The box grown by [`WIDENED`] of the longest side.
fn widened(bounds: &Aabb, side: f32) -> Aabb {
    let wider = Vec3::splat(WIDENED * side);
    Aabb { min: bounds.min - wider, max: bounds.max + wider }
}

/// Whether the centres almost coincide: every part of the box, however often it is cut, is then
/// reached by all of the balls.
fn are_coincident(list: &[Ball]) -> bool {
    centers_of(list).extent().max_element() <= COINCIDENT * radii(list).0
}

/// The least and the largest radius.
fn radii(list: &[Ball]) -> (f32, f32) {
    list.iter().fold((f32::MAX, 0.0), |(least, largest), ball| {
        (least.min(ball.radius()), largest.max(ball.radius()))
    })
}

#[cfg(test)]
mod tests {
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
