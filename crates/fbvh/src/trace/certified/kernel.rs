//! Kernels in lanes: their values, and what bounds a ball on an interval of a ray.

mod convex;
mod power;
mod wyvill;

use metaball_core::Kernel;

use self::convex::Convex;
use self::power::Power;
use self::wyvill::Wyvill;
use super::lanes::{Lanes, Mask};

/// A kernel whose parts along a ray are bounded by polynomials of N Bernstein coefficients.
pub(super) trait LaneKernel<const N: usize>: Copy {
    /// Whether a ball's slope along a ray is bounded by lines; by its sign otherwise.
    const BOUNDS_SLOPES: bool;

    /// Roundings of a value in f32, beyond those that every sum allows for.
    const ROUNDINGS: usize;

    /// k(v) for v ≥ 0.
    fn value(self, v: Lanes<f32>) -> Lanes<f32>;

    /// dk/dv for v ≥ 0; at 0 the limit from inside.
    fn slope(self, v: Lanes<f32>) -> Lanes<f32>;

    /// k(v) and dk/dv for v ≥ 0, in f64; both are 0 at 0.
    fn value_and_slope(self, v: Lanes<f64>) -> (Lanes<f64>, Lanes<f64>);

    /// Bounds of a ball of this strength on an interval, where it `reaches` it.
    fn bounds(self, v: &Stretch, strength: Lanes<f32>, reaches: Mask) -> Bounds<N>;

    /// By how much the quadratic that meets k at the Chebyshev nodes of a range of v misses k, and its
    /// derivative k′, from `low` < 1 to `high`.
    fn quadratic_errors(self, low: Lanes<f32>, high: Lanes<f32>) -> (Lanes<f32>, Lanes<f32>);

    /// Whether the slope jumps at the rim.
    fn has_kink(self) -> bool;
}

/// v = 1 − r²/R² on an interval of a ray.
pub(super) struct Stretch {
    /// Its Bernstein coefficients: the values at the ends and, between them, the polar form.
    pub(super) v: [Lanes<f32>; 3],
    /// v where the whole ray is nearest, and whether that is in the interval.
    pub(super) peak: Lanes<f32>,
    pub(super) has_peak: Mask,
    /// dv/dt at the ends.
    pub(super) slopes: [Lanes<f32>; 2],
    /// How far rounding can move v, and dv/dt.
    pub(super) margin: Lanes<f32>,
    pub(super) slope_margin: Lanes<f32>,
}

impl Stretch {
    /// v is nowhere more, but for its margin.
    #[inline(always)]
    pub(super) fn top(&self) -> Lanes<f32> {
        self.v[0].max(self.v[1]).max(self.v[2])
    }

    /// The greatest v, but for its margin.
    #[inline(always)]
    fn greatest(&self) -> Lanes<f32> {
        let ends = self.v[0].max(self.v[2]);
        self.has_peak.select(self.peak.max(ends), ends)
    }

    /// v is nowhere less, but for its margin.
    #[inline(always)]
    fn bottom(&self) -> Lanes<f32> {
        self.v[0].min(self.v[2])
    }
}

/// What a ball adds to the field on an interval.
pub(super) struct Bounds<const N: usize> {
    /// Coefficients, times their binomials, of a polynomial nowhere below it but for `error`, and of one
    /// nowhere above it.
    pub(super) most: [Lanes<f32>; N],
    pub(super) least: [Lanes<f32>; N],
    /// At the interval's start at most this, and at its ends at least this, but for `error`.
    pub(super) start: Lanes<f32>,
    pub(super) ends: [Lanes<f32>; 2],
    /// How far rounding of the parabola can move it.
    pub(super) error: Lanes<f32>,
    /// For coefficients that are differences: of what size the numbers are that they are made of.
    pub(super) magnitude: Lanes<f32>,
    /// Where its slope along the ray is certainly nowhere negative.
    pub(super) rises: Mask,
    /// Where the kernel [bounds slopes](LaneKernel::BOUNDS_SLOPES): values at the interval's ends of a line
    /// that its slope along the ray is nowhere below, 1/unit of t, and the size of the numbers that they are
    /// made of.
    pub(super) rise: [Lanes<f32>; 2],
    pub(super) steepness: Lanes<f32>,
}

/// A computation that is compiled for each kernel.
pub(super) trait ByKernel {
    type Output;

    fn run<K: LaneKernel<N>, const N: usize>(self, kernel: K) -> Self::Output;
}

/// Runs the computation for the kernel; `None` for Perlin's.
///
/// It is compiled for each kernel that is a polynomial of low degree in v, and once for all others, which are
/// asked which one they are at each value: compiled for each, they took twice the time to build.
#[inline(always)]
pub(super) fn by_kernel<C: ByKernel>(kernel: Kernel, computation: C) -> Option<C::Output> {
    let exponent = match kernel {
        Kernel::Wyvill => return Some(computation.run(Wyvill)),
        Kernel::Power(exponent) => exponent.get(),
        _ => 0,
    };
    Some(match exponent {
        1 => computation.run::<_, 3>(Power),
        2 => computation.run::<_, 5>(Power),
        3 => computation.run::<_, 7>(Power),
        4 => computation.run::<_, 9>(Power),
        _ => computation.run(Convex(kernel.profile()?)),
    })
}

/// Whether [`by_kernel`] runs for it.
pub(super) fn has_bounds(kernel: Kernel) -> bool {
    kernel != Kernel::Perlin
}

/// What the quadratic of [`LaneKernel::quadratic_errors`] misses of functions that are no quadratics, on a range
/// of v: each with what its derivative misses.
struct Missed {
    /// Of v₊, whose slope jumps by 1 at 0.
    kink: (Lanes<f32>, Lanes<f32>),
    /// Of v₊², whose second derivative jumps by 2.
    jump: (Lanes<f32>, Lanes<f32>),
    /// Of a function whose third derivative is 1.
    third: (Lanes<f32>, Lanes<f32>),
    /// Of a convex function whose slopes at the ends differ by 1.
    bent: (Lanes<f32>, Lanes<f32>),
    /// Of one whose second derivative rises by 1 in all.
    curved: (Lanes<f32>, Lanes<f32>),
}

impl Missed {
    #[inline(always)]
    fn on(low: Lanes<f32>, high: Lanes<f32>) -> Self {
        let zero = Lanes::splat(0.0f32);
        let half = (high - low) * 0.5;
        let square = half * half;
        // The shorter side of 0, where it is in the range.
        let beyond = high.min(zero - low).max(zero);
        let one = Lanes::splat(1.0f32);
        Self {
            kink: ((half * (1.0 / 6.0)).min(beyond), zero.is_less(beyond).select(one, zero)),
            jump: ((square * 0.113).min(beyond * beyond), (half * 0.792).min(beyond * 2.0)),
            third: (square * half * (1.0 / 24.0), square * (9.0 / 24.0)),
            bent: (half * (1.0 / 6.0), one),
            curved: (square * 0.056_5, half * 0.396),
        }
    }
}

/// Multiplies a polynomial of so high a degree by one of degree two, both by Bernstein coefficients times their
/// binomials.
#[inline(always)]
fn multiply<const N: usize>(
    product: &mut [Lanes<f32>; N],
    [first, second, third]: &[Lanes<f32>; 3],
    degree: usize,
) {
    for k in (0..=degree + 2).rev() {
        let mut term = Lanes::splat(0.0);
        if k <= degree {
            term += product[k] * *first;
        }
        if k >= 1 && k <= degree + 1 {
            term += product[k - 1] * *second;
        }
        if k >= 2 {
            term += product[k - 2] * *third;
        }
        product[k] = term;
    }
}

/// Bounds of a ball whose kernel is a polynomial of v, from the coefficients of the kernel of v raised to 0:
/// see `trace/certified.rs`.
#[inline(always)]
fn of_polynomial<const N: usize>(
    terms: [Lanes<f32>; N],
    slope: Lanes<f32>,
    v: &Stretch,
    strength: Lanes<f32>,
) -> Bounds<N> {
    let zero = Lanes::splat(0.0f32);
    let covers = v.margin.is_at_most(v.bottom());
    let mut least = terms;
    for term in &mut least {
        *term = covers.select(*term, zero);
    }
    Bounds {
        most: terms,
        least,
        // There the raised parabolas are the true ones.
        start: terms[0],
        ends: [terms[0], terms[N - 1]],
        error: strength * v.margin * slope,
        magnitude: zero,
        rises: v.slope_margin.is_at_most(v.slopes[1]),
        rise: [zero; 2],
        steepness: zero,
    }
}

#[cfg(test)]
mod tests;
