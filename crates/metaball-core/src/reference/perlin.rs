//! The field of Perlin's kernel on a piece of a segment, by bounds of its second derivative.

use super::{
    chord::Bump,
    interval::Interval,
    piece::{Piece, Trend},
};

/// A piece \[from, to\] of a segment with values and slopes at the ends and bounds of the second
/// derivative in between. Works because the kernel is twice continuously differentiable along any
/// ray, at its rim and through its centre too.
pub(super) struct Perlin<'a> {
    segment: &'a Interval<'a>,
    from: End,
    to: End,
    /// Least and greatest second derivative by u.
    curvature: (f64, f64),
}

#[derive(Clone, Copy)]
struct End {
    u: f64,
    value: f64,
    slope: f64,
}

impl<'a> Perlin<'a> {
    /// The field on the whole segment.
    pub(super) fn new(segment: &'a Interval<'a>) -> Self {
        Self::between(segment, End::new(segment, 0.0), End::new(segment, segment.length))
    }

    fn between(segment: &'a Interval<'a>, from: End, to: End) -> Self {
        let curvature = segment.bumps().fold((0.0, 0.0), |(low, high), bump| {
            let (least, greatest) = curvature(&bump, from.u, to.u);
            (low + bump.strength * least, high + bump.strength * greatest)
        });
        Self { segment, from, to, curvature }
    }

    fn width(&self) -> f64 {
        self.to.u - self.from.u
    }
}

impl End {
    fn new(segment: &Interval<'_>, u: f64) -> Self {
        let (value, slope) = segment.field(u);
        Self { u, value, slope }
    }
}

/// Bounds of the kernel's second derivative by u on \[a, b\].
///
/// With ρ = r/R and δ the least ρ along the ray, k = 1 − 10ρ³ + 15ρ⁴ − 6ρ⁵ has
/// k″ = −30·steepness·(1 − ρ)·(2ρ − 4ρ² + 3δ² − δ²/ρ); each term is monotonic in ρ.
fn curvature(bump: &Bump, a: f64, b: f64) -> (f64, f64) {
    let ratio = |u| (1.0 - bump.depth(u)).max(0.0).sqrt();
    let nearest_squared = (1.0 - bump.greatest_depth()).max(0.0);
    let (at_a, at_b) = (ratio(a), ratio(b));
    let high = at_a.max(at_b);
    let low =
        if bump.middle > a && bump.middle < b { nearest_squared.sqrt() } else { at_a.min(at_b) };

    // δ²/ρ never exceeds δ ≤ ρ, so it vanishes with ρ.
    let share = |ratio: f64| if ratio > 0.0 { nearest_squared / ratio } else { 0.0 };
    let least = 2.0 * low - 4.0 * high * high + 3.0 * nearest_squared - share(low);
    let greatest = 2.0 * high - 4.0 * low * low + 3.0 * nearest_squared - share(high);
    // The factor 1 − ρ lies between `thin` and `thick`; which of them bounds depends on the sign.
    let (thin, thick) = (1.0 - high, 1.0 - low);
    let least = (least * thin).min(least * thick);
    let greatest = (greatest * thin).max(greatest * thick);
    (-30.0 * bump.steepness * greatest, -30.0 * bump.steepness * least)
}

impl Piece for Perlin<'_> {
    fn span(&self) -> (f64, f64) {
        (self.from.u, self.to.u)
    }

    fn ends(&self) -> (f64, f64) {
        (self.from.value, self.to.value)
    }

    /// Between two values of a function lies its chord, give or take width²/8 of its second
    /// derivative; on long pieces the sum of the balls' ranges is closer.
    fn range(&self) -> (f64, f64) {
        let sag = self.width() * self.width() / 8.0;
        let (low, high) = self.segment.range(self.from.u, self.to.u);
        (
            low.max(self.from.value.min(self.to.value) - sag * self.curvature.1.max(0.0)),
            high.min(self.from.value.max(self.to.value) + sag * (-self.curvature.0).max(0.0)),
        )
    }

    fn trend(&self) -> Option<Trend> {
        let fall = self.width() * self.curvature.0.min(0.0);
        let rise = self.width() * self.curvature.1.max(0.0);
        if self.from.slope + fall >= 0.0 || self.to.slope - rise >= 0.0 {
            Some(Trend::Rising)
        } else if self.from.slope + rise <= 0.0 || self.to.slope - fall <= 0.0 {
            Some(Trend::Falling)
        } else {
            None
        }
    }

    fn split_at(&self, middle: f64) -> [Self; 2] {
        let middle = End::new(self.segment, middle);
        [
            Self::between(self.segment, self.from, middle),
            Self::between(self.segment, middle, self.to),
        ]
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::{
        Kernel, Metaball, Ray,
        reference::chord::{Chord, Line},
    };

    proptest! {
        /// The slope is right to some 1e-15, so its differences over a step of 1e-5 are right to
        /// 1e-10, and by the mean value theorem each is a second derivative on the step.
        #[test]
        fn curvature_is_enclosed(
            side in 0.0f32..0.99, from in 0.0f64..1.0, to in 0.0f64..1.0, share in 0.0f64..1.0,
        ) {
            let line = Line::new(&Ray::new(Vec3::new(side, 0.0, -2.0), Vec3::Z));
            let ball = Metaball::new(Vec3::ZERO, 1.0);
            let chord = Chord::new(&line, &ball).expect("the line meets the ball");
            let segment = Interval::of(&chord, Kernel::Perlin);
            let length = segment.length;

            let (a, b) = (length * from.min(to), length * from.max(to));
            let step = 1e-5 * length;
            prop_assume!(b - a > 2.0 * step);
            let u = a + share * (b - a - step);
            let difference = (segment.field(u + step).1 - segment.field(u).1) / step;
            let (least, greatest) = curvature(&chord.relative_to(segment.start), a, b);
            prop_assert!(least - 1e-9 <= difference && difference <= greatest + 1e-9);
        }
    }
}
