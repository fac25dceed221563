//! The field of polynomial kernels on a piece of a segment, in Bernstein form.

use super::{
    interval::Interval,
    piece::{Piece, Trend},
};

/// The highest degree along a ray: 2α for the power kernel α = 8.
const MAX_DEGREE: usize = 16;

type Coefficients = [f64; MAX_DEGREE + 1];

/// BINOMIALS\[n\]\[k\] = n over k.
const BINOMIALS: [Coefficients; MAX_DEGREE + 1] = {
    let mut rows = [[0.0; MAX_DEGREE + 1]; MAX_DEGREE + 1];
    let mut n = 0;
    while n <= MAX_DEGREE {
        rows[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            rows[n][k] = rows[n - 1][k - 1] + rows[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    rows
};

/// A polynomial on \[from, to\] by its Bernstein coefficients there.
#[derive(Clone)]
pub(super) struct Bernstein {
    from: f64,
    to: f64,
    degree: usize,
    coefficients: Coefficients,
}

impl Bernstein {
    /// The field on the whole segment, for the kernel Σ cₙ vⁿ.
    ///
    /// Coefficients are scaled by their binomial while they are summed: products are then plain
    /// convolutions. As no term of any v is negative, nothing in a ball's part cancels, and each coefficient is
    /// good to (n + 50)·2e-16 of the sum of the sizes of n balls' parts.
    pub(super) fn new(segment: &Interval<'_>, kernel: &[f64]) -> Self {
        let degree = 2 * (kernel.len() - 1);
        let mut sum = [0.0; MAX_DEGREE + 1];
        for bump in segment.bumps() {
            let depth = [
                bump.depth(0.0),
                2.0 * bump.polar_form(0.0, segment.length),
                bump.depth(segment.length),
            ];
            let value = compose(kernel, &depth);
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += bump.strength * value;
            }
        }
        for (sum, binomial) in sum.iter_mut().zip(&BINOMIALS[degree][..=degree]) {
            *sum /= binomial;
        }
        Self { from: 0.0, to: segment.length, degree, coefficients: sum }
    }

    fn coefficients(&self) -> &[f64] {
        &self.coefficients[..=self.degree]
    }
}

/// Σ cₙ vⁿ by Horner's rule, in scaled coefficients, for a parabola v.
fn compose(kernel: &[f64], depth: &[f64; 3]) -> Coefficients {
    let mut sum = [0.0; MAX_DEGREE + 1];
    let mut degree = 0;
    for (step, &coefficient) in kernel.iter().rev().enumerate() {
        if step > 0 {
            let mut product = [0.0; MAX_DEGREE + 1];
            for (k, term) in sum[..=degree].iter().enumerate() {
                product[k] += term * depth[0];
                product[k + 1] += term * depth[1];
                product[k + 2] += term * depth[2];
            }
            sum = product;
            degree += 2;
        }
        if coefficient != 0.0 {
            for (sum, binomial) in sum.iter_mut().zip(&BINOMIALS[degree][..=degree]) {
                *sum += coefficient * binomial;
            }
        }
    }
    sum
}

impl Piece for Bernstein {
    fn span(&self) -> (f64, f64) {
        (self.from, self.to)
    }

    fn ends(&self) -> (f64, f64) {
        (self.coefficients[0], self.coefficients[self.degree])
    }

    fn range(&self) -> (f64, f64) {
        self.coefficients()
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &c| (low.min(c), high.max(c)))
    }

    fn trend(&self) -> Option<Trend> {
        if self.coefficients().is_sorted() {
            Some(Trend::Rising)
        } else if self.coefficients().is_sorted_by(|a, b| a >= b) {
            Some(Trend::Falling)
        } else {
            None
        }
    }

    /// De Casteljau's algorithm at the middle.
    fn split_at(&self, middle: f64) -> [Self; 2] {
        let mut first = Self { to: middle, ..self.clone() };
        let mut second = Self { from: middle, ..self.clone() };
        let row = &mut second.coefficients;
        for k in 1..=self.degree {
            for i in 0..=self.degree - k {
                row[i] = 0.5 * (row[i] + row[i + 1]);
            }
            first.coefficients[k] = row[0];
        }
        [first, second]
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
        /// Both sides are good to some tens of roundings of values up to `strength` ≤ 2.
        #[test]
        fn pieces_are_the_field(
            kernel in proptest::sample::select(Kernel::all().collect::<Vec<_>>()),
            side in -0.99f32..0.99,
            strength in 0.1f32..2.0,
            share in 0.0f64..1.0,
        ) {
            let Some(coefficients) = kernel.coefficients() else { return Ok(()) };
            let line = Line::new(&Ray::new(Vec3::new(side, 0.0, -2.0), Vec3::Z));
            let ball = Metaball { center: Vec3::ZERO, radius: 1.0, strength };
            let chord = Chord::new(&line, &ball).expect("the line meets the ball");
            let segment = Interval::of(&chord, kernel);
            let length = segment.length;
            let mut piece = Bernstein::new(&segment, coefficients);
            // Halve towards the point at `share`, and hold each piece against the field.
            for _ in 0..20 {
                let (from, to) = piece.span();
                let (low, high) = piece.range();
                for (u, value) in [(from, piece.ends().0), (to, piece.ends().1)] {
                    prop_assert!((segment.field(u).0 - value).abs() < 1e-13);
                }
                let inside = segment.field(from + share * (to - from)).0;
                prop_assert!(low - 1e-13 <= inside && inside <= high + 1e-13);
                let [first, second] = piece.split_at(0.5 * (from + to));
                piece = if share * length < first.span().1 { first } else { second };
            }
        }
    }

    #[test]
    fn binomials_are_those_of_pascal() {
        assert_eq!(&BINOMIALS[4][..6], &[1.0, 4.0, 6.0, 4.0, 1.0, 0.0]);
        assert_eq!(BINOMIALS[16][8], 12_870.0);
    }
}
