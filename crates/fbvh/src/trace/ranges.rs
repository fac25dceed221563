//! The search for a crossing in one leaf by exact ranges, in f64, for any kernel: slower than
//! [`super::polynomial`], and decides what that leaves open.
//!
//! # Why no root can be skipped
//! Along a ray every ball's part of the field rises to the centre's projection m and falls behind it,
//! because its kernel falls with distance. So on an interval \[a, b\] of the ray it is nowhere more
//! than at the point of \[a, b\] nearest to m, and nowhere less than at the farther end. With positive
//! strengths the sums of these bound the field, and where the upper one is below T there is no root.
//! The bounds are exact in the limit of short intervals; no sampling and no assumption is behind them.
//!
//! The search goes through the leaf front to back. It passes by intervals whose bound is below T and
//! halves the others, until the field is certainly above T at an interval's end and certainly rises
//! on all of it: then there is one root in it, the first. That the slope
//! Σ 2q·k′(v)·(m − t)/R² is positive is certain, too: each factor is bounded on the interval. On the
//! way out the same is asked of T − F in the place of F − T.
//!
//! # Rounding
//! v = 1 − |p − x|²/R² is formed from p − o′, its projection and its distance from the ray; o′ is
//! where the ray enters the leaf. All are right to a few u·|p − o′|, u = 2⁻⁵³, and p − o′ to
//! 4u·|p − o| from the ray's origin o. So v is to [`Chord::margin`] =
//! 32u(1 + |p − o′|/R)(1 + |p − o′|/R + |p − o|/R), which is added to v for upper bounds and taken
//! off for lower ones. Each term of the sums is then right to 16u of itself and the sum of n of them
//! to n·u more; terms of slopes, which have both signs, are lessened by as much each. A projection is
//! misplaced by no more than the margin of v times R. The shader does the same in f32 from an origin
//! beside the leaf (`fbvh/relative_ray.wgsl`, `fbvh/projection.wgsl`), with u = 2⁻²³ and what is left of it
//! where r is less than R: projection and distance are misplaced by e = 6u·|p − o′| and what o′
//! itself is, so r² is by 2re + e²; squares, sums and division add 9u of r²/R², the last difference
//! u. So balls that are seen near their centres, and short intervals, have the digits that they
//! deserve.

use glam::DVec3;
use metaball_core::{Kernel, Ray};

use super::{Counter, Crossing};
use crate::Field;

/// A ball that reaches the ray's stretch in a leaf.
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

/// What a search of a leaf has come to, with the ray's t.
pub(super) enum Found {
    /// No crossing in the leaf.
    Nothing,
    /// The same, but so close to T at the far side that what comes next must tell.
    Doubt,
    /// The ray starts beyond the crossing.
    Start,
    /// The first crossing.
    Root(f64),
    /// The field comes closer to T than rounding can tell apart.
    TooClose(f64),
}

/// What is certain on an interval of what is to cross zero upwards: F − T on the way in, T − F on
/// the way out.
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
pub(super) const UNIT: f64 = f64::EPSILON / 2.0;

/// An interval of this part of the smallest radius in it is short: a root there is known to more
/// than an f32 holds.
const SHORT: f64 = 1.0 / (1u64 << 40) as f64;

/// The balls of a leaf as a ray sees them; kept from leaf to leaf for its memory.
#[derive(Default)]
pub(super) struct Chords {
    chords: Vec<Chord>,
    /// Squared length of the ray's direction: unit to 1e-7 only, and f64 sees the difference.
    square: f64,
}

/// A search of the chords.
pub(super) struct Search<'a> {
    pub(super) chords: &'a Chords,
    pub(super) kernel: Kernel,
    pub(super) threshold: f64,
    pub(super) crossing: Crossing,
}

impl Chords {
    /// Takes up the balls that reach the stretch.
    pub(super) fn gather(
        &mut self,
        field: &impl Field,
        list: &[u32],
        ray: &Ray,
        (start, end): (f64, f64),
    ) {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let way = start * direction;
        self.square = direction.length_squared();
        self.chords.clear();
        for &ball in list {
            let support = field.support(ball as usize);
            let radius = f64::from(support.radius);
            let distance: DVec3 = support.center.as_dvec3() - origin;
            let offset = distance - way;
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

impl Search<'_> {
    /// Where the field first crosses T on the stretch, in the direction that is searched for.
    pub(super) fn first_root(&self, stretch: (f64, f64), counter: &mut impl Counter) -> Found {
        let bounds = self.bounds(0.0, 0.0, counter);
        if bounds.end_least >= 0.0 {
            // Up to a leaf that is not the first, there was none.
            return if stretch.0 <= 0.0 { Found::Start } else { Found::Root(stretch.0) };
        }
        if stretch.0 <= 0.0 && bounds.most >= 0.0 {
            return Found::TooClose(0.0);
        }
        match self.search(stretch.1 - stretch.0, counter) {
            Found::Root(t) => Found::Root(stretch.0 + t),
            Found::TooClose(t) => Found::TooClose(stretch.0 + t),
            found => found,
        }
    }

    /// The search proper, over so much of the ray.
    fn search(&self, end: f64, counter: &mut impl Counter) -> Found {
        // Up to `low` there is no crossing, from there to `probe` the field nears T; the interval from
        // `probe` to `high` is looked at.
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
        let chords = self.chords;
        let slope_at = |v: f64| -self.kernel.slope(1.0 - v.clamp(0.0, 1.0));
        let value_at = |v: f64| self.kernel.value((1.0 - v).max(0.0));
        let (mut most, mut least) = (0.0, 0.0);
        let (mut end_most, mut end_least) = (0.0, 0.0);
        let (mut most_slope, mut least_slope) = (0.0, 0.0);
        let mut smallest = f64::INFINITY;
        let summing = (chords.chords.len() + 24) as f64 * UNIT;
        for chord in &chords.chords {
            let v_most = chords.v(chord, chord.middle.clamp(low, high)) + chord.margin;
            if v_most <= 0.0 {
                continue;
            }
            let (v_start, v_end) = (chords.v(chord, low), chords.v(chord, high));
            let q = chord.strength;
            most += q * value_at(v_most);
            let v_least = v_start.min(v_end) - chord.margin;
            least += q * value_at(v_least);
            end_most += q * value_at(v_end + chord.margin);
            end_least += q * value_at(v_end - chord.margin);
            // The slope is 2·q·k′/R² times the way to the projection, which rounding may misplace.
            let factor = 2.0 * q * chord.inverse_square;
            let slopes = (slope_at(v_least).min(slope_at(v_most)), self.steepest(v_least, v_most));
            let misplaced = chord.margin * chord.radius;
            least_slope += factor * least_product(slopes, chord.middle - high, misplaced, summing);
            most_slope -= factor * least_product(slopes, low - chord.middle, misplaced, summing);
            smallest = smallest.min(chord.radius);
        }
        let up = |sum: f64| sum * (1.0 + summing) - self.threshold;
        let down = |sum: f64| sum * (1.0 - summing) - self.threshold;
        match self.crossing {
            Crossing::In => {
                Bounds { most: up(most), least_slope, end_least: down(end_least), radius: smallest }
            }
            Crossing::Out => Bounds {
                most: -down(least),
                least_slope: -most_slope,
                end_least: -up(end_most),
                radius: smallest,
            },
        }
    }

    /// The greatest derivative of the kernel by v between two of its values. It grows with v, but
    /// for Perlin's kernel, where it is greatest at ρ = 1/3.
    fn steepest(&self, least: f64, most: f64) -> f64 {
        const PERLINS: f64 = 8.0 / 9.0;
        match self.kernel {
            Kernel::Perlin if least > PERLINS => -self.kernel.slope(1.0 - least),
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
            let (mut excess, mut slope) = (-self.threshold, 0.0);
            for chord in &chords.chords {
                let s = 1.0 - chords.v(chord, t);
                let along = 2.0 * chords.square * (t - chord.middle) * chord.inverse_square;
                excess += chord.strength * self.kernel.value(s);
                slope += chord.strength * self.kernel.slope(s) * along;
            }
            let beyond = match self.crossing {
                Crossing::In => excess >= 0.0,
                Crossing::Out => excess <= 0.0,
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

/// The least that a kernel's derivative, between these two, may come to times a way that may be misplaced,
/// when a sum errs by such a part of its terms. What a ball falls within the misplaced part of its way is
/// the square of that, and within the margin of v.
fn least_product((gentlest, steepest): (f64, f64), way: f64, misplaced: f64, summing: f64) -> f64 {
    if way >= 0.0 {
        gentlest * (1.0 - summing) * (way - misplaced).max(0.0)
    } else {
        steepest * (1.0 + summing) * (way - misplaced)
    }
}
