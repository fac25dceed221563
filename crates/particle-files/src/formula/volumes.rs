//! Volumes of particles by their neighbours.

use metaball_core::Kernel;

use super::neighbours::Neighbours;
use crate::balls::Radii;
use crate::particles::Particles;
use crate::periodic;

/// The volume of each particle, mᵢ/Σⱼ mⱼW(xᵢ − xⱼ, Rᵢ): its mass over the density that SPH sums up (Monaghan 1992),
/// in cubes of the unit of the positions. Equal masses, for which `masses` is `None`, cancel. Particles of
/// neighbouring cells count where the surface goes on across the faces.
pub(super) fn by_neighbours(
    particles: &Particles,
    radii: &[f32],
    masses: Option<&[f64]>,
    kernel: Kernel,
) -> Vec<f64> {
    let images = match &particles.cell {
        Some(cell) if particles.is_periodic => {
            periodic::images(&particles.positions, &Radii::Each(radii.into()), cell)
        }
        _ => Vec::new(),
    };
    let positions = particles.positions.iter().copied().chain(images.iter().map(|(_, at)| *at));
    let mass = |index: usize| masses.map_or(1.0, |masses| masses[index]);
    let weights = (0..particles.len()).chain(images.iter().map(|(index, _)| *index)).map(mass);
    let neighbours = Neighbours::new(positions.zip(weights), radii);
    let normalization = kernel.normalization();
    let sums =
        neighbours.sums(&particles.positions, radii, |squared_ratio| kernel.value(squared_ratio));
    let volume = |(index, sum): (usize, f64)| {
        mass(index) * f64::from(radii[index]).powi(3) / (normalization * sum)
    };
    sums.into_iter().enumerate().map(volume).collect()
}
