//! A ray in f64, and the chord that one ball's support cuts from it.

use glam::DVec3;

use crate::{Metaball, Ray};

/// The points `origin + t * direction`, `start` ≤ t ≤ `end`.
pub(super) struct Line {
    pub(super) origin: DVec3,
    direction: DVec3,
    pub(super) start: f64,
    pub(super) end: f64,
}

impl Line {
    pub(super) fn new(ray: &Ray) -> Self {
        let direction = ray.direction.as_dvec3();
        Self {
            origin: ray.origin.as_dvec3(),
            direction: if direction.is_finite() { direction } else { DVec3::ZERO },
            start: ray.t_min.into(),
            end: ray.t_max.into(),
        }
    }

    pub(super) fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// Whether the line may enter the box. Errs towards yes by a few roundings.
    pub(super) fn meets(&self, min: DVec3, max: DVec3) -> bool {
        let (mut near, mut far) = (self.start, self.end);
        for axis in 0..3 {
            let direction = self.direction[axis];
            let (low, high) = (min[axis] - self.origin[axis], max[axis] - self.origin[axis]);
            if direction == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
            } else {
                let (a, b) = (low / direction, high / direction);
                near = near.max(a.min(b));
                far = far.min(a.max(b));
            }
        }
        near <= far * (1.0 + 8.0 * f64::EPSILON)
    }
}

/// One ball along a line: v = `steepness` · (`half`² − (t − middle)²).
pub(super) struct Chord {
    /// A t near the middle that f32 can hold: `origin + anchor * direction` is then exact to the
    /// rounding of the sum, and so is all that is measured from there.
    anchor: f64,
    /// The middle of the chord, the point nearest to the ball's centre, from the anchor.
    offset: f64,
    /// Half the length of the chord, in t.
    half: f64,
    /// |direction|²/R².
    steepness: f64,
    strength: f64,
}

impl Chord {
    /// `None` where the line misses the ball, or meets it only outside `start` ≤ t ≤ `end`.
    pub(super) fn new(line: &Line, ball: &Metaball) -> Option<Self> {
        let squared_length = line.direction.length_squared();
        let center = ball.center.as_dvec3();
        let middle = (center - line.origin).dot(line.direction) / squared_length;
        let anchor = f64::from(middle as f32);
        let relative = center - line.at(anchor);
        let offset = relative.dot(line.direction) / squared_length;
        let distance = (relative - offset * line.direction).length();

        let radius = f64::from(ball.radius);
        let half = ((radius - distance) * (radius + distance) / squared_length).sqrt();
        let chord = Self {
            anchor,
            offset,
            half,
            steepness: squared_length / (radius * radius),
            strength: f64::from(ball.strength),
        };
        // Comparisons with NaN are false: a line without direction has no chords.
        (half > 0.0 && chord.start() < line.end && chord.end() > line.start).then_some(chord)
    }

    pub(super) fn start(&self) -> f64 {
        self.anchor + (self.offset - self.half)
    }

    pub(super) fn end(&self) -> f64 {
        self.anchor + (self.offset + self.half)
    }

    /// Whether the ball takes away from the field.
    pub(super) fn is_negative(&self) -> bool {
        self.strength < 0.0
    }

    /// The ball in u = t − `origin`. The anchor and a nearby origin differ by an exact number.
    pub(super) fn relative_to(&self, origin: f64) -> Bump {
        Bump {
            middle: (self.anchor - origin) + self.offset,
            half: self.half,
            steepness: self.steepness,
            strength: self.strength,
        }
    }
}

/// One ball's part of the field along a segment, in u, the distance from the segment's start.
#[derive(Clone, Copy)]
pub(super) struct Bump {
    pub(super) middle: f64,
    half: f64,
    pub(super) steepness: f64,
    pub(super) strength: f64,
}

impl Bump {
    /// Whether it adds to the field, and does not take away from it.
    pub(super) fn adds(&self) -> bool {
        self.strength > 0.0
    }

    /// The point of \[a, b\] that is nearest to the middle of the chord.
    pub(super) fn nearest(&self, a: f64, b: f64) -> f64 {
        self.middle.max(a).min(b)
    }

    /// The end of \[a, b\] that is farther from it.
    pub(super) fn farthest(&self, a: f64, b: f64) -> f64 {
        if self.middle - a > b - self.middle { a } else { b }
    }

    /// v = 1 − r²/R², which is not negative on the chord.
    pub(super) fn depth(&self, u: f64) -> f64 {
        let x = u - self.middle;
        (self.steepness * (self.half - x) * (self.half + x)).max(0.0)
    }

    /// The polar form B of the depth's parabola, symmetric and affine in each argument, with B(u, u) =
    /// `depth(u)`: the depth's Bernstein coefficients on \[a, b\] are B(a, a), B(a, b), B(b, b). None is
    /// negative on the chord.
    pub(super) fn polar_form(&self, a: f64, b: f64) -> f64 {
        let (x, y) = (a - self.middle, b - self.middle);
        (self.steepness * (self.half * self.half - x * y)).max(0.0)
    }

    /// The depth in the middle of the chord, the greatest.
    pub(super) fn greatest_depth(&self) -> f64 {
        self.steepness * self.half * self.half
    }
}
