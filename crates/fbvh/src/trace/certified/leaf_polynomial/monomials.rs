//! Polynomials of total degree 4 in three variables, by their coefficients.

use super::super::lanes::Lanes;

/// The total degree.
pub(super) const DEGREE: usize = 4;

/// How many monomials there are.
pub(super) const COUNT: usize = (DEGREE + 1) * (DEGREE + 2) * (DEGREE + 3) / 6;

/// The monomials' exponents, the last variable's fastest.
pub(super) const EXPONENTS: [[u8; 3]; COUNT] = {
    let mut exponents = [[0; 3]; COUNT];
    let (mut at, mut i) = (0, 0);
    while i <= DEGREE {
        let mut j = 0;
        while i + j <= DEGREE {
            let mut k = 0;
            while i + j + k <= DEGREE {
                exponents[at] = [i as u8, j as u8, k as u8];
                at += 1;
                k += 1;
            }
            j += 1;
        }
        i += 1;
    }
    exponents
};

/// Where a monomial's coefficient is; `COUNT` for those of a higher degree.
const PLACES: [[[usize; DEGREE + 1]; DEGREE + 1]; DEGREE + 1] = {
    let mut places = [[[COUNT; DEGREE + 1]; DEGREE + 1]; DEGREE + 1];
    let mut at = 0;
    while at < COUNT {
        let [i, j, k] = EXPONENTS[at];
        places[i as usize][j as usize][k as usize] = at;
        at += 1;
    }
    places
};

/// The place of x^i y^j z^k, whose total degree is at most [`DEGREE`].
#[inline(always)]
pub(super) const fn place(i: usize, j: usize, k: usize) -> usize {
    PLACES[i][j][k]
}

/// The value at points: Horner's scheme, one variable in the other.
#[inline(always)]
pub(super) fn value(coefficients: &[f32; COUNT], [x, y, z]: &[Lanes<f32>; 3]) -> Lanes<f32> {
    let mut in_x = Lanes::splat(coefficients[place(DEGREE, 0, 0)]);
    for i in (0..DEGREE).rev() {
        let mut in_y = Lanes::splat(coefficients[place(i, DEGREE - i, 0)]);
        for j in (0..DEGREE - i).rev() {
            let mut in_z = Lanes::splat(coefficients[place(i, j, DEGREE - i - j)]);
            for k in (0..DEGREE - i - j).rev() {
                in_z = in_z * *z + Lanes::splat(coefficients[place(i, j, k)]);
            }
            in_y = in_y * *y + in_z;
        }
        in_x = in_x * *x + in_y;
    }
    in_x
}

/// The polynomial in η, where each variable is `center` + `half`·η.
#[inline(always)]
pub(super) fn in_cell(
    coefficients: &[f32; COUNT],
    center: &[Lanes<f32>; 3],
    half: f32,
) -> [Lanes<f32>; COUNT] {
    let mut shifted = [Lanes::splat(0.0f32); COUNT];
    for (to, from) in shifted.iter_mut().zip(coefficients) {
        *to = Lanes::splat(*from);
    }
    // Horner's scheme repeated, along lines of monomials that differ in one variable's exponent.
    for (axis, middle) in center.iter().enumerate() {
        for a in 0..=DEGREE {
            for b in 0..=DEGREE - a {
                let degree = DEGREE - a - b;
                for end in 0..degree {
                    for n in (end..degree).rev() {
                        let (to, from) = match axis {
                            0 => (place(n, a, b), place(n + 1, a, b)),
                            1 => (place(a, n, b), place(a, n + 1, b)),
                            _ => (place(a, b, n), place(a, b, n + 1)),
                        };
                        shifted[to] += *middle * shifted[from];
                    }
                }
            }
        }
    }
    let mut powers = [1.0f32; DEGREE + 1];
    for n in 1..=DEGREE {
        powers[n] = half * powers[n - 1];
    }
    for (coefficient, [i, j, k]) in shifted.iter_mut().zip(EXPONENTS) {
        *coefficient = *coefficient * powers[usize::from(i + j + k)];
    }
    shifted
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(coefficients: &[f32; COUNT], point: [f32; 3]) -> f64 {
        let power = |axis: usize, n: u8| f64::from(point[axis]).powi(i32::from(n));
        let monomial = |[i, j, k]: [u8; 3]| power(0, i) * power(1, j) * power(2, k);
        coefficients.iter().zip(EXPONENTS).map(|(c, e)| f64::from(*c) * monomial(e)).sum()
    }

    fn example() -> [f32; COUNT] {
        std::array::from_fn(|at| ((at * at + 3 * at) % 17) as f32 * 0.25 - 2.0)
    }

    #[test]
    fn values_are_sums_of_monomials() {
        let point = [0.3, -0.7, 0.9];
        let value = value(&example(), &point.map(Lanes::splat)).0[0];
        assert!((f64::from(value) - at(&example(), point)).abs() < 1e-5);
    }

    #[test]
    fn a_cell_has_the_values_of_the_whole() {
        let (center, half) = ([0.25, -0.5, 0.75], 0.25);
        let cell = in_cell(&example(), &center.map(Lanes::splat), half).map(|lanes| lanes.0[0]);
        for eta in [[0.0, 0.0, 0.0], [1.0, -1.0, 0.5], [-0.3, 0.8, 1.0]] {
            let point = std::array::from_fn(|axis| center[axis] + half * eta[axis]);
            assert!((at(&cell, eta) - at(&example(), point)).abs() < 1e-5, "{eta:?}");
        }
    }
}
