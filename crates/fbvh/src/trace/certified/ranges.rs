//! The search for a crossing in one leaf by exact ranges, in f64, for any kernel: slower than by
//! polynomials, and decides what they leave open.
//!
//! # Why no root can be skipped
//! Along a ray every ball's part of the field rises to the centre's projection m and falls behind it,
//! because its kernel falls with distance. So on an interval \[a, b\] of the ray it is nowhere more
//! than at the point of \[a, b\] nearest to m, and nowhere less than at the farther end. The sums of these
//! bound what balls add to the field and what negative ones take away from it, the differences of the two
//! sums bound the field, and where the upper one is below T there is no root. The bounds are exact in the limit of short intervals, and rest on no sampling and no assumption.
//!
//! The search goes through the leaf front to back. It skips intervals whose bound is below T and
//! halves the others, until the field is certainly above T at an interval's end and certainly rises
//! on all of it: then there is one root in it, the first. That the slope
//! Σ 2q·k′(v)·(m − t)/R² is positive is certain, too: each factor is bounded on the interval. For an
//! exit T − F takes the place of F − T.
//!
//! # Rounding
//! v = 1 − |p − x|²/R² is formed from p − o′, its projection and its distance from the ray; o′ is
//! where the ray enters the leaf. All are right to a few u·|p − o′|, u = 2⁻⁵³, and p − o′ to
//! 4u·|p − o| from the ray's origin o. So v is right to [`Chord::margin`] =
//! 32u(1 + |p − o′|/R)(1 + |p − o′|/R + |p − o|/R), which is added to v for upper bounds and taken
//! off for lower ones. Each term of the sums is then right to 16u of itself and the sum of n of them
//! to n·u more, of what is added and of what is taken away each for itself; terms of slopes, which have both signs, are lessened by as much each. A projection is
//! misplaced by no more than the margin of v times R.
//!
//! The shader does the same in f32, u = 2⁻²³, relative to a nearby origin
//! (`shaders/wgsl/fbvh/relative_ray.wgsl`, `shaders/wgsl/fbvh/projection.wgsl`), with a margin that shrinks with
//! r: projection and distance are misplaced by e = 6u·|p − o′| plus the misplacement of o′ itself, so r²
//! is by 2re + e²; squares, sums and division add 9u of r²/R², the last difference u. So the margin is
//! least for balls that the ray meets near their centres.

use glam::DVec3;
use metaball_core::{Kernel, Ray};

use super::query::{Crossing, Query};
use crate::Field;
use crate::trace::counter::Counter;

/// A ball that reaches the ray's interval in a leaf.
struct Chord {
    /// t of the centre's projection, from where the ray enters the leaf.
    middle: f64,
    /// Squared distance of the centre from the ray.
    off_axis_squared: f64,
    inverse_square: f64,
    strength: f64,
    radius: f64,
    /// How far rounding can move v.
    margin: f64,
}

/// What a search of a leaf found, with the ray's t.
pub(super) enum Found {
    /// No crossing in the leaf.
    Nothing,
    /// No crossing before the far end, but there the field is so close to T that it may have crossed
    /// it: what follows has to decide.
    UncertainEnd,
    /// The ray starts beyond the crossing.
    StartsBeyond,
    /// The first crossing.
    Root(f64),
    /// The field comes closer to T than rounding can resolve.
    Undecided(f64),
}

/// Bounds on an interval of what is to cross zero upwards: F − T for an entry, T − F for an exit.
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

/// Sums of what is nowhere more, and of what is nowhere less.
#[derive(Debug, Clone, Copy)]
struct Range {
    most: f64,
    least: f64,
}

impl Range {
    const NONE: Self = Self { most: 0.0, least: 0.0 };
}

/// Half a unit in the last place of 1.
pub(super) const UNIT: f64 = f64::EPSILON / 2.0;

/// An interval of this part of the smallest radius in it is short: a root in it is known to more
/// digits than an f32 holds.
const SHORT: f64 = 1.0 / (1u64 << 40) as f64;

/// The balls of a leaf along a ray; kept from leaf to leaf for its memory.
#[derive(Default)]
pub(super) struct Chords {
    chords: Vec<Chord>,
    /// Squared length of the ray's direction: unit to 1e-7 only, and f64 sees the difference.
    square: f64,
}

/// A search of the chords.
pub(super) struct RangeSearch<'a> {
    pub(super) chords: &'a Chords,
    pub(super) query: &'a Query,
}

impl Chords {
    /// Gathers the balls that reach the interval.
    pub(super) fn gather(
        &mut self,
        field: &impl Field,
        list: &[u32],
        ray: &Ray,
        (start, end): (f64, f64),
    ) {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let to_start = start * direction;
        self.square = direction.length_squared();
        self.chords.clear();
        for &ball in list {
            let support = field.support(ball as usize);
            let radius = f64::from(support.radius);
            let distance: DVec3 = support.center.as_dvec3() - origin;
            let offset = distance - to_start;
            let middle = offset.dot(direction) / self.square;
            let away = 1.0 + offset.length() / radius;
            let chord = Chord {
                middle,
                off_axis_squared: (offset - middle * direction).length_squared(),
                inverse_square: (radius * radius).recip(),
                strength: f64::from(field.strength(ball as usize)),
                radius,
                margin: 32.0 * UNIT * away * (away + distance.length() / radius),
            };
            if self.v(&chord, middle.clamp(0.0, end - start)) + chord.margin > 0.0 {
                self.chords.push(chord);
            }
        }
    }

    /// v = 1 − r²/R² of a ball at t.
    fn v(&self, chord: &Chord, t: f64) -> f64 {
        let along = t - chord.middle;
        1.0 - (chord.off_axis_squared + self.square * along * along) * chord.inverse_square
    }
}

impl RangeSearch<'_> {
    /// Where the field first crosses T on the ray's interval in the leaf, in the query's direction.
    /// `starts` is whether the ray starts with the interval.
    pub(super) fn first_root(
        &self,
        interval: (f64, f64),
        starts: bool,
        counter: &mut impl Counter,
    ) -> Found {
        let bounds = self.bounds(0.0, 0.0, counter);
        if bounds.end_least >= 0.0 {
            // Before a leaf that is not the first there was no crossing.
            return if starts { Found::StartsBeyond } else { Found::Root(interval.0) };
        }
        if starts && bounds.most >= 0.0 {
            return Found::Undecided(interval.0);
        }
        match self.search(interval.1 - interval.0, counter) {
            Found::Root(t) => Found::Root(interval.0 + t),
            Found::Undecided(t) => Found::Undecided(interval.0 + t),
            found => found,
        }
    }

    /// The search proper, over so much of the ray.
    fn search(&self, end: f64, counter: &mut impl Counter) -> Found {
        // Up to `low` there is no crossing, from there to `probe` the field nears T; the interval from
        // `probe` to `high` is examined.
        let (mut low, mut probe, mut high) = (0.0, 0.0, end);
        loop {
            let width = high - probe;
            let bounds = self.bounds(probe, high, counter);
            let rises = bounds.least_slope > 0.0;
            // What rises is greatest at its end.
            let is_below = bounds.most < 0.0
                || rises && bounds.end_least <= 0.0 && self.bounds(high, high, counter).most < 0.0;
            let is_short = width <= SHORT * bounds.radius;
            if bounds.end_least > 0.0 && (rises || is_short) {
                return Found::Root(self.close_in_on((low, high), counter));
            }
            if is_below || rises {
                // All below T; or rising so close to T that the next interval has to decide.
                if high >= end {
                    return if is_below { Found::Nothing } else { Found::UncertainEnd };
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
                return Found::Undecided(probe);
            }
            high = middle;
        }
    }

    fn bounds(&self, low: f64, high: f64, counter: &mut impl Counter) -> Bounds {
        counter.evaluation();
        let chords = self.chords;
        let slope_at = |v: f64| -self.query.kernel.slope(1.0 - v.clamp(0.0, 1.0));
        let value_at = |v: f64| self.query.kernel.value((1.0 - v).max(0.0));
        let [mut added, mut taken] = [Range::NONE; 2];
        let [mut end_added, mut end_taken] = [Range::NONE; 2];
        let mut slope = Range::NONE;
        let mut smallest = f64::INFINITY;
        let summing = (chords.chords.len() + 24) as f64 * UNIT;
        for chord in &chords.chords {
            let v_most = chords.v(chord, chord.middle.clamp(low, high)) + chord.margin;
            if v_most <= 0.0 {
                continue;
            }
            let (v_start, v_end) = (chords.v(chord, low), chords.v(chord, high));
            let v_least = v_start.min(v_end) - chord.margin;
            let q = chord.strength.abs();
            let is_negative = chord.strength < 0.0;
            let (sum, end) = if is_negative {
                (&mut taken, &mut end_taken)
            } else {
                (&mut added, &mut end_added)
            };
            sum.most += q * value_at(v_most);
            sum.least += q * value_at(v_least);
            end.most += q * value_at(v_end + chord.margin);
            end.least += q * value_at(v_end - chord.margin);
            // The slope is 2·q·k′/R² times the distance to the projection, which rounding may misplace.
            let factor = 2.0 * q * chord.inverse_square;
            let slopes = (slope_at(v_least).min(slope_at(v_most)), self.steepest(v_least, v_most));
            let misplaced = chord.margin * chord.radius;
            let rise = factor * least_product(slopes, chord.middle - high, misplaced, summing);
            let fall = factor * least_product(slopes, low - chord.middle, misplaced, summing);
            let (rise, fall) = if is_negative { (fall, rise) } else { (rise, fall) };
            slope.least += rise;
            slope.most -= fall;
            smallest = smallest.min(chord.radius);
        }
        let more = |sum: f64| sum * (1.0 + summing);
        let less = |sum: f64| sum * (1.0 - summing);
        let up = |added: f64, taken: f64| more(added) - less(taken) - self.query.threshold;
        let down = |added: f64, taken: f64| less(added) - more(taken) - self.query.threshold;
        match self.query.crossing {
            Crossing::Entry => Bounds {
                most: up(added.most, taken.least),
                least_slope: slope.least,
                end_least: down(end_added.least, end_taken.most),
                radius: smallest,
            },
            Crossing::Exit => Bounds {
                most: -down(added.least, taken.most),
                least_slope: -slope.most,
                end_least: -up(end_added.most, end_taken.least),
                radius: smallest,
            },
        }
    }

    /// The greatest derivative of the kernel by v between two values of v. It grows with v, except for
    /// Perlin's kernel, where it is greatest at ρ = 1/3.
    fn steepest(&self, least: f64, most: f64) -> f64 {
        const PERLINS: f64 = 8.0 / 9.0;
        match self.query.kernel {
            Kernel::Perlin if least > PERLINS => -self.query.kernel.slope(1.0 - least),
            Kernel::Perlin if most > PERLINS => 20.0 / 9.0,
            kernel => -kernel.slope(1.0 - most.min(1.0)),
        }
    }

    /// The only root between the ends: Newton's steps, kept between the ends.
    fn close_in_on(&self, (mut low, mut high): (f64, f64), counter: &mut impl Counter) -> f64 {
        let chords = self.chords;
        let mut t = 0.5 * (low + high);
        loop {
            counter.iteration();
            let (mut excess, mut slope) = (-self.query.threshold, 0.0);
            for chord in &chords.chords {
                let s = 1.0 - chords.v(chord, t);
                let along = 2.0 * chords.square * (t - chord.middle) * chord.inverse_square;
                excess += chord.strength * self.query.kernel.value(s);
                slope += chord.strength * self.query.kernel.slope(s) * along;
            }
            let beyond = match self.query.crossing {
                Crossing::Entry => excess >= 0.0,
                Crossing::Exit => excess <= 0.0,
            };
            if beyond {
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

/// A lower bound of a kernel's derivative, between these two, times the distance to a projection that
/// may be misplaced, in a sum that errs by the part `summing` of its terms. What a ball falls within the
/// misplaced part of the distance is the square of that, and within the margin of v.
fn least_product(
    (gentlest, steepest): (f64, f64),
    distance: f64,
    misplaced: f64,
    summing: f64,
) -> f64 {
    if distance >= 0.0 {
        gentlest * (1.0 - summing) * (distance - misplaced).max(0.0)
    } else {
        steepest * (1.0 + summing) * (distance - misplaced)
    }
}
