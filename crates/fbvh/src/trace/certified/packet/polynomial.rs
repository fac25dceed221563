//! A leaf's polynomial along the rays of a packet.
//!
//! P is evaluated at five points of a ray's interval, which gives its Bernstein coefficients there; parts
//! of the interval are cut out of these.

use super::super::bernstein::{right_of, value_and_rise};
use super::super::lanes::{Lanes, Mask, array_of};
use super::super::leaf_polynomial::{ENLARGED, LeafPolynomial};
use super::super::parabolas::UNIT;
use super::balls::RelativePacket;
use super::enclosure::{Encloses, Enclosure};
use super::rays::{ExactPacket, Packet};
use super::root::Isolated;

/// Coefficients of a polynomial of degree 4.
const COUNT: usize = 5;

/// P along the rays, lane by lane.
pub(super) struct AlongRays {
    /// Bernstein coefficients between −`half` and `half`.
    coefficients: [Lanes<f32>; COUNT],
    half: Lanes<f32>,
    inverse: Lanes<f32>,
    /// |F − T − P| is nowhere more, with all rounding.
    error: Lanes<f32>,
    /// The differences of coefficients on an interval of the length 1 that a slope must exceed to be one of
    /// F, and what rounding adds.
    slope_error: Lanes<f32>,
    rounding: Lanes<f32>,
    is_known: Mask,
}

/// The Bernstein coefficients from the values at 0, ¼, ½, ¾ and 1. The sums of the absolute values of a
/// row are at most 274/18 < 16.
const FROM_VALUES: [[f32; COUNT]; COUNT] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [-13.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -0.25],
    [13.0 / 18.0, -32.0 / 9.0, 20.0 / 3.0, -32.0 / 9.0, 13.0 / 18.0],
    [-0.25, 4.0 / 3.0, -3.0, 4.0, -13.0 / 12.0],
    [0.0, 0.0, 0.0, 0.0, 1.0],
];

impl AlongRays {
    /// # Rounding
    /// Horner's scheme is right to 24u of the sum of the coefficients, and 16 times that, and as much
    /// again, is what the coefficients here are right to. Points are misplaced by 8u of `reach`, which P
    /// turns into as much of `steepness`.
    #[inline(always)]
    pub(super) fn new(
        polynomial: &LeafPolynomial,
        packet: &Packet,
        exact: &ExactPacket,
        relative: &RelativePacket,
    ) -> Self {
        let zero = Lanes::splat(0.0f32);
        let half = relative.half;
        let middle: [_; 3] =
            array_of(|axis| relative.origin[axis].map(|x| x as f32) * polynomial.scale[axis]);
        let step: [_; 3] = array_of(|axis| packet.direction[axis] * half * polynomial.scale[axis]);
        let values: [_; COUNT] = array_of(|k| {
            let x = 0.5 * k as f32 - 1.0;
            polynomial.value(&array_of(|axis| middle[axis] + step[axis] * x))
        });
        let coefficients = array_of(|k| {
            (1..COUNT)
                .fold(values[0] * FROM_VALUES[k][0], |sum, n| sum + values[n] * FROM_VALUES[k][n])
        });
        let misplaced = relative.reach * (8.0 * UNIT);
        let rounding = misplaced.map(|misplaced| {
            1024.0 * UNIT * polynomial.magnitude + 16.0 * misplaced * polynomial.steepness
        });
        let slope_error = (0..3).fold(exact.length * polynomial.steepness_error, |sum, axis| {
            sum + packet.direction[axis].map(f32::abs) * polynomial.slope_errors[axis]
        });
        let error = rounding.map(|rounding| (rounding + polynomial.error) * 1.0001);
        // A ray's interval ends outside of the leaf by no more than it is rounded.
        let scale = polynomial.scale.into_iter().fold(0.0, f32::max);
        let is_known = (misplaced * scale).is_less(Lanes::splat(0.25 * ENLARGED))
            & error.is_less(Lanes::splat(f32::MAX));
        Self {
            coefficients,
            half,
            inverse: half.map(|half| 0.5 / half),
            error,
            slope_error: slope_error.max(zero) * 0.250_1,
            rounding,
            is_known,
        }
    }
}

impl AlongRays {
    /// Guesses at the roots that are isolated: where P is 0.
    #[inline(always)]
    pub(super) fn approach(&self, isolated: &Isolated) -> Lanes<f32> {
        const STEPS: usize = 3;
        let mut t = isolated.guess;
        for _ in 0..STEPS {
            let x = (t + self.half) * self.inverse;
            let (value, rise) = value_and_rise(self.coefficients, x);
            let slope = rise * (COUNT - 1) as f32 * self.inverse;
            let step = value.zip(slope, |value, slope| value / slope);
            t = (t - step).min(isolated.end).max(isolated.start);
        }
        t
    }
}

impl Encloses<COUNT> for AlongRays {
    #[inline(always)]
    fn enclosure(&self, start: Lanes<f32>, end: Lanes<f32>) -> Enclosure<COUNT> {
        let (zero, one) = (Lanes::splat(0.0f32), Lanes::splat(1.0f32));
        let mut part = self.coefficients;
        let low = ((start + self.half) * self.inverse).max(zero).min(one);
        right_of(&mut part, low);
        // The rest, seen from its end.
        let rest = end - start;
        let from_end = ((self.half - end) * (self.half - start).map(f32::recip)).max(zero).min(one);
        part.reverse();
        right_of(&mut part, from_end);
        part.reverse();
        let least = rest * self.slope_error + self.rounding * 2.0;
        let increases =
            (1..COUNT).fold(!Mask::NONE, |all, k| all & least.is_less(part[k] - part[k - 1]));
        let lower: [_; COUNT] = array_of(|k| part[k] - self.error);
        let upper: [_; COUNT] = array_of(|k| part[k] + self.error);
        Enclosure {
            upper,
            lower,
            start: upper[0],
            ends: [lower[0], lower[COUNT - 1]],
            increases,
            is_exact: Mask::NONE,
            is_known: self.is_known,
        }
    }
}
