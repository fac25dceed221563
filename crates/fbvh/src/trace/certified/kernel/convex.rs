//! Kernels that are convex in v, by chords and tangents.
//!
//! On a range of v from l to h a convex kernel is nowhere above its chord, and nowhere below its tangent in
//! the middle of the range: two straight lines, and v is a parabola along the ray, so the ball is enclosed by
//! two parabolas that differ by k″(h − l)²/8; at the interval's ends tangents at l and h are closer. Its slope along the ray is dk/dv, which is between those at l
//! and h, times dv/dt, a straight line. Where dv/dt is positive the lesser one bounds the product from below,
//! where it is negative the greater one: these two straight lines together are concave, so the line through
//! their ends is nowhere above.

use metaball_core::kernel::Profile;

use super::super::lanes::{Lanes, Mask, array_of};
use super::super::parabolas::UNIT;
use super::{Bounds, LaneKernel, Missed, Stretch};

/// The kernel of a profile.
#[derive(Debug, Clone, Copy)]
pub(super) struct Convex<P>(pub(super) P);

/// What rounding of a profile is worth in v, where it is not a part of the value.
const OWN_MARGIN: f32 = 16.0 * UNIT;

/// Ranges of v that are shorter have the slope at their end for that of their chord: between values so close
/// to each other it would be all rounding.
const SHORT: f32 = 1.0 / 1024.0;

impl<P: Profile> LaneKernel<3> for Convex<P> {
    const BOUNDS_SLOPES: bool = true;
    /// Sixteen units in the last place of 1 (see [`Profile`]), twice.
    const ROUNDINGS: usize = 64;

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
        let zero = Lanes::splat(0.0f64);
        let slope = self.0.slope(v);
        (self.0.value(v), v.zip(slope, |v, slope| if v > 0.0 { slope } else { 0.0 }) + zero)
    }

    /// Coefficients are right to 128u of what they are made of: profiles to 32u, and the chord's slope errs by
    /// 4u of the value at its end over its length, which is at most twice the way that it is followed.
    #[inline(always)]
    fn bounds(self, v: &Stretch, strength: Lanes<f32>, reaches: Mask) -> Bounds<3> {
        let (zero, one) = (Lanes::splat(0.0f32), Lanes::splat(1.0f32));
        let strength = reaches.select(strength, zero);
        let margin = v.margin.map(|margin| margin + OWN_MARGIN);
        let covers = margin.is_at_most(v.bottom());
        let low = (v.bottom() - margin).max(zero).min(one);
        let high = (v.top() + margin).min(one).max(low);
        let middle = (low + high) * 0.5;
        let profile = self.0;
        let (at_low, gentlest) = (profile.value(low), profile.slope(low));
        let (at_high, steepest) = (profile.value(high), profile.slope(high));
        let (at_middle, slope) = (profile.value(middle), profile.slope(middle));
        let width = high - low;
        let is_short = width.is_less(Lanes::splat(SHORT));
        let chord = is_short.select(steepest, (at_high - at_low) / width.max(Lanes::splat(SHORT)));
        // Beyond the rim the slope is 0.
        let gentlest = covers.select(gentlest, zero);
        let tangent = covers.select(slope * strength, zero);
        let touch = covers.select(at_middle * strength, zero) - tangent * (middle + margin);
        let ends = array_of(|end| {
            let at_end = v.v[2 * end] - margin;
            let from_high = at_high + steepest * (at_end - high);
            let from_low = at_low + gentlest * (at_end - low);
            from_high.max(from_low) * strength
        });
        let (chord, base) = (chord * strength, (at_low - chord * low + chord * margin) * strength);
        let most: [_; 3] = array_of(|k| base + chord * v.v[k].max(zero));
        let least: [_; 3] = array_of(|k| touch + tangent * v.v[k]);
        // With the margin, so that one that is no number is not lost.
        let reach = abs(v.v[0]).max(abs(v.v[1])).max(abs(v.v[2])) + one + margin;
        let rises: [_; 2] = array_of(|end| {
            let along = v.slopes[end] - v.slope_margin;
            zero.is_less(along).select(gentlest, steepest) * along * strength
        });
        let slopes = abs(v.slopes[0]).max(abs(v.slopes[1])) + v.slope_margin;
        Bounds {
            most: [most[0], most[1] * 2.0, most[2]],
            least: [least[0], least[1] * 2.0, least[2]],
            ends,
            error: zero,
            magnitude: (at_high + steepest * reach) * strength,
            rises: Mask::NONE,
            rise: rises,
            steepness: steepest * slopes * strength,
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
        let rounded = 4.0 * <Self as LaneKernel<3>>::ROUNDINGS as f32 * UNIT;
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
