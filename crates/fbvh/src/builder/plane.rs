//! Where to cut a node: the surface area heuristic by binning (Wald 2007; section 5.1.1).

use std::iter;

use glam::{Vec3A, Vec3Swizzles};
use metaball_core::Aabb;

use super::ball::Ball;
use crate::options::Cost;

/// The upper limit of [`Options::bins`](crate::Options::bins).
pub(super) const MAX_BINS: usize = 16;

/// A plane across an axis, and what cutting there is expected to cost.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane {
    pub(super) axis: usize,
    pub(super) at: f32,
    /// ρ(A)C(A) + ρ(B)C(B), without the traversal step.
    pub(super) cost: f32,
}

/// Balls of one bin: how many, and the box around them.
#[derive(Clone, Copy)]
struct Bin {
    count: u32,
    min: Vec3A,
    max: Vec3A,
}

impl Bin {
    const EMPTY: Self = Self { count: 0, min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY };

    fn add(&mut self, min: Vec3A, max: Vec3A) {
        self.count += 1;
        self.min = self.min.min(min);
        self.max = self.max.max(max);
    }

    fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }
}

/// The best of the planes between the bins of a Fitted node. A ball counts on each side that its
/// support reaches; the sides' boxes are cut at the plane. What fitting will take off them is left
/// out: to know it for each plane costs more than the two in a hundred fewer balls a ray gains.
pub(super) fn cut_space(balls: &[Ball], bounds: &Aabb, bins: usize, cost: Cost) -> Option<Plane> {
    // A ball is counted in the bin where it begins and in the one where it ends: those that begin
    // before a plane reach its left side, those that end behind it the right one.
    let mut begin = [[0i32; 4]; MAX_BINS];
    let mut end = [[0i32; 4]; MAX_BINS];
    let low = Vec3A::from(bounds.min);
    let side = Vec3A::from(bounds.max) - low;
    let scale = Vec3A::splat(bins as f32) / side;
    for ball in balls {
        let center = ball.center() - low;
        let first = bin_of((center - ball.radius()) * scale, bins);
        let last = bin_of((center + ball.radius()) * scale, bins);
        for axis in 0..3 {
            begin[first[axis]][axis] += 1;
            end[last[axis]][axis] += 1;
        }
    }

    // All three axes at once: half the area of a part is that of the cut and, of the four faces
    // across it, length times half their girth.
    let (width, height) = (side.yzx(), side.zxy());
    let half_area = |length: Vec3A| width * height + length * (width + height);
    let whole = half_area(side);
    let share = |part: Vec3A| Vec3A::select(whole.cmpgt(Vec3A::ZERO), part / whole, Vec3A::ONE);
    // Where both sides get all balls, two leaves never cost less than one.
    let count = balls.len() as i32;
    let useless = Vec3A::splat(2.0 * count as f32);
    let (mut left, mut right) = ([0; 4], [count; 4]);
    let balls_of = |[x, y, z, _]: [i32; 4]| Vec3A::new(x as f32, y as f32, z as f32);
    let mut least = Vec3A::splat(f32::MAX);
    let mut best = Vec3A::ZERO;
    for bin in 1..bins {
        for axis in 0..4 {
            left[axis] += begin[bin - 1][axis];
            right[axis] -= end[bin - 1][axis];
        }
        let (left, right) = (balls_of(left), balls_of(right));
        let length = side * (bin as f32 / bins as f32);
        let expected = share(half_area(length)) * cost.of_each(left)
            + share(half_area(side - length)) * cost.of_each(right);
        let better = expected.cmplt(least) & (left + right).cmplt(useless);
        least = Vec3A::select(better, expected, least);
        best = Vec3A::select(better, length, best);
    }
    let axis = (1..3).fold(0, |best, axis| if least[axis] < least[best] { axis } else { best });
    let at = bounds.min[axis] + best[axis];
    (at > bounds.min[axis] && at < bounds.max[axis]).then_some(Plane {
        axis,
        at,
        cost: least[axis],
    })
}

/// The best of the planes between the bins of own balls' centres, for a node of the modified BVH:
/// each ball counts on the side of its centre, and each side has the box around its supports.
pub(super) fn cut_centers(own: &[Ball], bounds: &Aabb, bins: usize, cost: Cost) -> Option<Plane> {
    let centers = centers_of(own);
    let (low, high) = (Vec3A::from(centers.min), Vec3A::from(centers.max));
    let scale = Vec3A::splat(bins as f32) / (high - low);
    let mut filled = [[Bin::EMPTY; MAX_BINS]; 3];
    for ball in own {
        let center = ball.center();
        let bin = bin_of((center - low) * scale, bins);
        for axis in 0..3 {
            filled[axis][bin[axis]].add(center - ball.radius(), center + ball.radius());
        }
    }

    let whole = half_area(bounds.min.into(), bounds.max.into());
    let mut best: Option<Plane> = None;
    for axis in 0..3 {
        let right = suffixes(&filled[axis][..bins]);
        let mut left = Bin::EMPTY;
        for bin in 1..bins {
            left.merge(&filled[axis][bin - 1]);
            let right = &right[bin];
            if left.count == 0 || right.count == 0 {
                continue;
            }
            let at = low[axis] + (high[axis] - low[axis]) * (bin as f32 / bins as f32);
            let cost = share(half_area(left.min, left.max), whole) * cost.of(left.count as f32)
                + share(half_area(right.min, right.max), whole) * cost.of(right.count as f32);
            if best.is_none_or(|best| cost < best.cost) {
                best = Some(Plane { axis, at, cost });
            }
        }
    }
    best
}

/// What a given plane across a Fitted node costs, its sides not fitted. `None` where the plane is
/// not inside the box.
pub(super) fn weigh(
    balls: &[Ball],
    bounds: &Aabb,
    (axis, at): (usize, f32),
    cost: Cost,
) -> Option<Plane> {
    if !(at > bounds.min[axis] && at < bounds.max[axis]) {
        return None;
    }
    let (left, right) = cut(bounds, axis, at);
    let whole = half_area(bounds.min.into(), bounds.max.into());
    let weight = |side: &Aabb| {
        let reaching = balls.iter().filter(|ball| ball.reaches(side)).count();
        share(half_area(side.min.into(), side.max.into()), whole) * cost.of(reaching as f32)
    };
    Some(Plane { axis, at, cost: weight(&left) + weight(&right) })
}

/// The two parts of a box on either side of a plane that crosses it.
pub(super) fn cut(bounds: &Aabb, axis: usize, at: f32) -> (Aabb, Aabb) {
    let (mut left, mut right) = (*bounds, *bounds);
    left.max[axis] = at;
    right.min[axis] = at;
    (left, right)
}

/// Where a plane cuts a box: a box without thickness.
pub(super) fn face(bounds: &Aabb, plane: &Plane) -> Aabb {
    let mut face = *bounds;
    face.min[plane.axis] = plane.at;
    face.max[plane.axis] = plane.at;
    face
}

/// The box around the centres.
pub(super) fn centers_of(balls: &[Ball]) -> Aabb {
    let (mut min, mut max) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
    for ball in balls {
        min = min.min(ball.center());
        max = max.max(ball.center());
    }
    Aabb { min: min.into(), max: max.into() }
}

/// The axis along which the box is longest; the first of them.
pub(super) fn longest_axis(bounds: &Aabb) -> usize {
    let side = bounds.extent();
    (1..3).fold(0, |longest, axis| if side[axis] > side[longest] { axis } else { longest })
}

/// Bins of a point in bin widths from the low corner, to the nearest float. NaN, from an axis without
/// extent, is bin 0.
///
/// Adding 2²³ leaves a number's whole part in the low bits of its representation: for all axes at
/// once, where conversions of floats to integers go one by one.
fn bin_of(position: Vec3A, bins: usize) -> [usize; 3] {
    const WHOLE: f32 = (1 << 23) as f32;
    let last = Vec3A::splat(bins as f32 - 1.0);
    let shifted = (position - 0.5).max(Vec3A::ZERO).min(last) + WHOLE;
    shifted.to_array().map(|position| position.to_bits() as usize % MAX_BINS)
}

/// For each bin, the union of it and all bins behind it.
fn suffixes(bins: &[Bin]) -> [Bin; MAX_BINS] {
    let mut suffixes = [Bin::EMPTY; MAX_BINS];
    let mut behind = Bin::EMPTY;
    for (suffix, bin) in iter::zip(&mut suffixes, bins).rev() {
        behind.merge(bin);
        *suffix = behind;
    }
    suffixes
}

/// The probability that a ray through the whole meets the part: 1 for a whole without area.
fn share(part: f32, whole: f32) -> f32 {
    if whole > 0.0 { part / whole } else { 1.0 }
}

/// Half the area of a box's faces, 0 for an empty box.
fn half_area(min: Vec3A, max: Vec3A) -> f32 {
    if min.cmpgt(max).any() {
        return 0.0;
    }
    let side = max - min;
    side.x * side.y + side.y * side.z + side.z * side.x
}
