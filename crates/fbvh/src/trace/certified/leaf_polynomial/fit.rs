//! A polynomial close to the field in a box, by its values at Chebyshev's nodes.

use super::super::kernel::LaneKernel;
use super::super::lanes::{Lanes, WIDTH, array_of};
use super::Term;
use super::monomials::{COUNT, DEGREE, EXPONENTS};

/// Nodes along an axis.
const NODES: usize = DEGREE + 1;

/// Nodes of a plane, in whole lanes; those beyond NODES² repeat others and are not read.
const BLOCKS: usize = (NODES * NODES).div_ceil(WIDTH);

/// Coefficients or values, along x, y and z.
type Cube = [[[f32; NODES]; NODES]; NODES];

/// Chebyshev's nodes on \[−1, 1\]: cos((2k + 1)π/10).
const AT: [f32; NODES] = [0.951_056_5, 0.587_785_24, 0.0, -0.587_785_24, -0.951_056_5];

/// From values at the nodes to coefficients of Chebyshev's polynomials: cos(n(2k + 1)π/10), times 2/5, for
/// n = 0 half of it.
const ANALYSIS: [[f32; NODES]; NODES] = [
    [0.2, 0.2, 0.2, 0.2, 0.2],
    [0.380_422_6, 0.235_114_1, 0.0, -0.235_114_1, -0.380_422_6],
    [0.323_606_8, -0.123_606_8, -0.4, -0.123_606_8, 0.323_606_8],
    [0.235_114_1, -0.380_422_6, 0.0, 0.380_422_6, -0.235_114_1],
    [0.123_606_8, -0.323_606_8, 0.4, -0.323_606_8, 0.123_606_8],
];

/// The coefficient of xⁿ in Chebyshev's polynomials T₀ to T₄.
const SYNTHESIS: [[f32; NODES]; NODES] = [
    [1.0, 0.0, -1.0, 0.0, 1.0],
    [0.0, 1.0, 0.0, -3.0, 0.0],
    [0.0, 0.0, 2.0, 0.0, -8.0],
    [0.0, 0.0, 0.0, 4.0, 0.0],
    [0.0, 0.0, 0.0, 0.0, 8.0],
];

/// Where the nodes of a plane are along its first axis and its second one, which goes faster.
const PLANE: [[f32; BLOCKS * WIDTH]; 2] = {
    let mut plane = [[0.0; BLOCKS * WIDTH]; 2];
    let mut at = 0;
    while at < BLOCKS * WIDTH {
        plane[0][at] = AT[at / NODES % NODES];
        plane[1][at] = AT[at % NODES];
        at += 1;
    }
    plane
};

/// F − T in a box about the origin with these half sides, in coordinates in which it is \[−1, 1\]³: the
/// interpolant at the nodes in Chebyshev's polynomials, without the terms of a higher total degree.
#[inline(always)]
pub(super) fn fit<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    threshold: f32,
    terms: &[Term],
    half: &[f32; 3],
) -> [f32; COUNT] {
    let values = values(kernel, terms, half);
    let mut cube = [[[0.0; NODES]; NODES]; NODES];
    for (i, plane) in cube.iter_mut().enumerate() {
        for (j, line) in plane.iter_mut().enumerate() {
            for (k, to) in line.iter_mut().enumerate() {
                let at = i * NODES + j;
                *to = values[k][at / WIDTH].0[at % WIDTH];
            }
        }
    }
    along_each_axis(&mut cube, &ANALYSIS);
    for (i, plane) in cube.iter_mut().enumerate() {
        for (j, line) in plane.iter_mut().enumerate() {
            for (k, coefficient) in line.iter_mut().enumerate() {
                if i + j + k > DEGREE {
                    *coefficient = 0.0;
                }
            }
        }
    }
    along_each_axis(&mut cube, &SYNTHESIS);
    let mut coefficients = EXPONENTS.map(|[i, j, k]| cube[i as usize][j as usize][k as usize]);
    coefficients[0] -= threshold;
    coefficients
}

/// The field at the nodes: for each along z, those of the plane.
#[inline(always)]
fn values<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    terms: &[Term],
    half: &[f32; 3],
) -> [[Lanes<f32>; BLOCKS]; NODES] {
    let zero = Lanes::splat(0.0f32);
    let mut sums = [[zero; BLOCKS]; NODES];
    for term in terms {
        let Term { center, inverse_radius: inverse, strength } = *term;
        let (origin, scale): ([_; 3], [_; 3]) =
            (array_of(|axis| center[axis] * inverse), array_of(|axis| half[axis] * inverse));
        for block in 0..BLOCKS {
            let mut base = Lanes::splat(1.0f32);
            for axis in 0..2 {
                let at = Lanes::of(&PLANE[axis][block * WIDTH..]);
                let offset = at * scale[axis] - Lanes::splat(origin[axis]);
                base = base - offset * offset;
            }
            for (sums, node) in sums.iter_mut().zip(AT) {
                let z = node * scale[2] - origin[2];
                let v = (base - Lanes::splat(z * z)).max(zero);
                sums[block] += kernel.value(v) * strength;
            }
        }
    }
    sums
}

/// Applies a matrix along each axis.
#[inline(always)]
fn along_each_axis(cube: &mut Cube, matrix: &[[f32; NODES]; NODES]) {
    for axis in 0..3 {
        let from = *cube;
        for (i, plane) in cube.iter_mut().enumerate() {
            for (j, line) in plane.iter_mut().enumerate() {
                for (k, to) in line.iter_mut().enumerate() {
                    *to = 0.0;
                    for n in 0..NODES {
                        *to += match axis {
                            0 => matrix[i][n] * from[n][j][k],
                            1 => matrix[j][n] * from[i][n][k],
                            _ => matrix[k][n] * from[i][j][n],
                        };
                    }
                }
            }
        }
    }
}
