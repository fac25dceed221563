//! One polynomial for the whole field in a leaf, with a bound of its error.
//!
//! Where supports overlap densely a leaf's list is long, and every pass of a search walks it. Yet the
//! field is smooth there: P of total degree 4 in the coordinates of the box, with |F − T − P| ≤ e all over
//! it, and |∂(F − T − P)/∂t| bounded along a ray, decides most rays whatever the length of the list and
//! whatever the kernel. Where P + e < 0 nothing is, where P − e > 0 it is solid, and where moreover P
//! rises faster than its slope's error between the two, there is one root.
//!
//! # Why the bounds hold
//! The box is cut into 2³ or 4³ cells. In a cell a ball's v = 1 − r²/R² has an exact range, on which its
//! kernel is replaced by a quadratic p(v) with a bound of |k − p| and of |k′ − p′|
//! (`trace/certified/leaf_polynomial/quadratic.rs`); a ball that covers the cell is its own quadratic for
//! α = 2. v is a polynomial of degree two in space, so all p(v) of a cell sum up to one polynomial of
//! degree four, from which P is subtracted coefficient by coefficient, and what is left is bounded by the
//! sum of its coefficients' absolute values (`trace/certified/leaf_polynomial/cells.rs`). To that the
//! bounds of the quadratics are added. P itself is a fit (`trace/certified/leaf_polynomial/fit.rs`), of
//! which nothing is assumed.
//!
//! # Rounding
//! Sums of n terms are right to (n + 32)u times the sum of what the terms are made of, u = 2⁻²⁴; that
//! sum is carried along. v is right to 16u(1 + r²/R²), which widens its range and, times the steepest
//! slope of p, the error. P restricted to a cell is right to 64u of the sum of its coefficients.
//!
//! The box is a little larger than the leaf's, since rays' intervals are widened by rounding.

mod cells;
mod fit;
mod monomials;
mod quadratic;
mod store;

use metaball_core::{Aabb, Kernel};
use pulp::{Arch, Simd, WithSimd};

use self::cells::Cells;
use self::monomials::{COUNT, EXPONENTS};
pub(in crate::trace) use self::store::Polynomials;
use super::kernel::{ByKernel, LaneKernel, by_kernel};
use super::lanes::{Lanes, array_of};
use super::query::Query;
use crate::Field;
use crate::trace::field_tree::FieldTree;

/// What a ball adds to the field.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    /// The centre, from the middle of the leaf's box, scene units.
    pub(super) center: [f32; 3],
    /// 1/R.
    pub(super) inverse_radius: f32,
    pub(super) strength: f32,
}

/// The polynomial of a leaf, in coordinates in which its box, a little enlarged, is \[−1, 1\]³.
#[derive(Debug, Clone)]
pub(super) struct LeafPolynomial {
    /// Of P, an approximation of F − T.
    coefficients: [f32; COUNT],
    /// 1 / half of the box's sides, 1/scene unit.
    pub(super) scale: [f32; 3],
    /// |F − T − P| is nowhere more.
    pub(super) error: f32,
    /// |∂(F − T − P)/∂x| along each axis is nowhere more than this and `steepness_error`, 1/scene unit.
    pub(super) slope_errors: [f32; 3],
    /// What is left of the gradient of F − T − P, whichever way, 1/scene unit.
    pub(super) steepness_error: f32,
    /// The sum of the coefficients' absolute values.
    pub(super) magnitude: f32,
    /// The sum over the axes of the greatest slopes of P, 1/scene unit.
    pub(super) steepness: f32,
}

/// How much of its sides the box is larger: more than rounding can widen a ray's interval in it.
pub(super) const ENLARGED: f32 = 1.0 / 256.0;

impl LeafPolynomial {
    /// The polynomial of a leaf with so many balls; `None` where its box is flat, where numbers overflow, or
    /// where the error is no smaller than what P does in the box, so that it would decide too little.
    fn new(
        arch: Arch,
        kernel: Kernel,
        threshold: f32,
        terms: &[Term],
        bounds: &Aabb,
        cells: Cells,
    ) -> Option<Self> {
        by_kernel(kernel, Making { arch, threshold, terms, bounds, cells })?
    }

    #[inline(always)]
    fn of_kernel<K: LaneKernel<N>, const N: usize>(kernel: K, making: &Making<'_>) -> Option<Self> {
        let Making { threshold, terms, bounds, cells, .. } = *making;
        let half = (0.5 * (bounds.max - bounds.min) * (1.0 + ENLARGED)).to_array();
        let middle = bounds.center().abs().to_array();
        // Where the middle is rounded by more than the box is enlarged it is another box.
        let is_legal = |axis: usize| {
            let is_invertible = half[axis].is_normal() && half[axis].recip().is_normal();
            is_invertible && middle[axis] * f32::EPSILON < 0.25 * ENLARGED * half[axis]
        };
        if !(0..3).all(is_legal) {
            return None;
        }
        let mut coefficients = fit::fit(kernel, threshold, terms, &half);
        let residual = cells::bound(kernel, threshold, terms, &half, &coefficients, cells);
        coefficients[0] += residual.middle;
        let scale = half.map(f32::recip);
        let sum = |weight: &dyn Fn(usize) -> f32| {
            (0..COUNT).map(|at| weight(at) * coefficients[at].abs()).sum::<f32>()
        };
        let magnitude = sum(&|_| 1.0);
        let slopes: [f32; 3] = array_of(|axis| sum(&|at| f32::from(EXPONENTS[at][axis])));
        let steepness = (0..3).map(|axis| slopes[axis] * scale[axis]).sum();
        let error = residual.error * 1.0001;
        let slope_errors = array_of(|axis| residual.slope_errors[axis] * scale[axis] * 1.0001);
        let found = Self {
            coefficients,
            scale,
            error,
            slope_errors,
            steepness_error: residual.steepness_error * 1.0001,
            magnitude,
            steepness,
        };
        let range = slopes.iter().sum::<f32>();
        (error < WORTHWHILE.0 * range && error < WORTHWHILE.1 * threshold).then_some(found)
    }

    /// A constant with this error, for tests.
    #[cfg(test)]
    fn constant(error: f32) -> Self {
        Self {
            coefficients: [0.0; COUNT],
            scale: [1.0; 3],
            error,
            slope_errors: [0.0; 3],
            steepness_error: 0.0,
            magnitude: 0.0,
            steepness: 0.0,
        }
    }

    /// P at points, in the coordinates of the box.
    #[inline(always)]
    pub(super) fn value(&self, point: &[Lanes<f32>; 3]) -> Lanes<f32> {
        monomials::value(&self.coefficients, point)
    }
}

impl<F: Field> FieldTree<'_, F> {
    /// The polynomial of a leaf for which so many rays ask, if it has one.
    pub(super) fn polynomial(
        &self,
        query: &Query,
        arch: Arch,
        leaf: usize,
        rays: u32,
    ) -> Option<&LeafPolynomial> {
        let list = self.tree.list(leaf);
        self.polynomials.get((leaf, self.tree.leaf_count()), list.len(), rays, |cells| {
            let bounds = self.tree.leaves[leaf].bounds();
            let middle = bounds.center().as_dvec3();
            let term = |&ball: &u32| {
                let support = self.field.support(ball as usize);
                let center = (support.center.as_dvec3() - middle).as_vec3().to_array();
                let strength = self.field.strength(ball as usize);
                Term { center, inverse_radius: support.radius.recip(), strength }
            };
            let terms: Vec<Term> = list.iter().map(term).collect();
            let threshold = query.threshold as f32;
            LeafPolynomial::new(arch, query.kernel, threshold, &terms, &bounds, cells)
        })
    }
}

struct Making<'a> {
    arch: Arch,
    threshold: f32,
    terms: &'a [Term],
    bounds: &'a Aabb,
    cells: Cells,
}

impl ByKernel for Making<'_> {
    type Output = Option<LeafPolynomial>;

    fn run<K: LaneKernel<N>, const N: usize>(self, kernel: K) -> Self::Output {
        self.arch.dispatch(MakingOfKernel { kernel, making: self })
    }
}

/// As `pulp` compiles it for wider vectors.
struct MakingOfKernel<'a, K, const N: usize> {
    kernel: K,
    making: Making<'a>,
}

impl<K: LaneKernel<N>, const N: usize> WithSimd for MakingOfKernel<'_, K, N> {
    type Output = Option<LeafPolynomial>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        LeafPolynomial::of_kernel(self.kernel, &self.making)
    }
}

/// The greatest errors that are worth it, over what P does in the box and over T.
const WORTHWHILE: (f32, f32) = (0.3, 0.25);

#[cfg(test)]
mod tests;
