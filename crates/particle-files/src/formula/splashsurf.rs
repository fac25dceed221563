//! The density of splashsurf.

use metaball_core::Kernel;

use super::sph::{interpolant, particle_radii};
use super::{Density, SizedBalls, range_in_words, volumes};
use crate::error::Flaw;
use crate::notes::Notes;
use crate::particles::Particles;

/// The density that splashsurf contours (Löschner, Böttcher, Jeske and Bender 2023, Weighted Laplacian smoothing
/// for surface reconstruction of particle-based fluids; `density_map` and `kernel` of its library):
/// Σ V·W(d, R) with the cubic spline, whose support radius R is twice the smoothing length, which is given in
/// particle radii; V = 1/ΣW, a particle's mass over its density, in which equal masses cancel; and the surface
/// threshold 0.6. A particle's radius is that of the file, or half the spacing. splashsurf's grid, its kernel in
/// steps and its smoothing of meshes are not copied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Splashsurf {
    /// The smoothing length in particle radii.
    pub smoothing_length: f64,
}

impl Default for Splashsurf {
    fn default() -> Self {
        Self { smoothing_length: 2.0 }
    }
}

impl Density for Splashsurf {
    fn kernel(&self) -> Kernel {
        Kernel::CubicSpline
    }

    fn balls(
        &self,
        particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<SizedBalls, Flaw> {
        let radii: Vec<f32> = match particle_radii(particles) {
            Some(radii) => {
                let support = |radius: &f32| (2.0 * self.smoothing_length) as f32 * radius;
                radii.iter().map(support).collect()
            }
            None => {
                let needed = "radii of particles, or their spacing, for splashsurf";
                return Err(Flaw::needed(needed, "support radii").or("--radius says them"));
            }
        };
        notes.read(format!(
            "splashsurf: {kernel} of support radii {}, {} particle radii (--smoothing-length says half of it), and \
             volumes by neighbours",
            range_in_words(&radii),
            2.0 * self.smoothing_length
        ));
        let volumes = volumes::by_neighbours(particles, &radii, None, kernel);
        Ok(interpolant(radii, &volumes, kernel))
    }

    fn threshold(
        &self,
        _particles: &Particles,
        _kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<f32, Flaw> {
        notes.read("T = 0.6: splashsurf's surface threshold (--threshold says another)");
        Ok(0.6)
    }
}
