//! Finds the softest modes of the molecule and packs them for this package:
//!
//! ```sh
//! cargo run --release -p bench-scenes --example elastic_network -- \
//!     bench-scenes/data/md_1u19.pdb.gz bench-scenes/data/md_1u19-modes.frames
//! ```
//!
//! # Theory
//! The anisotropic network model (Atilgan et al. 2001): the α carbons are joined by equal springs to
//! all others within 15 Å, at rest as they are. The eigenvectors of its Hessian with the least
//! eigenvalues above the six rigid ones are the directions in which the fold gives most easily; in
//! thermal motion their amplitudes go with one over the root of the eigenvalue.
//!
//! # Changes versus the paper
//! Only directions and ratios mean anything here: the softest mode is given an amplitude of 1.6 Å,
//! root mean square over the α carbons, so that it is seen. Other atoms go with the α carbons around
//! them, so bonds are bent a little.

use std::error::Error;
use std::io::Read;

use flate2::read::MultiGzDecoder;
use glam::DVec3;
use particle_files::{ReadOptions, pack_frames, read};

/// Springs reach so far, Å.
const CUTOFF: f64 = 15.0;
/// Modes wanted, and vectors iterated beside them: the more, the sooner those converge.
const MODES: usize = 3;
const VECTORS: usize = 8;
/// Steps of the iteration.
const STEPS: usize = 200;
/// The most that a mode may still be off: |Hv − λv| of a unit vector v, over its eigenvalue λ.
const RESIDUE: f64 = 1e-6;
/// Root mean square amplitude of the softest mode, Å.
const AMPLITUDE: f64 = 1.6;
/// Other atoms follow α carbons by a Gaussian of this width, Å.
const WIDTH: f64 = 3.0;
/// Displacements are rounded to multiples of this, Å.
const STEP: f32 = 1.0 / 2048.0;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [molecule, packed] = arguments.as_slice() else { return Err("needed PDB OUTPUT".into()) };
    let nodes = alpha_carbons(molecule)?;
    let modes = Network::new(&nodes).softest_modes()?;
    let atoms = read(molecule, &ReadOptions::default())?.positions;
    let frames: Vec<Vec<glam::Vec3>> = modes
        .iter()
        .map(|mode| atoms.iter().map(|atom| displacement(*atom, &nodes, mode).as_vec3()).collect())
        .collect();
    std::fs::write(packed, pack_frames(1.0, STEP, &frames)?)?;
    Ok(())
}

/// Positions of the α carbons of a gzipped PDB file.
fn alpha_carbons(path: &str) -> Result<Vec<DVec3>, Box<dyn Error>> {
    let mut text = String::new();
    MultiGzDecoder::new(std::fs::File::open(path)?).read_to_string(&mut text)?;
    let is_node = |line: &&str| line.starts_with("ATOM") && line.get(12..16) == Some(" CA ");
    let mut nodes = Vec::new();
    for line in text.lines().filter(is_node) {
        let coordinate = |from: usize| line[from..from + 8].trim().parse::<f64>();
        nodes.push(DVec3::new(coordinate(30)?, coordinate(38)?, coordinate(46)?));
    }
    Ok(nodes)
}

/// How far a point goes with the nodes around it.
fn displacement(point: DVec3, nodes: &[DVec3], mode: &[f64]) -> DVec3 {
    let nearest = nodes.iter().map(|node| node.distance_squared(point)).fold(f64::MAX, f64::min);
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for (node, moved) in nodes.iter().zip(mode.chunks_exact(3)) {
        let beyond = node.distance_squared(point) - nearest;
        let weight = (-0.5 * beyond / (WIDTH * WIDTH)).exp();
        sum += weight * DVec3::from_slice(moved);
        weights += weight;
    }
    sum / weights
}

/// The network's Hessian, and what it does not resist.
struct Network {
    /// Row by row.
    hessian: Vec<f64>,
    rigid: Vec<Vec<f64>>,
}

impl Network {
    fn new(nodes: &[DVec3]) -> Self {
        let size = 3 * nodes.len();
        let mut hessian = vec![0.0; size * size];
        for (a, one) in nodes.iter().enumerate() {
            for (b, other) in nodes.iter().enumerate().filter(|(b, _)| *b != a) {
                let apart = *other - *one;
                if apart.length() > CUTOFF {
                    continue;
                }
                let along = apart.normalize();
                for (i, j) in (0..9).map(|n| (n / 3, n % 3)) {
                    let spring = along[i] * along[j];
                    hessian[(3 * a + i) * size + 3 * b + j] -= spring;
                    hessian[(3 * a + i) * size + 3 * a + j] += spring;
                }
            }
        }
        let middle = nodes.iter().sum::<DVec3>() / nodes.len() as f64;
        let vector = |moved: &dyn Fn(DVec3) -> DVec3| -> Vec<f64> {
            nodes.iter().flat_map(|node| moved(*node - middle).to_array()).collect()
        };
        let mut rigid: Vec<_> = DVec3::AXES
            .iter()
            .flat_map(|axis| [vector(&|_| *axis), vector(&|from| axis.cross(from))])
            .collect();
        orthonormalize(&[], &mut rigid);
        Self { hessian, rigid }
    }

    /// The softest modes with their amplitudes, softest first: inverse iteration of a few vectors at
    /// once, orthogonal to what is rigid. Fails where that has not converged.
    fn softest_modes(&self) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
        let size = self.rigid[0].len();
        // Made stiff, the rigid motions leave a matrix that can be inverted.
        let mut stiff = self.hessian.clone();
        for rigid in &self.rigid {
            for (row, a) in rigid.iter().enumerate() {
                for (column, b) in rigid.iter().enumerate() {
                    stiff[row * size + column] += a * b;
                }
            }
        }
        let factor = cholesky(&stiff, size);
        let mut noise = noise();
        let mut vectors: Vec<Vec<f64>> =
            (0..VECTORS).map(|_| (0..size).map(|_| noise()).collect()).collect();
        for _ in 0..STEPS {
            vectors.iter_mut().for_each(|vector| solve(&factor, vector));
            orthonormalize(&self.rigid, &mut vectors);
        }
        let pulled = |vector: &[f64]| -> Vec<f64> {
            self.hessian.chunks_exact(size).map(|row| dot(row, vector)).collect()
        };
        let softest = dot(&vectors[0], &pulled(&vectors[0]));
        let modes = vectors.iter().take(MODES);
        modes
            .map(|vector| {
                let pulled = pulled(vector);
                let stiffness = dot(vector, &pulled);
                let off = pulled.iter().zip(vector).map(|(force, part)| force - stiffness * part);
                let residue = off.map(|off| off * off).sum::<f64>().sqrt() / stiffness;
                eprintln!("eigenvalue {stiffness:.4}, residue {residue:.1e}");
                if residue > RESIDUE {
                    return Err(
                        format!("needed a residue below {RESIDUE:e}, found {residue:e}").into()
                    );
                }
                let amplitude = AMPLITUDE * (size as f64 / 3.0 * softest / stiffness).sqrt();
                Ok(vector.iter().map(|part| amplitude * part).collect())
            })
            .collect()
    }
}

/// Makes the vectors of unit length and perpendicular to `others` and to each other, first to last.
fn orthonormalize(others: &[Vec<f64>], vectors: &mut [Vec<f64>]) {
    for index in 0..vectors.len() {
        let (before, rest) = vectors.split_at_mut(index);
        let vector = &mut rest[0];
        for other in others.iter().chain(&*before) {
            let share = dot(other, vector);
            vector.iter_mut().zip(other).for_each(|(part, other)| *part -= share * other);
        }
        let length = dot(vector, vector).sqrt();
        vector.iter_mut().for_each(|part| *part /= length);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The lower factor, row by row from the diagonal's start.
fn cholesky(matrix: &[f64], size: usize) -> Vec<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(size);
    for own in matrix.chunks_exact(size) {
        let mut row: Vec<f64> = Vec::with_capacity(rows.len() + 1);
        for (column, above) in rows.iter().enumerate() {
            row.push((own[column] - dot(&row, &above[..column])) / above[column]);
        }
        row.push((own[rows.len()] - dot(&row, &row)).sqrt());
        rows.push(row);
    }
    rows
}

/// Replaces a vector by the solution of the factored system.
fn solve(factor: &[Vec<f64>], vector: &mut [f64]) {
    for (row, parts) in factor.iter().enumerate() {
        vector[row] = (vector[row] - dot(&parts[..row], &vector[..row])) / parts[row];
    }
    for (row, parts) in factor.iter().enumerate().rev() {
        vector[row] /= parts[row];
        let solved = vector[row];
        let above = vector.iter_mut().zip(&parts[..row]);
        above.for_each(|(part, factor)| *part -= factor * solved);
    }
}

/// Numbers from −1 to 1, the same in every run.
fn noise() -> impl FnMut() -> f64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
