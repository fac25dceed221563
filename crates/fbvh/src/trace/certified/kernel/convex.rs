//! Kernels that are convex in v, with a second derivative that rises with v, by parabolas in v.
//!
//! On a range of v from l to h such a kernel is nowhere above the parabola with its values at l and h and
//! its slope at l, and nowhere below the one with its slope at h instead: what either misses is k‴/6 times
//! (v − l)²(v − h) or (v − l)(v − h)². v is a parabola along the ray, so both are polynomials of degree four
//! along it. The upper one is a sum of terms that are not negative, and rises with v, so v may be raised to 0.
//!
//! The slope along the ray is dk/dv, which is between those at l and h, times dv/dt, a straight line. Where
//! dv/dt is positive the lesser one bounds the product from below, where it is negative the greater one: these
//! two straight lines together are concave, so the line through their ends is nowhere above.

use metaball_core::kernel::{AnyProfile, Profile};

use super::super::lanes::{Lanes, Mask, array_of};
use super::super::parabolas::UNIT;
use super::{Bounds, LaneKernel, Missed, Stretch};

/// The kernel of a profile.
#[derive(Debug, Clone, Copy)]
pub(super) struct Convex(pub(super) AnyProfile);

/// What rounding of a profile is worth in v, where it is not a part of the value.
const OWN_MARGIN: f32 = 16.0 * UNIT;

/// Ranges of v that are shorter have lines for parabolas, with the slope at h: differences of values so close to
/// each other would be all rounding.
const SHORT: f32 = 1.0 / 1024.0;

impl LaneKernel<5> for Convex {
    const BOUNDS_SLOPES: bool = true;
    /// Sixteen units in the last place of 1 in each value and slope (see [`Profile`]), of which differences are
    /// taken twice.
    const ROUNDINGS: usize = 192;

    #[inline(always)]
    fn value(self, v: Lanes<f32>) -> Lanes<f32> {
        self.0.value(v)
    }

    #[inline(always)]
    fn slope(self, v: Lanes<f32>) -> Lanes<f32> {
        self.0.slope(v)
    }

    #[inline(always)]
    fn value_and_slope(self, v: Lanes<f64>) -> (Lanes<f64>, Lanes<f64>) {
        let (value, slope) = self.0.value_and_slope(v);
        (value, v.zip(slope, |v, slope| if v > 0.0 { slope } else { 0.0 }))
    }

    /// Values and slopes are right to 32u, and their differences to as much of what they are of. These are taken
    /// over the range's length, and followed for no more than that, but for a vertex of v between its ends, where
    /// the polar form reaches beyond h by the range's length at most.
    #[inline(always)]
    fn bounds(self, v: &Stretch, strength: Lanes<f32>, reaches: Mask) -> Bounds<5> {
        let (zero, one) = (Lanes::splat(0.0f32), Lanes::splat(1.0f32));
        let strength = reaches.select(strength, zero);
        let margin = v.margin.map(|margin| margin + OWN_MARGIN);
        let covers = margin.is_at_most(v.bottom());
        let low = (v.bottom() - margin).max(zero).min(one);
        let high = (v.greatest() + margin).min(one).max(low);
        let profile = self.0;
        let (at_low, gentlest) = profile.value_and_slope(low);
        let (at_high, steepest) = profile.value_and_slope(high);
        let (at_low, gentlest) = (at_low * strength, gentlest * strength);
        let (at_high, steepest) = (at_high * strength, steepest * strength);
        let width = high - low;
        let inverse = width.max(Lanes::splat(SHORT)).map(f32::recip);
        let is_short = width.is_less(Lanes::splat(SHORT));
        let chord = (at_high - at_low) * inverse;
        let bend_low = is_short.select(zero, ((chord - gentlest) * inverse).max(zero));
        let bend_high = is_short.select(zero, ((steepest - chord) * inverse).max(zero));
        let slope_low = is_short.select(steepest, gentlest);

        let above: [_; 3] = array_of(|k| v.v[k].max(zero) + margin - low);
        let most = quadratic(at_low, slope_low, bend_low, &above);
        let below: [_; 3] = array_of(|k| v.v[k] - high);
        let base = at_high - steepest * margin;
        let mut least = quadratic(base, steepest, bend_high, &below);
        for least in &mut least {
            *least = covers.select(*least, zero);
        }
        let ends = array_of(|end| {
            let tangent = base + steepest * below[2 * end];
            covers.select(least[4 * end], tangent.max(zero))
        });
        let start = profile.value((v.v[0] + margin).max(zero).min(one)) * strength;
        let gentlest = covers.select(gentlest, zero);
        let rise = array_of(|end| {
            let along = v.slopes[end] - v.slope_margin;
            zero.is_less(along).select(gentlest, steepest) * along
        });
        let slopes = abs(v.slopes[0]).max(abs(v.slopes[1])) + v.slope_margin;
        Bounds {
            most,
            least,
            start,
            ends,
            // The margin is in all of it; no number where that is none.
            error: margin * 0.0,
            magnitude: at_high + steepest * (width + margin) * 8.0,
            rises: Mask::NONE,
            rise,
            steepness: steepest * slopes,
        }
    }

    /// A convex function is made of v₊ moved to where its slope rises, by as much, and one whose second
    /// derivative rises of v₊² halved; quadratics through nodes are linear in what they meet, so the errors add
    /// up. A kink at the rim counts by itself.
    #[inline(always)]
    fn quadratic_errors(self, low: Lanes<f32>, high: Lanes<f32>) -> (Lanes<f32>, Lanes<f32>) {
        let zero = Lanes::splat(0.0f32);
        let Missed { kink, bent, curved, .. } = Missed::on(low, high);
        let profile = self.0;
        let rim = profile.slope(zero);
        let (first, last) = (low.max(zero), high.max(zero).min(Lanes::splat(1.0)));
        let is_inside = zero.is_less(low);
        // Differences of rounded numbers.
        let rounded = 4.0 * <Self as LaneKernel<5>>::ROUNDINGS as f32 * UNIT;
        let (gentlest, steepest) = (profile.slope(first), profile.slope(last));
        let slope = steepest * (1.0 + rounded) - gentlest;
        let bend =
            profile.bend(last) * (1.0 + rounded) - is_inside.select(profile.bend(first), zero);
        let jumps = is_inside.select(zero, rim);
        // An infinite second derivative leaves it to the slopes.
        let error = |kink: Lanes<f32>, bent: Lanes<f32>, curved: Lanes<f32>| {
            kink * jumps + (curved * bend).min(bent * slope)
        };
        (error(kink.0, bent.0, curved.0), error(kink.1, bent.1, curved.1))
    }

    #[inline(always)]
    fn has_kink(self) -> bool {
        self.0.slope(0.0f64) > 0.0
    }
}

#[inline(always)]
fn abs(lanes: Lanes<f32>) -> Lanes<f32> {
    lanes.map(f32::abs)
}

/// Bernstein coefficients, times their binomials, of `value` + `slope`·x + `bend`·x² where x is a parabola
/// with these.
#[inline(always)]
fn quadratic(
    value: Lanes<f32>,
    slope: Lanes<f32>,
    bend: Lanes<f32>,
    [first, middle, last]: &[Lanes<f32>; 3],
) -> [Lanes<f32>; 5] {
    let (first, middle, last) = (*first, *middle, *last);
    let (inner, outer) = (middle + first, middle + last);
    let (by_first, by_last) = (slope + bend * first, slope + bend * last);
    [
        value + first * by_first,
        value * 4.0 + (slope * inner + bend * first * middle * 2.0) * 2.0,
        value * 6.0
            + slope * (first + last + middle * 4.0)
            + bend * (first * last * 2.0 + middle * middle * 4.0),
        value * 4.0 + (slope * outer + bend * last * middle * 2.0) * 2.0,
        value + last * by_last,
    ]
}
