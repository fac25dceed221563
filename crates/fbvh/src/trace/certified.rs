//! The search for the surface in one leaf of the certified tree, by exact ranges, in f64.
//!
//! # Why no root can be skipped
//! Along a ray every ball's part of the field rises to the centre's projection m and falls behind it,
//! because its kernel falls with distance. So on an interval \[a, b\] of the ray it is nowhere more
//! than at the point of \[a, b\] nearest to m. With positive strengths the sum of these is an upper
//! bound of the field, and where it is below T there is no root. The bound is exact in the limit of
//! short intervals; no sampling and no assumption is behind it.
//!
//! The search goes through the leaf front to back. It passes by intervals whose bound is below T and
//! halves the others, until the field is certainly above T at an interval's end and certainly rises
//! on all of it: then there is one root in it, the first. That the slope
//! Σ 2q·k′(v)·(m − t)/R² is positive is certain, too: each factor is bounded on the interval.
//!
//! # Rounding
//! v = 1 − |p − x|²/R² is formed from p − o, its projection and its distance from the ray; o is the
//! ray's origin. All are right to a few u·|p − o|, u = 2⁻⁵³, and v to [`Chord::margin`] =
//! 32u(1 + |p − o|/R)², which is added to v for upper bounds and taken off for lower ones. Each term of
//! the sums is then right to 16u of itself and the sum of n of them to n·u more. The shader does the
//! same in f32 from an origin beside the leaf (`fbvh/local.wgsl`), with u = 2⁻²³ and the distance
//! |p − o′| ≤ R + L for balls that reach the leaf's stretch of length L: 8u + 12u·|p − o′|/R by the
//! roundings of p − o′, projection, distance and division, hence its constants 26u and 12u·L.

use glam::DVec3;
use metaball_core::{Hit, Kernel, Ray, Verdict};

use super::{Counter, Tracer};
use crate::Field;

/// A ball that reaches the ray's stretch in a leaf.
struct Chord {
    /// t of the centre's projection.
    middle: f64,
    /// Squared distance of the centre from the ray.
    off_axis_squared: f64,
    inverse_square: f64,
    strength: f64,
    radius: f64,
    /// How far rounding can move v.
    margin: f64,
}

/// What a search of a leaf has come to, with the ray's t.
enum Found {
    /// The field is below T in the leaf.
    Nothing,
    /// The same, but so close to T at the far side that only a hit beyond can tell.
    Doubt,
    /// The ray starts at T or above.
    Inside,
    /// The first root.
    Root(f64),
    /// The field comes closer to T than rounding can tell apart.
    TooClose(f64),
}

/// What is certain of the field on an interval.
struct Bounds {
    /// Nowhere more than this.
    most: f64,
    /// The slope is nowhere less, 1/scene unit.
    least_slope: f64,
    /// At the interval's end at least this.
    end_least: f64,
    /// Least radius among the balls that reach the interval.
    radius: f64,
}

/// Half a unit in the last place of 1.
const UNIT: f64 = f64::EPSILON / 2.0;

/// An interval of this part of the smallest radius in it is short: a root there is known to more
/// than an f32 holds.
const SHORT: f64 = 1.0 / (1u64 << 40) as f64;

impl<F: Field> Tracer<'_, F> {
    /// The first hit along a ray, or the certainty that there is none, or neither.
    pub(super) fn certified_hit(&self, ray: &Ray, counter: &mut impl Counter) -> Hit {
        let mut chords = Chords::new(self.field.kernel());
        let mut doubt = false;
        let hit = self.first_in_order(ray, counter, |leaf, _, counter| {
            let (start, end) = self.stretch(leaf, ray)?;
            let found = self.search_certified(leaf, ray, (start, end), &mut chords, counter);
            let (verdict, t) = match found {
                Found::Nothing => return None,
                Found::Doubt => {
                    doubt = true;
                    return None;
                }
                Found::Inside => (Verdict::Inside, 0.0),
                Found::Root(t) => (Verdict::Hit, t as f32),
                Found::TooClose(t) => (Verdict::Undecided, t as f32),
            };
            Some(Hit { verdict, fallback: false, t, normal: self.normal(leaf, ray, t) })
        });
        hit.unwrap_or(if doubt {
            Hit { verdict: Verdict::Undecided, ..Hit::MISS }
        } else {
            Hit::MISS
        })
    }

    fn search_certified(
        &self,
        leaf: usize,
        ray: &Ray,
        stretch: (f64, f64),
        chords: &mut Chords,
        counter: &mut impl Counter,
    ) -> Found {
        let list = self.list(leaf);
        counter.leaf_test(list.len());
        // A leaf without a list is solid.
        if list.is_empty() {
            return if stretch.0 > 0.0 { Found::Root(stretch.0) } else { Found::Inside };
        }
        chords.gather(self.field, list, ray, stretch);
        chords.first_root(f64::from(self.field.threshold()), stretch, counter)
    }

    /// Where the ray is in the leaf's box, widened by rounding; `None` where it is not.
    fn stretch(&self, leaf: usize, ray: &Ray) -> Option<(f64, f64)> {
        let bounds = self.tree.leaves[leaf].bounds();
        let (mut start, mut end) = (0.0f64, f64::from(ray.t_max));
        for axis in 0..3 {
            let direction = f64::from(ray.direction[axis]);
            let origin = f64::from(ray.origin[axis]);
            let (low, high) = (f64::from(bounds.min[axis]), f64::from(bounds.max[axis]));
            if direction == 0.0 {
                if origin < low || origin > high {
                    return None;
                }
                continue;
            }
            let (near, far) = ((low - origin) / direction, (high - origin) / direction);
            let (near, far) = if near <= far { (near, far) } else { (far, near) };
            start = start.max(near - 4.0 * UNIT * near.abs());
            end = end.min(far + 4.0 * UNIT * far.abs());
        }
        (start <= end).then_some((start, end))
    }
}

/// The balls of a leaf as a ray sees them; kept from leaf to leaf for its memory.
pub(super) struct Chords {
    kernel: Kernel,
    chords: Vec<Chord>,
    /// Squared length of the ray's direction: unit to 1e-7 only, and f64 sees the difference.
    square: f64,
}

impl Chords {
    pub(super) fn new(kernel: Kernel) -> Self {
        Self { kernel, chords: Vec::new(), square: 1.0 }
    }

    /// Takes up the balls that reach the stretch.
    fn gather(&mut self, field: &impl Field, list: &[u32], ray: &Ray, (start, end): (f64, f64)) {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        self.square = direction.length_squared();
        self.chords.clear();
        for &ball in list {
            let support = field.support(ball as usize);
            let radius = f64::from(support.radius);
            let offset: DVec3 = support.center.as_dvec3() - origin;
            let middle = offset.dot(direction) / self.square;
            let away = 1.0 + offset.length() / radius;
            let chord = Chord {
                middle,
                off_axis_squared: (offset - middle * direction).length_squared(),
                inverse_square: (radius * radius).recip(),
                strength: f64::from(field.strength(ball as usize)),
                radius,
                margin: 32.0 * UNIT * away * away,
            };
            if self.v(&chord, middle.clamp(start, end)) + chord.margin > 0.0 {
                self.chords.push(chord);
            }
        }
    }

    /// v = 1 − r²/R² of a ball at t.
    fn v(&self, chord: &Chord, t: f64) -> f64 {
        let along = t - chord.middle;
        1.0 - (chord.off_axis_squared + self.square * along * along) * chord.inverse_square
    }

    /// Where the field first reaches T on the stretch.
    fn first_root(
        &self,
        threshold: f64,
        (start, end): (f64, f64),
        counter: &mut impl Counter,
    ) -> Found {
        if start <= 0.0 {
            let bounds = self.bounds(0.0, 0.0, counter);
            if bounds.end_least >= threshold {
                return Found::Inside;
            }
            if bounds.most >= threshold {
                return Found::TooClose(0.0);
            }
        }
        // Up to `low` the field is below T, from there to `probe` it rises; the interval from `probe`
        // to `high` is looked at.
        let (mut low, mut probe, mut high) = (start, start, end);
        loop {
            let width = high - probe;
            let bounds = self.bounds(probe, high, counter);
            let rises = bounds.least_slope > 0.0;
            // What rises is greatest at its end.
            let is_below = bounds.most < threshold
                || rises
                    && bounds.end_least <= threshold
                    && self.bounds(high, high, counter).most < threshold;
            let is_short = width <= SHORT * bounds.radius;
            if bounds.end_least > threshold && (rises || is_short) {
                return Found::Root(self.close_in_on(threshold, (low, high), counter));
            }
            if is_below || rises {
                // All below T; or rising so close to T that the next interval must tell.
                if high >= end {
                    return if is_below { Found::Nothing } else { Found::Doubt };
                }
                if is_below {
                    low = high;
                }
                probe = high;
                high = (high + 2.0 * width).min(end);
                continue;
            }
            let middle = probe + 0.5 * width;
            if middle <= probe || middle >= high || is_short {
                return Found::TooClose(probe);
            }
            high = middle;
        }
    }

    fn bounds(&self, low: f64, high: f64, counter: &mut impl Counter) -> Bounds {
        counter.evaluation();
        let slope_at = |v: f64| -self.kernel.slope(1.0 - v.clamp(0.0, 1.0));
        let mut bounds =
            Bounds { most: 0.0, least_slope: 0.0, end_least: 0.0, radius: f64::INFINITY };
        for chord in &self.chords {
            let v_most = self.v(chord, chord.middle.clamp(low, high)) + chord.margin;
            if v_most <= 0.0 {
                continue;
            }
            let v_end = self.v(chord, high) - chord.margin;
            bounds.most += chord.strength * self.kernel.value((1.0 - v_most).max(0.0));
            bounds.end_least += chord.strength * self.kernel.value(1.0 - v_end);
            let slope = if chord.middle >= high {
                let v_start = self.v(chord, low) - chord.margin;
                slope_at(v_start).min(slope_at(v_end)) * (chord.middle - high)
            } else {
                -self.steepest(v_most) * (high - chord.middle)
            };
            bounds.least_slope += 2.0 * chord.strength * chord.inverse_square * slope;
            bounds.radius = bounds.radius.min(chord.radius);
        }
        let summing = (self.chords.len() + 24) as f64 * UNIT;
        bounds.most *= 1.0 + summing;
        bounds.end_least *= 1.0 - summing;
        bounds
    }

    /// The greatest derivative of the kernel by v from the rim up to `v`. It grows with v but for
    /// Perlin's kernel, where it is greatest at ρ = 1/3.
    fn steepest(&self, v: f64) -> f64 {
        match self.kernel {
            Kernel::Perlin if v > 8.0 / 9.0 => 20.0 / 9.0,
            kernel => -kernel.slope(1.0 - v.min(1.0)),
        }
    }

    /// The only root between the ends: Newton's steps, kept between the ends.
    fn close_in_on(
        &self,
        threshold: f64,
        (mut low, mut high): (f64, f64),
        counter: &mut impl Counter,
    ) -> f64 {
        let mut t = 0.5 * (low + high);
        loop {
            counter.iteration();
            let (mut excess, mut slope) = (-threshold, 0.0);
            for chord in &self.chords {
                let s = 1.0 - self.v(chord, t);
                let along = 2.0 * self.square * (t - chord.middle) * chord.inverse_square;
                excess += chord.strength * self.kernel.value(s);
                slope += chord.strength * self.kernel.slope(s) * along;
            }
            if excess >= 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - excess / slope;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            // An f32 holds no more; and between neighbouring floats there is nothing.
            if (next - t).abs() <= 1e-10 * t.abs() || next <= low || next >= high {
                return next;
            }
            t = next;
        }
    }
}
