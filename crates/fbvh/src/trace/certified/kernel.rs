//! Kernels that are polynomials of v = 1 − r²/R², in lanes.
//!
//! Along a ray v is a polynomial of degree two, so a kernel of degree d in v makes one of degree 2d
//! with N = 2d + 1 Bernstein coefficients: all functions here are for kernels of this N.

use metaball_core::Kernel;

use super::lanes::Lanes;

/// A computation that is compiled for each N.
pub(super) trait ByDegree {
    type Output;

    fn run<const N: usize>(self) -> Self::Output;
}

/// Whether the kernel is a polynomial of v.
pub(super) fn is_polynomial(kernel: Kernel) -> bool {
    kernel != Kernel::Perlin
}

/// Runs the computation for the kernel's N; `None` for a kernel that is no polynomial of v.
#[inline(always)]
pub(super) fn by_degree<C: ByDegree>(kernel: Kernel, computation: C) -> Option<C::Output> {
    Some(match kernel {
        Kernel::Perlin => return None,
        Kernel::Wyvill => computation.run::<7>(),
        Kernel::Power(exponent) => match exponent.get() {
            1 => computation.run::<3>(),
            2 => computation.run::<5>(),
            3 => computation.run::<7>(),
            4 => computation.run::<9>(),
            5 => computation.run::<11>(),
            6 => computation.run::<13>(),
            7 => computation.run::<15>(),
            _ => computation.run::<17>(),
        },
    })
}

/// The Bernstein coefficients of q·k(v) from those of v, times their binomials: the coefficients of a
/// product of polynomials are then sums of products.
#[inline(always)]
pub(super) fn coefficients<const N: usize>(
    kernel: Kernel,
    [first, second, third]: [Lanes<f32>; 3],
    strength: Lanes<f32>,
) -> [Lanes<f32>; N] {
    let mut product = [Lanes::splat(0.0); N];
    let v = [first, second * 2.0, third];
    for k in 0..3 {
        product[k] = v[k] * strength;
    }
    // How many factors v there are but the first; one factor of Wyvill's is 5/9 + 4/9 v.
    let factors = match kernel {
        Kernel::Wyvill => 1,
        _ => (N - 1) / 2 - 1,
    };
    for factor in 0..factors {
        multiply(&mut product, &v, 2 * factor + 2);
    }
    if kernel == Kernel::Wyvill {
        let wyvill = |v: Lanes<f32>, one: f32| v.map(|v| (5.0 * one + 4.0 * v) * (1.0 / 9.0));
        multiply(&mut product, &[wyvill(v[0], 1.0), wyvill(v[1], 2.0), wyvill(v[2], 1.0)], 4);
    }
    product
}

/// k(v) for v ≥ 0.
#[inline(always)]
pub(super) fn value<const N: usize>(kernel: Kernel, v: Lanes<f32>) -> Lanes<f32> {
    if kernel == Kernel::Wyvill {
        return v.map(|v| v * v * (5.0 + 4.0 * v) * (1.0 / 9.0));
    }
    (1..(N - 1) / 2).fold(v, |product, _| product * v)
}

/// dk/dv for v ≥ 0.
#[inline(always)]
pub(super) fn slope<const N: usize>(kernel: Kernel, v: Lanes<f32>) -> Lanes<f32> {
    if kernel == Kernel::Wyvill {
        return v.map(|v| v * (10.0 + 12.0 * v) * (1.0 / 9.0));
    }
    let exponent = (N - 1) / 2;
    (1..exponent).fold(Lanes::splat(exponent as f32), |product, _| product * v)
}

/// k(v) and dk/dv for v ≥ 0, in f64.
#[inline(always)]
pub(super) fn value_and_slope<const N: usize>(
    kernel: Kernel,
    v: Lanes<f64>,
) -> (Lanes<f64>, Lanes<f64>) {
    if kernel == Kernel::Wyvill {
        return (
            v.map(|v| v * v * (5.0 + 4.0 * v) * (1.0 / 9.0)),
            v.map(|v| v * (10.0 + 12.0 * v) * (1.0 / 9.0)),
        );
    }
    let exponent = (N - 1) / 2;
    // Outside the support the slope is zero, of α = 1 too.
    let inside = v.map(|v| if v > 0.0 { 1.0 } else { 0.0 });
    let power = (1..exponent).fold(inside, |product, _| product * v);
    (power * v, power * exponent as f64)
}

/// Multiplies a polynomial of so high a degree by one of degree two, both with their binomials.
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
