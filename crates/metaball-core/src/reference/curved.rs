//! The field of a kernel that is no polynomial along a ray, on a piece of a segment, by bounds of its second
//! derivative.

use super::{
    curvature::curvature,
    interval::Interval,
    piece::{Piece, Trend},
};

/// A piece \[from, to\] of a segment with values and slopes at the ends and bounds of the second
/// derivative in between. Works because the kernel is twice continuously differentiable along any
/// ray inside of its support, through its centre too.
pub(super) struct Curved<'a> {
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

impl<'a> Curved<'a> {
    /// The field on the whole segment.
    pub(super) fn new(segment: &'a Interval<'a>) -> Self {
        Self::between(segment, End::new(segment, 0.0), End::new(segment, segment.length))
    }

    fn between(segment: &'a Interval<'a>, from: End, to: End) -> Self {
        let curvature = segment.bumps().fold((0.0, 0.0), |(low, high), bump| {
            let (least, greatest) = curvature(segment.kernel, &bump, from.u, to.u);
            let (least, greatest) = if bump.adds() { (least, greatest) } else { (greatest, least) };
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

impl Piece for Curved<'_> {
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
