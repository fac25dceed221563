//! Bounds of a ball's second derivative along a ray.

use super::chord::Bump;
use crate::Kernel;
use crate::kernel::{AnyProfile, Profile};

/// Bounds of the kernel's second derivative by u on \[a, b\], in which the ball's chord covers both.
pub(super) fn curvature(kernel: Kernel, bump: &Bump, a: f64, b: f64) -> (f64, f64) {
    let ratio = |u| (1.0 - bump.depth(u)).max(0.0);
    let nearest = (1.0 - bump.greatest_depth()).max(0.0);
    let (at_a, at_b) = (ratio(a), ratio(b));
    let low = if bump.middle > a && bump.middle < b { nearest } else { at_a.min(at_b) };
    let along = Along { nearest, low, high: at_a.max(at_b) };
    let (least, greatest) =
        kernel.profile().map_or_else(|| along.of_perlin(), |profile| along.of(profile));
    (bump.steepness * least, bump.steepness * greatest)
}

/// Where a part of a ray is in a support of radius 1: squared distances from the centre.
struct Along {
    /// Nowhere less along the whole ray.
    nearest: f64,
    /// On the part.
    low: f64,
    high: f64,
}

impl Along {
    /// With ρ = r/R and δ the least ρ along the ray, k = 1 − 10ρ³ + 15ρ⁴ − 6ρ⁵ has
    /// k″ = −30(1 − ρ)(2ρ − 4ρ² + 3δ² − δ²/ρ); each term is monotonic in ρ.
    fn of_perlin(&self) -> (f64, f64) {
        let (low, high, nearest_squared) = (self.low.sqrt(), self.high.sqrt(), self.nearest);
        // δ²/ρ never exceeds δ ≤ ρ, so it vanishes with ρ.
        let share = |ratio: f64| if ratio > 0.0 { nearest_squared / ratio } else { 0.0 };
        let least = 2.0 * low - 4.0 * high * high + 3.0 * nearest_squared - share(low);
        let greatest = 2.0 * high - 4.0 * low * low + 3.0 * nearest_squared - share(high);
        // The factor 1 − ρ lies between `thin` and `thick`; which of them bounds depends on the sign.
        let (thin, thick) = (1.0 - high, 1.0 - low);
        let least = (least * thin).min(least * thick);
        let greatest = (greatest * thin).max(greatest * thick);
        (-30.0 * greatest, -30.0 * least)
    }

    /// With s = ρ² and δ² the least s along the ray, k″ = 4(1 − δ²/s)·s·d²k/dv² − 2dk/dv: the first factor
    /// rises with s, the second one to its peak, and the slope falls.
    fn of(&self, profile: AnyProfile) -> (f64, f64) {
        let away = |s: f64| if s > self.nearest { 1.0 - self.nearest / s } else { 0.0 };
        let bent = |s: f64| if s > 0.0 { s * profile.bend(1.0 - s) } else { 0.0 };
        let (at_low, at_high) = (bent(self.low), bent(self.high));
        let (peak, at) = profile.peak();
        let is_within = (self.low..=self.high).contains(&(1.0 - at));
        let most = if is_within { peak * 1.000_01 } else { at_low.max(at_high) };
        let (gentlest, steepest) = (profile.slope(1.0 - self.high), profile.slope(1.0 - self.low));
        (
            4.0 * away(self.low) * at_low.min(at_high) - 2.0 * steepest,
            4.0 * away(self.high) * most - 2.0 * gentlest,
        )
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::{
        Metaball, Ray,
        reference::{
            chord::{Chord, Line},
            interval::Interval,
        },
    };

    fn curved() -> impl Iterator<Item = Kernel> {
        Kernel::all().filter(|kernel| kernel.coefficients().is_none())
    }

    proptest! {
        /// The slope is right to some 1e-15, so its differences over a step of 1e-5 are right to
        /// 1e-10, and by the mean value theorem each is a second derivative on the step.
        #[test]
        fn curvature_is_enclosed(
            kernel in proptest::sample::select(curved().collect::<Vec<_>>()),
            side in 0.0f32..0.99, from in 0.0f64..1.0, to in 0.0f64..1.0, share in 0.0f64..1.0,
        ) {
            let line = Line::new(&Ray::new(Vec3::new(side, 0.0, -2.0), Vec3::Z));
            let ball = Metaball::new(Vec3::ZERO, 1.0);
            let chord = Chord::new(&line, &ball).expect("the line meets the ball");
            let segment = Interval::of(&chord, kernel);
            let length = segment.length;

            let (a, b) = (length * from.min(to), length * from.max(to));
            let step = 1e-5 * length;
            prop_assume!(b - a > 2.0 * step);
            let u = a + share * (b - a - step);
            let difference = (segment.field(u + step).1 - segment.field(u).1) / step;
            let (least, greatest) = curvature(kernel, &chord.relative_to(segment.start), a, b);
            prop_assert!(least - 1e-9 <= difference && difference <= greatest + 1e-9);
        }
    }
}
