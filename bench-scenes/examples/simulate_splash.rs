//! Simulates the moving scene `splash` and packs its frames for this package:
//!
//! ```sh
//! cargo run --release -p bench-scenes --example simulate_splash -- \
//!     bench-scenes/data/splash.frames
//! ```
//!
//! # Theory
//! Position based fluids (Macklin and Müller 2013): particles fly, then are moved until the density
//! around each is at most the fluid's, by Newton's method on that constraint in Jacobi fashion
//! (their algorithm 1); where they end up is their velocity. Poly6 measures density, the gradient of
//! the spiky kernel moves particles, an artificial pressure keeps them from clumping (equation 13),
//! and XSPH viscosity makes them move together (equation 17).
//!
//! # Changes versus the paper
//! No vorticity confinement: the scene lasts two seconds. Density is held from above only, as in
//! their section 4 without the negative pressures that it suppresses.

use std::error::Error;

use bench_scenes::FRAME_RATE;
use glam::{DVec3, IVec3};
use particle_files::pack_frames;

/// Distance of neighbours at rest, metres.
const SPACING: f64 = 0.048;
/// The tank, in spacings so that the lattice fits it: from 0 to this in x and z, open above.
const TANK: DVec3 = DVec3::new(34.0, f64::INFINITY, 19.0);
/// Depth of the water at rest, and the column at the left wall that falls into it, in spacings.
const DEPTH: i32 = 4;
const COLUMN: IVec3 = IVec3::new(9, 20, 19);
/// Reach of both kernels.
const REACH: f64 = 2.1 * SPACING;

/// Frames, and the steps of the simulation to each.
const FRAMES: usize = 48;
const STEPS: usize = 8;
/// Moves of all particles to each step.
const ITERATIONS: usize = 5;

/// Support radius R of the balls over the spacing, and the grid that positions are rounded to,
/// metres.
const SUPPORT: f64 = 2.0;
const STEP: f64 = 1.0 / 4096.0;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [packed] = arguments.as_slice() else { return Err("needed OUTPUT".into()) };
    let mut fluid = Fluid::at_rest();
    let mut frames = vec![fluid.centers()];
    while frames.len() < FRAMES {
        (0..STEPS).for_each(|_| fluid.step(1.0 / f64::from(FRAME_RATE) / STEPS as f64));
        frames.push(fluid.centers());
        let top = fluid.positions.iter().map(|position| position.y).fold(0.0, f64::max);
        eprintln!("frame {} of {FRAMES}: up to {top:.2} m", frames.len());
    }
    std::fs::write(packed, pack_frames((SUPPORT * SPACING) as f32, STEP as f32, &frames)?)?;
    Ok(())
}

struct Fluid {
    positions: Vec<DVec3>,
    velocities: Vec<DVec3>,
    /// Sum of the density kernel over a particle's neighbours at rest.
    rest_density: f64,
}

impl Fluid {
    /// A lattice, moved by up to a twentieth of its spacing: symmetry would never break of itself.
    fn at_rest() -> Self {
        let mut positions = Vec::new();
        let mut noise = noise();
        for x in 0..TANK.x as i32 {
            for z in 0..TANK.z as i32 {
                let height = if x < COLUMN.x && z < COLUMN.z { COLUMN.y } else { DEPTH };
                for y in 0..height {
                    let site = IVec3::new(x, y, z).as_dvec3() + 0.5;
                    positions
                        .push(SPACING * (site + 0.05 * DVec3::from([(); 3].map(|()| noise()))));
                }
            }
        }
        let lattice = || (-3..=3).map(f64::from);
        let around =
            lattice().flat_map(|x| lattice().flat_map(move |y| lattice().map(move |z| [x, y, z])));
        let rest_density =
            around.map(|site| poly6((SPACING * DVec3::from(site)).length_squared())).sum();
        Self { velocities: vec![DVec3::ZERO; positions.len()], positions, rest_density }
    }

    fn step(&mut self, duration: f64) {
        const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);
        const VISCOSITY: f64 = 0.02;
        let before = self.positions.clone();
        for (position, velocity) in self.positions.iter_mut().zip(&mut self.velocities) {
            *velocity += duration * GRAVITY;
            *position = in_tank(*position + duration * *velocity);
        }
        let neighbours = neighbours(&self.positions);
        for _ in 0..ITERATIONS {
            self.relax(&neighbours);
        }
        for (index, before) in before.iter().enumerate() {
            self.velocities[index] = (self.positions[index] - *before) / duration;
        }
        let smooth = |index: usize| {
            let own = self.velocities[index];
            let pull: DVec3 = neighbours[index]
                .iter()
                .map(|&other| {
                    let apart = self.positions[index] - self.positions[other];
                    poly6(apart.length_squared()) * (self.velocities[other] - own)
                })
                .sum();
            own + VISCOSITY / self.rest_density * pull
        };
        self.velocities = (0..self.positions.len()).map(smooth).collect();
    }

    /// Moves every particle once towards where none is denser than the fluid.
    fn relax(&mut self, neighbours: &[Vec<usize>]) {
        // Particles that the walls have pressed together would jump apart.
        const LONGEST_MOVE: f64 = 0.1 * REACH;
        // Softens the constraint (their ε), in units of its gradient squared at rest.
        const SOFTNESS: f64 = 1.0;
        // The artificial pressure's k, in the unit of the multipliers.
        const REPULSION: f64 = 5e-4;
        let stiff =
            SOFTNESS * spiky(DVec3::X * SPACING).length_squared() / self.rest_density.powi(2);
        let positions = &self.positions;
        let multiplier = |index: usize| {
            let (mut density, mut own, mut squares) = (poly6(0.0), DVec3::ZERO, 0.0);
            for &other in &neighbours[index] {
                let apart = positions[index] - positions[other];
                let gradient = spiky(apart) / self.rest_density;
                density += poly6(apart.length_squared());
                own += gradient;
                squares += gradient.length_squared();
            }
            let excess = (density / self.rest_density - 1.0).max(0.0);
            -excess / (squares + own.length_squared() + stiff)
        };
        let multipliers: Vec<f64> = (0..positions.len()).map(multiplier).collect();
        let moved = |index: usize| {
            let shift: DVec3 = neighbours[index]
                .iter()
                .map(|&other| {
                    let apart = positions[index] - positions[other];
                    let share = poly6(apart.length_squared()) / poly6((0.2 * REACH).powi(2));
                    let repulsion = -REPULSION / stiff * share.powi(4);
                    (multipliers[index] + multipliers[other] + repulsion) * spiky(apart)
                })
                .sum();
            in_tank(positions[index] + (shift / self.rest_density).clamp_length_max(LONGEST_MOVE))
        };
        self.positions = (0..positions.len()).map(moved).collect();
    }

    fn centers(&self) -> Vec<glam::Vec3> {
        self.positions.iter().map(|position| position.as_vec3()).collect()
    }
}

/// The nearest position in the tank, half a spacing from its walls.
fn in_tank(position: DVec3) -> DVec3 {
    let margin = DVec3::splat(0.5 * SPACING);
    position.clamp(margin, SPACING * TANK - margin)
}

/// Müller et al. 2003, of a squared distance, as a share of its value at 0.
fn poly6(squared: f64) -> f64 {
    (1.0 - squared / (REACH * REACH)).max(0.0).powi(3)
}

/// Gradient of their spiky kernel, in the same unit a metre.
fn spiky(apart: DVec3) -> DVec3 {
    let distance = apart.length();
    if distance >= REACH || distance == 0.0 {
        return DVec3::ZERO;
    }
    -64.0 / 7.0 / REACH * (1.0 - distance / REACH).powi(2) * apart / distance
}

/// The other particles within reach of each, by sorting them into cells of that size.
fn neighbours(positions: &[DVec3]) -> Vec<Vec<usize>> {
    let cell = |position: DVec3| (position / (1.1 * REACH)).floor().as_ivec3();
    let mut cells = std::collections::HashMap::<IVec3, Vec<usize>>::new();
    for (index, position) in positions.iter().enumerate() {
        cells.entry(cell(*position)).or_default().push(index);
    }
    let around = |index: usize| {
        let center = cell(positions[index]);
        let offsets = (0..27).map(|n| IVec3::new(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
        offsets
            .filter_map(|offset| cells.get(&(center + offset)))
            .flatten()
            .copied()
            .filter(|&other| {
                // Room for the moves of one step, in which the lists stay as they are.
                let reach = 1.1 * REACH;
                other != index
                    && positions[index].distance_squared(positions[other]) < reach * reach
            })
            .collect()
    };
    (0..positions.len()).map(around).collect()
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
