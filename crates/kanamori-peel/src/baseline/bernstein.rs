//! A ball's contribution to the field on an interval of its chord, in Bernstein form.
//!
//! Polynomials are kept *scaled*: coefficient k times the binomial of the degree over k. Products of
//! scaled polynomials are plain convolutions.

use metaball_core::Kernel;

use super::chord::Chord;

/// The highest degree: the kernel v⁸.
pub(super) const MOST_DEGREE: usize = 16;

/// Coefficients of a polynomial on [0, 1]; those above its degree are 0.
pub(super) type Coefficients = [f64; MOST_DEGREE + 1];

/// A sum of balls' contributions, scaled, of a kernel's degree along a ray.
#[derive(Debug, Clone)]
pub(super) struct Sum<'k> {
    kernel: &'k [f64],
    scaled: Coefficients,
}

impl Sum<'_> {
    /// The constant −`threshold`; `None` for a kernel that is no polynomial.
    pub(super) fn below(kernel: Kernel, threshold: f64) -> Option<Self> {
        let kernel = kernel.coefficients()?;
        let mut scaled = [0.0; MOST_DEGREE + 1];
        add_constant(&mut scaled, 2 * (kernel.len() - 1), -threshold);
        Some(Self { kernel, scaled })
    }

    /// Adds a ball on [low, high] of its chord.
    ///
    /// Along the chord v = (h² − (t − m)²)/R² is quadratic; its middle control point is the polar
    /// form (h² − (low − m)(high − m))/R². The kernel of it follows by Horner's scheme.
    pub(super) fn add(&mut self, chord: &Chord, low: f64, high: f64) {
        let (to_low, to_high) = (low - chord.middle, high - chord.middle);
        let v = |product: f64| ((chord.half_squared - product) * chord.inverse_square).max(0.0);
        let quadratic = [v(to_low * to_low), 2.0 * v(to_low * to_high), v(to_high * to_high)];
        let last = self.kernel.len() - 1;
        let mut power = [0.0; MOST_DEGREE + 1];
        power[0] = self.kernel[last];
        for (step, &coefficient) in self.kernel[..last].iter().rev().enumerate() {
            let degree = 2 * (step + 1);
            for k in (0..=degree).rev() {
                let from = |back: usize| if k >= back { power[k - back] } else { 0.0 };
                power[k] = quadratic[0] * from(0) + quadratic[1] * from(1) + quadratic[2] * from(2);
            }
            if coefficient != 0.0 {
                add_constant(&mut power, degree, coefficient);
            }
        }
        for (sum, term) in self.scaled.iter_mut().zip(power) {
            *sum += chord.strength * term;
        }
    }

    /// Control points and the degree.
    pub(super) fn control_points(&self) -> (Coefficients, usize) {
        let degree = 2 * (self.kernel.len() - 1);
        let mut points = self.scaled;
        let mut binomial = 1.0;
        for (k, point) in points.iter_mut().enumerate().take(degree + 1) {
            *point /= binomial;
            binomial = next_binomial(binomial, degree, k);
        }
        (points, degree)
    }
}

fn add_constant(scaled: &mut Coefficients, degree: usize, constant: f64) {
    let mut binomial = 1.0;
    for (k, coefficient) in scaled.iter_mut().enumerate().take(degree + 1) {
        *coefficient += binomial * constant;
        binomial = next_binomial(binomial, degree, k);
    }
}

/// n over k + 1 from n over k.
fn next_binomial(binomial: f64, n: usize, k: usize) -> f64 {
    binomial * n.saturating_sub(k) as f64 / (k + 1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the kernel itself, at points of an interval inside the chord: a few dozen operations of
    /// numbers up to 1.
    #[test]
    fn a_contribution_is_the_kernel_along_the_chord() {
        let chord = Chord {
            ball: 0,
            middle: 3.0,
            half_squared: 1.7,
            inverse_square: 0.5,
            strength: 1.25,
            kernel_half_squared: -1.0,
        };
        let (low, high) = (2.2, 4.1);
        for kernel in Kernel::all().filter(|kernel| kernel.coefficients().is_some()) {
            let mut sum = Sum::below(kernel, 0.4).expect("a polynomial");
            sum.add(&chord, low, high);
            let (points, degree) = sum.control_points();
            for step in 0..=10 {
                let u = f64::from(step) / 10.0;
                let t = low + u * (high - low);
                let v = (chord.half_squared - (t - chord.middle).powi(2)) * chord.inverse_square;
                let exact = 1.25 * kernel.value(1.0 - v) - 0.4;
                let mut curve = points;
                for round in 1..=degree {
                    for k in 0..=degree - round {
                        curve[k] += u * (curve[k + 1] - curve[k]);
                    }
                }
                assert!((curve[0] - exact).abs() < 1e-13, "{kernel} at {t}");
            }
        }
    }
}
