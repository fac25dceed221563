//! Polynomials on \[0, 1\] by their Bernstein coefficients, which enclose their values.

use std::ops::{Add, Mul, Sub};

/// 1 / C(N − 1, k): turns the coefficients of products, which carry the binomials, into Bernstein's.
pub(super) const fn inverse_binomials<const N: usize>() -> [f64; N] {
    let mut inverses = [1.0; N];
    let mut binomial = 1.0;
    let mut k = 1;
    while k < N {
        binomial = binomial * (N - k) as f64 / k as f64;
        inverses[k] = 1.0 / binomial;
        k += 1;
    }
    inverses
}

/// Numbers, alone or side by side.
pub(super) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
}

impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Number for T {}

/// The value at x and the derivative by x (de Casteljau).
pub(super) fn value_and_slope<const N: usize>(coefficients: [f64; N], x: f64) -> (f64, f64) {
    let (value, rise) = value_and_rise(coefficients, x);
    (value, (N - 1) as f64 * rise)
}

/// The value at x, and the derivative over the degree.
#[inline(always)]
pub(super) fn value_and_rise<T: Number, const N: usize>(mut coefficients: [T; N], x: T) -> (T, T) {
    for level in (2..N).rev() {
        for k in 0..level {
            coefficients[k] = between(coefficients[k], coefficients[k + 1], x);
        }
    }
    let rise = coefficients[1] - coefficients[0];
    (coefficients[0] + x * rise, rise)
}

#[inline(always)]
fn between<T: Number>(start: T, end: T, x: T) -> T {
    start + x * (end - start)
}

/// Where a polynomial that is negative at 0 may first reach 0: never after the first root. `None`
/// where there is none.
///
/// Control points lie below the steepest line from the first of them to another, and so does the
/// polynomial: it is negative up to where that line is. Repeated on the rest (Bézier clipping, from
/// one side), as long as it pays.
pub(super) fn negative_until<const N: usize>(mut coefficients: [f64; N]) -> Option<f64> {
    const CLIPS: usize = 4;
    let degree = (N - 1) as f64;
    let mut start = 0.0;
    for clip in 0..CLIPS {
        let first = coefficients[0];
        let steepest =
            (1..N).map(|k| (coefficients[k] - first) / k as f64).fold(f64::NEG_INFINITY, f64::max);
        let x = -first / (degree * steepest);
        let reaches = coefficients.iter().any(|&c| c >= 0.0);
        if !reaches {
            return None;
        }
        let x = x.clamp(0.0, 1.0);
        // Before it by more than the rounding of a few interpolations.
        let x = x * (1.0 - 1e-9);
        start += x * (1.0 - start);
        if clip + 1 == CLIPS || x < 0.05 {
            break;
        }
        right_of(&mut coefficients, x);
    }
    Some(start)
}

/// Restricts the polynomial to \[x, 1\].
#[inline(always)]
pub(super) fn right_of<T: Number, const N: usize>(coefficients: &mut [T; N], x: T) {
    for level in (1..N).rev() {
        for k in 0..level {
            coefficients[k] = between(coefficients[k], coefficients[k + 1], x);
        }
    }
}

/// The only root of a polynomial that changes sign once, from below to above, to about 1e-6.
pub(super) fn only_root<const N: usize>(coefficients: &[f64; N]) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    // Where the control polygon crosses.
    let after = coefficients.iter().position(|&c| c > 0.0).unwrap_or(N - 1).max(1);
    let (below, above) = (coefficients[after - 1], coefficients[after]);
    let mut x = ((after - 1) as f64 + (below / (below - above)).clamp(0.0, 1.0)) / (N - 1) as f64;
    for _ in 0..24 {
        let (value, slope) = value_and_slope(*coefficients, x);
        if value >= 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() < 1e-4 {
            // The next error is the square of this.
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Interpolations of coefficients up to 1 err by a few 1e-16.
        #[test]
        fn nothing_is_reached_before(coefficients in [-1.0f64..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0]) {
            prop_assume!(coefficients[0] < 0.0);
            let until = negative_until(coefficients).unwrap_or(1.0);
            for step in 0..=100 {
                let (value, _) = value_and_slope(coefficients, until * f64::from(step) / 100.0);
                prop_assert!(value < 1e-12, "{value} at {step} % of {until}");
            }
        }

        #[test]
        fn the_only_root_is_found(root in 0.05f64..0.95, rest in [0.1f64..2.0, 0.1..2.0, 0.1..2.0, 0.1..2.0]) {
            // (x − root) times a positive cubic: coefficients of products carry the binomials.
            let scaled = [rest[0], 3.0 * rest[1], 3.0 * rest[2], rest[3]];
            let mut product = [0.0; 5];
            for (k, c) in scaled.iter().enumerate() {
                product[k] -= root * c;
                product[k + 1] += (1.0 - root) * c;
            }
            let inverses = inverse_binomials::<5>();
            let coefficients: [f64; 5] = std::array::from_fn(|k| product[k] * inverses[k]);
            prop_assert!((only_root(&coefficients) - root).abs() < 1e-5);
        }
    }
}
