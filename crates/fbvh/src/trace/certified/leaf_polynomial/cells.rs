//! How far a polynomial may be from the field, cell by cell.

use super::super::kernel::LaneKernel;
use super::super::lanes::{Lanes, WIDTH, array_of};
use super::super::parabolas::UNIT;
use super::Term;
use super::monomials::{COUNT, EXPONENTS, in_cell, place};
use super::quadratic::Quadratic;

/// How finely a box is cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells {
    /// Cells along an axis, of which the cube is a multiple of eight.
    pub(super) along: usize,
}

impl Cells {
    /// For a bound that takes an eighth of the time.
    pub(super) const COARSE: Self = Self { along: 2 };
    /// For one that is a fourth, or down to the error itself.
    pub(super) const FINE: Self = Self { along: 4 };

    /// Half of a cell's sides, where the box is \[−1, 1\]³.
    fn half(self) -> f32 {
        (self.along as f32).recip()
    }

    /// The middles of the cells, eight at a time, where the box is \[−1, 1\]³.
    fn middles(self) -> impl Iterator<Item = [Lanes<f32>; 3]> {
        let along = self.along;
        (0..along.pow(3) / WIDTH).map(move |group| {
            let middle = |axis: u32, lane: usize| {
                let cell = (WIDTH * group + lane) / along.pow(axis) % along;
                (2 * cell + 1) as f32 * self.half() - 1.0
            };
            array_of(|axis| Lanes(array_of(|lane| middle(axis as u32, lane))))
        })
    }
}

/// Bounds of F − T − P in the box.
pub(super) struct Residual {
    /// The middle of its range, and half of it with all that rounding and quadratics add.
    pub(super) middle: f32,
    pub(super) error: f32,
    /// Of the derivatives, where the box is \[−1, 1\]³; with what follows.
    pub(super) slope_errors: [f32; 3],
    /// Of the gradient, whichever way, 1/scene unit.
    pub(super) steepness_error: f32,
}

/// The sums over the balls of what the quadratics' coefficients are made of, in cells side by side.
struct Sums {
    constant: Lanes<f32>,
    /// Σ q·D·g, g the offset over R, and D the quadratic's slope at the middle.
    linear: [Lanes<f32>; 3],
    /// Σ q·A·gₐ·g_b, A the quadratic's curvature, for b ≥ a.
    squares: [[Lanes<f32>; 3]; 3],
    /// Σ q·D/R².
    slope: Lanes<f32>,
    /// Σ q·A·g/R².
    cubic: [Lanes<f32>; 3],
    /// Σ q·A/R⁴.
    quartic: Lanes<f32>,
    /// Of what the quadratics miss, and of the steepest slopes of them.
    error: Lanes<f32>,
    steepness_error: Lanes<f32>,
    /// Of what rounding of v changes.
    rounded: Lanes<f32>,
    /// Of what the terms are made of.
    magnitude: Lanes<f32>,
}

/// Bounds the residual of P in a box about the origin with these half sides.
#[inline(always)]
pub(super) fn bound<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    threshold: f32,
    terms: &[Term],
    half: &[f32; 3],
    coefficients: &[f32; COUNT],
    cells: Cells,
) -> Residual {
    let zero = Lanes::splat(0.0f32);
    let cell: [f32; 3] = array_of(|axis| half[axis] * cells.half());
    let (mut low, mut high) = (Lanes::splat(f32::INFINITY), Lanes::splat(f32::NEG_INFINITY));
    let (mut slopes, mut steepness_error) = ([zero; 3], zero);
    // Infinite or NaN where anything is.
    let mut total = zero;
    for center in cells.middles() {
        let sums = sums(kernel, terms, half, &cell, &center);
        let unit = (terms.len() + 32 + K::ROUNDINGS) as f32 * UNIT;
        let rounding = sums.magnitude.map(|sum| (sum + threshold) * unit) + sums.rounded;
        let error = (sums.error + rounding) * 1.0001;
        let left = sums.less(threshold, &cell, &in_cell(coefficients, &center, cells.half()));
        let Range { middle, half, slopes: own } = Range::of(&left);
        low = low.min(middle - half - error);
        high = high.max(middle + half + error);
        for axis in 0..3 {
            // A derivative has at most four times the rounding of its polynomial.
            slopes[axis] = slopes[axis].max((own[axis] + rounding * 4.0) * cells.along as f32);
        }
        steepness_error = steepness_error.max(sums.steepness_error * 1.0001);
        total += middle + half + error + sums.steepness_error + own[0] + own[1] + own[2];
    }
    let greatest = |lanes: Lanes<f32>| lanes.0.into_iter().fold(f32::NEG_INFINITY, f32::max);
    let overflows = !total.0.iter().all(|total| total.is_finite());
    let (low, high) = (-greatest(zero - low), greatest(high));
    let magnitude: f32 = coefficients.iter().map(|c| c.abs()).sum();
    let restricted = 64.0 * UNIT * magnitude;
    Residual {
        middle: 0.5 * (low + high),
        error: if overflows { f32::INFINITY } else { 0.5 * (high - low) + restricted },
        slope_errors: slopes.map(|slope| greatest(slope) + 4.0 * restricted * cells.along as f32),
        steepness_error: greatest(steepness_error),
    }
}

/// Sums over the balls that reach cells with these middles, where the box is \[−1, 1\]³; their half sides
/// are in scene units.
#[inline(always)]
fn sums<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    terms: &[Term],
    half: &[f32; 3],
    cell: &[f32; 3],
    center: &[Lanes<f32>; 3],
) -> Sums {
    let zero = Lanes::splat(0.0f32);
    let mut sums = Sums {
        constant: zero,
        linear: [zero; 3],
        squares: [[zero; 3]; 3],
        slope: zero,
        cubic: [zero; 3],
        quartic: zero,
        error: zero,
        steepness_error: zero,
        rounded: zero,
        magnitude: zero,
    };
    let middle: [_; 3] = array_of(|axis| center[axis] * half[axis]);
    for term in terms {
        let inverse = term.inverse_radius;
        let (mut offsets, mut nearest, mut farthest) = ([zero; 3], zero, zero);
        for axis in 0..3 {
            offsets[axis] = (middle[axis] - Lanes::splat(term.center[axis])) * inverse;
            let (away, reach) = (offsets[axis].map(f32::abs), Lanes::splat(cell[axis] * inverse));
            let (near, far) = ((away - reach).max(zero), away + reach);
            nearest += near * near;
            farthest += far * far;
        }
        // v is right to this.
        let margin = farthest.map(|square| 16.0 * UNIT * (1.0 + square));
        let high = (margin - nearest).map(|x| 1.0 + x);
        if !zero.is_less(high).any() {
            continue;
        }
        sums.add(kernel, term, cell, &offsets, (farthest, high, margin));
    }
    sums
}

impl Sums {
    /// Adds a ball that is so far from the cells' middles, in radii; its squared distance is at most
    /// `farthest`, its v at most `high`.
    #[inline(always)]
    fn add<K: LaneKernel<N>, const N: usize>(
        &mut self,
        kernel: K,
        term: &Term,
        cell: &[f32; 3],
        offsets: &[Lanes<f32>; 3],
        (farthest, high, margin): (Lanes<f32>, Lanes<f32>, Lanes<f32>),
    ) {
        let zero = Lanes::splat(0.0f32);
        let (inverse, q, size) = (term.inverse_radius, term.strength, term.strength.abs());
        let low = (zero - farthest - margin).map(|x| 1.0 + x);
        // A ball that does not reach a cell adds nothing there.
        let reaches = zero.is_less(high);
        let high = reaches.select(high, zero);
        let p = Quadratic::new(kernel, low.min(high), high);
        let [x, y, z] = *offsets;
        let v = (zero - (x * x + y * y + z * z)).map(|x| 1.0 + x) - p.middle;
        let curvature = reaches.select(p.curvature * q, zero);
        let slope_there = reaches.select(p.slope * q, zero);
        let value_there = reaches.select(p.value * q, zero);
        let slope = slope_there + curvature * v * 2.0;
        let value = value_there + (slope_there + curvature * v) * v;
        self.constant += value;
        let g: [_; 3] = array_of(|axis| offsets[axis] * inverse);
        let bent: [_; 3] = array_of(|axis| curvature * g[axis]);
        for axis in 0..3 {
            self.linear[axis] += slope * g[axis];
            self.cubic[axis] += bent[axis] * (inverse * inverse);
        }
        for (a, squares) in self.squares.iter_mut().enumerate() {
            for (b, square) in squares.iter_mut().enumerate().skip(a) {
                *square += bent[a] * g[b];
            }
        }
        self.slope += slope * (inverse * inverse);
        self.quartic += curvature * (inverse * inverse * inverse * inverse);
        // How far v strays from its value at the middle, at most.
        let mut range = v.map(f32::abs);
        for axis in 0..3 {
            let reach = cell[axis] * inverse;
            range += offsets[axis].map(|x| (2.0 * x.abs() + reach) * reach);
        }
        let steepest = reaches.select(p.steepest * size, zero);
        let greatest = reaches.select(p.value * size, zero);
        self.magnitude += greatest + steepest * range;
        self.rounded += steepest * margin;
        self.error += reaches.select(p.error * size, zero);
        let gradient = farthest.sqrt() * (2.000_02 * inverse);
        self.steepness_error += reaches.select(p.slope_error * gradient * size, zero);
    }

    /// The coefficients of the sum of all quadratics, less T and a polynomial, where the cell is
    /// \[−1, 1\]³.
    #[inline(always)]
    fn less(
        &self,
        threshold: f32,
        cell: &[f32; 3],
        polynomial: &[Lanes<f32>; COUNT],
    ) -> [Lanes<f32>; COUNT] {
        let zero = Lanes::splat(0.0f32);
        let mut left: [_; COUNT] = array_of(|at| zero - polynomial[at]);
        left[0] += self.constant - Lanes::splat(threshold);
        for a in 0..3 {
            left[power(a, 1, a, 0)] += self.linear[a] * (-2.0 * cell[a]);
            left[power(a, 2, a, 0)] += self.slope * (-cell[a] * cell[a]);
            for b in 0..3 {
                let square = cell[b] * cell[b];
                left[power(a, 1, b, 2)] += self.cubic[a] * (4.0 * cell[a] * square);
                left[power(a, 2, b, 2)] += self.quartic * (cell[a] * cell[a] * square);
            }
        }
        for (a, squares) in self.squares.iter().enumerate() {
            for (b, square) in squares.iter().enumerate().skip(a) {
                let factor = if a == b { 4.0 } else { 8.0 };
                left[power(a, 1, b, 1)] += *square * (factor * cell[a] * cell[b]);
            }
        }
        left
    }
}

/// The place of the product of two variables' powers, or of two powers of one.
#[inline(always)]
fn power(a: usize, m: usize, b: usize, n: usize) -> usize {
    let mut exponents = [0; 3];
    exponents[a] += m;
    exponents[b] += n;
    place(exponents[0], exponents[1], exponents[2])
}

/// The range of a polynomial on \[−1, 1\]³, lane by lane.
struct Range {
    middle: Lanes<f32>,
    half: Lanes<f32>,
    /// Its derivatives are nowhere more.
    slopes: [Lanes<f32>; 3],
}

impl Range {
    #[inline(always)]
    fn of(coefficients: &[Lanes<f32>; COUNT]) -> Self {
        let zero = Lanes::splat(0.0f32);
        let (mut middle, mut half, mut slopes) = (coefficients[0], zero, [zero; 3]);
        for (coefficient, exponents) in coefficients.iter().zip(EXPONENTS).skip(1) {
            let magnitude = coefficient.map(f32::abs);
            if exponents.iter().all(|n| n % 2 == 0) {
                // A monomial of even exponents is from 0 to 1.
                middle += *coefficient * 0.5;
                half += magnitude * 0.5;
            } else {
                half += magnitude;
            }
            for (slope, n) in slopes.iter_mut().zip(exponents) {
                *slope += magnitude * f32::from(n);
            }
        }
        Self { middle, half, slopes }
    }
}
